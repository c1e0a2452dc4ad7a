"""What the pymunk backend can take from a real arm and real objects: braking, feet, and edges that mislead nobody."""

from __future__ import annotations

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.backends.pymunk_.braking import Pace, pace
from phframe.backends.pymunk_.chipmunk import max_force
from phframe.backends.pymunk_.physics import PymunkOptions, PymunkPhysics
from phframe.backends.pymunk_.state import set_in_motion
from phframe.backends.pymunk_.world import lay_floor
from phframe.core import Action, Contacts, Cylinder, GripperPath, Phase, PhaseRule, Scene, SceneObject, Shelf, Watch
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec

SHELF = Shelf(0.6, 0.6)
TIP = 0.3
"""Depth (m) of the fingertip in a sweep."""


def sweep(offset: float, **options: float | None) -> tuple[np.ndarray, np.ndarray]:
    """Where an object ends whose centre is ``offset`` (m) deeper than the tip that sweeps it, and the tips seen."""
    start, target = (TIP + offset, 0.3), (0.55, 0.1)
    items = tuple(SceneObject(name, Cylinder(0.03), at) for name, at in (("o", start), ("target", target)))
    scene = Scene("one", SHELF, items, "target")
    poses = np.array([[-0.05, 0.2, 0.0], [TIP, 0.2, 0.0], [TIP, 0.4, 0.0]])
    rules = {phase: PhaseRule(0.2, 0.0, Contacts.OBJECTS) for phase in (Phase.INSERT, Phase.SWEEP)}
    action = Action("sweep", GripperPath(poses, (Phase.INSERT, Phase.SWEEP), rules), ("o",))
    tips = []
    with PlanningWorld(WorldSpec(scene, backend_options=options)) as world:
        seen = Watch(1 / 240, lambda time, state: tips.append(state.arm.gripper[:2] if state.arm else None))
        made = world.apply(scene.initial_state(), action, watch=seen)
    return made.state.positions[0] - start, np.array([tip for tip in tips if tip is not None])


def test_a_centre_in_line_with_the_tip_is_pushed_straight_ahead() -> None:
    """Planners put the tip exactly as deep as a centre; the engine alone takes that for an overlap by a radius."""
    aside, along = sweep(0.0)[0]
    assert abs(aside) < 5e-4
    assert along > 0.1


@pytest.mark.parametrize("offset", [-1e-4, 1e-4])
def test_beside_that_line_nothing_jumps(offset: float) -> None:
    in_line, beside = sweep(0.0, standing_radius=2 / 3)[0], sweep(offset, standing_radius=2 / 3)[0]
    assert np.abs(beside - in_line).max() < 3e-3


def test_an_arm_that_brakes_lets_go_earlier() -> None:
    """By the way it brakes, v^2 / 2a: 2 mm; it ends at the same place at the same time."""
    (dead, dead_tips), (braking, tips) = sweep(0.0), sweep(0.0, arm_acceleration=10.0)
    assert dead[1] - braking[1] == pytest.approx(0.2**2 / 20.0, abs=7e-4)
    assert tips[-1] == pytest.approx(dead_tips[-1], abs=1e-4)
    assert len(tips) == pytest.approx(len(dead_tips), abs=15)


def alone(standing: float | None) -> PymunkPhysics:
    """One object of 0.4 kg with a friction of 0.5 on the board, at rest."""
    item = SceneObject("o", Cylinder(0.03), (0.3, 0.3), mass=0.4, friction=0.5)
    scene, arm = Scene("one", SHELF, (item,), "o"), PlanarArm(PlanarArmOptions())
    physics = PymunkPhysics(scene, arm, arm.default_base_pose(SHELF), PymunkOptions(standing_radius=standing))
    physics.restore(scene.initial_state())
    return physics


@pytest.mark.parametrize(("standing", "stops"), [(None, True), (2 / 3, False)])
def test_what_slides_on_feet_goes_on_turning(standing: float | None, stops: bool) -> None:
    """Friction is against the way each foot goes: hardly against the turn, as long as sliding is faster."""
    world = alone(standing)._current
    body = world.items["o"].body
    set_in_motion(world, np.array([[0.4, 0.0, 1.0]]))
    for _ in range(6):
        world.space.step(1.0 / 240.0)
    assert body.velocity[0] > 0.2
    assert (abs(body.angular_velocity) < 1e-6) is stops
    assert stops or body.angular_velocity > 0.5


@pytest.mark.parametrize("standing", [None, 0.5, 2 / 3, 1.0])
def test_all_feet_together_resist_as_the_weight_says(standing: float | None) -> None:
    world = alone(standing)._current
    lay_floor(world, world.items["o"])
    floor = world.items["o"].floor
    sliding = floor[:1] if standing is None else floor
    assert sum(map(max_force, sliding)) == pytest.approx(0.5 * 0.4 * 9.81)


@pytest.mark.parametrize(
    ("distance", "steps", "acceleration"), [(0.2, 240, 1.7e-4), (0.02, 24, 1.7e-4), (0.02, 24, 1e-6)]
)
def test_a_pace_covers_the_leg_in_its_steps_and_slows_down_evenly(
    distance: float, steps: int, acceleration: float
) -> None:
    found, left, speeds = pace(distance, steps, acceleration), distance, []
    for remaining in range(steps, 0, -1):
        speeds.append(left / found.steps(remaining))
        left -= speeds[-1]
    assert left == pytest.approx(0.0, abs=1e-12)
    slower = -np.diff(speeds)
    assert slower.min() >= -1e-12
    assert speeds[-1] < speeds[0] * (1.0 if found.braking > 1 else 1.01)
    if found.braking < steps:
        assert slower.max() == pytest.approx(acceleration, rel=0.2)


def test_no_braking_is_an_even_pace() -> None:
    assert [Pace().steps(left) for left in (1, 5, 30)] == [1.0, 5.0, 30.0]
