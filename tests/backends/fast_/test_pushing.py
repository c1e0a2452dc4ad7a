"""The arm among objects: forces have a limit, jams throw nothing, left is like right."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.core import FloatArray, GripperPath, Phase, Scene, State, Stop, StopCause
from phframe.testing.physics.paths import MIDDLE, SHELF, crowd, cylinder, drive_in, grasp, path, scene_of, sweep
from phframe.testing.physics.stand import WatchLog, on_stand
from tests.backends.fast_.stand import ARM, fast, set_moving, subject

pytestmark = pytest.mark.needs_fast

BLOCK = scene_of(*(cylinder(f"o{row}{i}", 0.36 + 0.062 * row, 0.035 + 0.062 * i) for row in range(4) for i in range(9)))
"""Rows of objects that fill the back of the shelf."""


@pytest.mark.parametrize("way", [drive_in(0.55, 0.2), drive_in(0.5, 0.34), sweep(0.4, 0.1, 0.5)])
def test_a_jam_throws_nothing(way: GripperPath) -> None:
    """What is pressed together stalls the arm; nothing then goes faster than the arm, or farther than it."""
    film = WatchLog(0.02)
    with on_stand(subject(), BLOCK) as stand:
        made = stand.run(stand.start, way, watch=film.watch)
        steps = [b.positions - a.positions for a, b in zip(film.states, film.states[1:], strict=False)]
        periods = np.maximum(np.diff(film.times), 0.005)
        fastest = max(
            float(np.linalg.norm(step, axis=1).max() / time) for step, time in zip(steps, periods, strict=True)
        )
        assert fastest < 0.6, "no object is thrown by an arm of 0.25 m/s"
        assert made.state.on_board.all()
        assert made.motion.largest_force <= ARM.force_limit * 1.01
        deepest = max(_overlap(stand.scene, state) for state in film.states)
        assert deepest < 4e-3


def test_what_cannot_give_way_stalls_the_arm_at_its_limit() -> None:
    with on_stand(subject(), scene_of(cylinder("o", 0.5, MIDDLE, radius=0.04))) as stand:
        motion = stand.run(stand.start, drive_in(0.58), force_limit=35.0).motion
        assert motion.stalled
        assert motion.largest_force == pytest.approx(35.0, rel=0.01)
        assert 0.005 < motion.tracking_error < 0.012


def test_a_stop_at_a_force_counts_what_is_dragged() -> None:
    target = cylinder("target", 0.25, MIDDLE, mass=4.0)
    with on_stand(subject(), scene_of(cylinder("other", 0.45, 0.5), target)) as stand:
        motion = stand.run(stand.start, grasp(ARM, 0.25), stop=Stop(force=8.0)).motion
        assert motion.stopped is not None
        assert motion.stopped.cause is StopCause.FORCE
        assert motion.stopped.force == pytest.approx(8.0, rel=0.3)


@pytest.mark.parametrize("moving", [False, True])
def test_what_is_held_drags_along_the_board(moving: bool) -> None:
    """Coulomb's mu m g, whether the engine jumps or steps."""
    scene = scene_of(cylinder("other", 0.45, 0.5, friction=0.01), cylinder("target", 0.25, MIDDLE, mass=2.0))
    with on_stand(subject(), scene) as stand:
        gripped = stand.run(stand.start, grasp(ARM, 0.25, withdraw=False)).state
        physics = stand.physics
        physics.restore(gripped)
        if moving:
            set_moving(physics, 0, (0.0, -0.05, 0.0))
        assert gripped.arm is not None
        out = path(np.array([gripped.arm.gripper, [0.1, MIDDLE, 0.0]]), [Phase.WITHDRAW], speed=0.2)
        motion = physics.execute(stand.trajectory(gripped, out), settle=None)
        assert motion.complete
        assert motion.largest_force == pytest.approx(0.25 * 2.0 * 9.81, rel=0.02)
        assert stand.center(physics.observe(), "target") == pytest.approx([0.08, MIDDLE], abs=1e-3)


def test_control_level_steering_does_not_brake() -> None:
    ends = []
    for acceleration in (None, 1.0):
        with on_stand(subject(arm_acceleration=acceleration), scene_of(cylinder("o", 0.15, MIDDLE))) as stand:
            physics = stand.physics
            physics.restore(stand.run(stand.start, drive_in(0.05)).state)
            end, _ = physics.propagate(physics.snapshot(), np.array([0.3, 0.0, 0.0]), 0.3)  # type: ignore[attr-defined]
            ends.append(end.velocities.tolist())
    assert ends[0][0][0] == pytest.approx(0.3, abs=0.01), "it is pushed at the end"
    assert ends[1] == ends[0]


def mirrored(scene: Scene) -> Scene:
    """The scene with left and right swapped."""
    return scene_of(
        *(
            cylinder(o.id, o.position[0], SHELF.width - o.position[1], radius=o.radius, mass=o.mass)
            for o in scene.objects
        )
    )


@settings(max_examples=15, deadline=None)
@given(
    depth=st.floats(0.15, 0.4),
    aside=st.floats(-0.02, 0.02),
    begin=st.floats(0.1, 0.25),
)
def test_left_is_like_right(depth: float, aside: float, begin: float) -> None:
    """A single object: among many, the order of contacts decides, as in every engine."""
    scene = scene_of(cylinder("o", depth, MIDDLE + aside))
    ends: list[FloatArray] = []
    for each, sign in ((scene, 1.0), (mirrored(scene), -1.0)):
        with on_stand(subject(), each) as stand:
            way = sweep(depth + 0.01, MIDDLE - sign * begin, MIDDLE + sign * 0.05)
            moved = stand.run(stand.start, way).state.positions[0] - stand.start.positions[0]
            ends.append(moved * np.array([1.0, sign]))
    assert ends[0] == pytest.approx(ends[1], abs=1e-6)


def _overlap(scene: Scene, state: State) -> float:
    apart = np.linalg.norm(state.positions[:, None] - state.positions[None], axis=2)
    together = scene.radii[:, None] + scene.radii[None]
    return float((together - apart - 10.0 * np.eye(len(apart))).max())


def test_a_new_world_of_the_same_backend_is_the_crowd() -> None:
    assert fast(crowd()).observe() == fast(crowd()).restore(crowd().initial_state())
