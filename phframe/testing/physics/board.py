"""Checks of what objects do on the board by themselves: slide, come to rest, stay there, fall off at the mouth."""

from __future__ import annotations

import math

import numpy as np

from phframe.core import Condition, FloatArray, Phase, Settle, State
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_at_most, expect_close, expect_equal
from phframe.testing.physics.paths import CROWD_SWEEP, MIDDLE, OUTSIDE, crowd, cylinder, drive_in, path, scene_of
from phframe.testing.physics.stand import WatchLog, on_stand
from phframe.testing.subjects import PhysicsUnderTest

GRAVITY = 9.81
LOOKS = 1.0 / 240.0
RADIUS = 0.03
APART = 2e-4
"""An object this far (m) from the fingertip slides freely."""


@check
def things_come_to_rest(subject: PhysicsUnderTest) -> Faults:
    """Settle: wait for rest after a motion; Motion.settled: whether everything came to rest in the time allowed."""
    with on_stand(subject, crowd()) as stand:
        made = stand.run(stand.start, CROWD_SWEEP)
        yield from expect(made.motion.settled, "rest within 3 s after a sweep", str(made.motion))
    with on_stand(subject, scene_of(cylinder("o", 0.15, MIDDLE, friction=0.15))) as stand:
        trajectory = stand.trajectory(stand.start, drive_in(0.25, speed=0.5))
        ends = [stand.physics.simulate(stand.start, trajectory, settle=settle) for settle in (Settle(), None)]
        slid = float(ends[0].state.displacement(ends[1].state)[0])
        yield from expect(slid > 0.03, "an object at 0.5 m/s to slide on while things settle", f"it slid {slid:.4f} m")
        spent = ends[0].motion.duration - ends[1].motion.duration
        yield from expect(spent > 0.2, "settling counted in the duration, at least 0.2 s", f"{spent:.3f} s")
        same = ends[0].motion.followed, ends[1].motion.followed
        yield from expect_close(same[0], same[1], 1e-9, "how much was driven, settling excluded (s)")
        hasty = stand.physics.simulate(stand.start, trajectory, settle=Settle(timeout=0.06)).motion
        yield from expect(not hasty.settled, "no rest 0.06 s after the push: it takes 0.34 s", str(hasty))


@check
def a_settled_world_stays_as_it_is(subject: PhysicsUnderTest) -> Faults:
    """State: the world at rest; nothing moves unless it is touched."""
    with on_stand(subject, crowd()) as stand:
        pushed = stand.run(stand.start, CROWD_SWEEP).state
        stand.physics.restore(pushed)
        for seconds in (1.0, 4.0):
            stand.physics.execute(stand.standing_still(pushed, seconds), settle=None)
            moved = float(np.abs(stand.physics.observe().poses[:, :3] - pushed.poses[:, :3]).max())
            yield from expect_at_most(
                moved, subject.tolerances.untouched, f"how far anything moves in {seconds:g} s (m)"
            )


@check
def sliding_objects_stop_where_friction_says(subject: PhysicsUnderTest) -> Faults:
    """SceneObject.friction: Coulomb coefficient with the board; let go at a speed v, an object stops after v^2/(2 mu g)."""
    for friction in (0.15, 0.4):
        for speed in (0.25, 0.5):
            with on_stand(subject, scene_of(cylinder("o", 0.12, MIDDLE, friction=friction))) as stand:
                film = WatchLog(LOOKS)
                stand.run(stand.start, drive_in(0.22, speed=speed), watch=film.watch)
                let_go, slid = _slide(film, friction)
                enough = let_go > 0.5 * speed
                yield from expect(enough, f"an object let go at about {speed:g} m/s", f"at {let_go:.3f} m/s")
                theory = let_go**2 / (2.0 * friction * GRAVITY)
                found = f"{slid:.4f} m at mu = {friction:g}, let go at {let_go:.3f} m/s"
                close = abs(slid - theory) <= subject.tolerances.stopping * theory + subject.tolerances.stopping_slack
                yield from expect(close, f"a stop after {theory:.4f} m", found)


@check
def mass_does_not_change_how_far_things_slide(subject: PhysicsUnderTest) -> Faults:
    """SceneObject.friction: Coulomb friction stops every mass after the same way."""
    ends = []
    for mass in (0.1, 0.3, 1.5):
        with on_stand(subject, scene_of(cylinder("o", 0.12, MIDDLE, friction=0.25, mass=mass))) as stand:
            ends.append(stand.center(stand.run(stand.start, drive_in(0.22, speed=0.4)).state, "o")[0] - 0.22 - RADIUS)
    theory = 0.4**2 / (2.0 * 0.25 * GRAVITY)
    tolerance = 2.0 * subject.tolerances.stopping * theory + subject.tolerances.sunk
    yield from expect_close(
        ends, np.full(3, theory), tolerance, "how far 0.1, 0.3 and 1.5 kg slide on from 0.4 m/s (m)"
    )


@check
def what_leaves_at_the_mouth_has_spilled(subject: PhysicsUnderTest) -> Faults:
    """Condition.SPILLED: it left the board; before the mouth or below the board, and not in the hand."""
    yaw, ahead = math.pi / 4.0, np.array([math.cos(math.pi / 4.0), math.sin(math.pi / 4.0)])
    left = np.array([-ahead[1], ahead[0]])
    victim = np.array([0.04, MIDDLE])
    aside = RADIUS + subject.arm.shape.insertion_width / 2.0 + 0.015
    inside = victim + 0.03 * ahead - aside * left
    poses = [inside - 0.15 * ahead, inside, inside + 0.16 * left]
    way = path([[x, y, yaw] for x, y in poses], [Phase.INSERT, Phase.SWEEP])
    with on_stand(subject, scene_of(cylinder("victim", *victim.tolist()), cylinder("target", 0.5, 0.5))) as stand:
        made = stand.run(stand.start, way)
        row, pose = stand.scene.index("victim"), made.state.poses[0]
        yield from expect_equal(made.state.conditions[row], Condition.SPILLED, "the condition of what was swept out")
        yield from expect(pose[0] < 0.0 or pose[2] < 0.0, "its last pose before the mouth", str(pose))
        yield from expect_equal(made.state.conditions[1], Condition.UPRIGHT, "the condition of what was not touched")
        yield from expect(made.motion.settled, "rest, as what has spilled does not count", str(made.motion))
        again = stand.run(made.state.parked(), path([[OUTSIDE, 0.2, 0.0], [0.05, 0.2, 0.0]], [Phase.INSERT]))
        yield from expect_equal(again.state.conditions[row], Condition.SPILLED, "its condition after another run")
        yield from expect_equal(again.state.poses[row].tolist(), pose.tolist(), "its pose after another run")


def _slide(film: WatchLog, friction: float) -> tuple[float, float]:
    """The speed (m/s) at which an object left the fingertip for good, and how far it went from there (m)."""
    along = np.array([state.positions[0, 0] for state in film.states])
    times, tips = np.array(film.times), np.array([_tip(state) for state in film.states])
    touching = np.flatnonzero(along - RADIUS - tips <= APART)
    if len(touching) == 0 or touching[-1] + 1 >= len(times):
        return 0.0, 0.0
    free = int(touching[-1]) + 1
    step = times[free] - times[free - 1]
    speed = (along[free] - along[free - 1]) / step - friction * GRAVITY * step / 2.0
    return float(speed), float(along[-1] - along[free])


def _tip(state: State) -> float:
    tip: FloatArray | None = None if state.arm is None else state.arm.gripper
    return -np.inf if tip is None else float(tip[0])


BOARD_CHECKS: tuple[Check[PhysicsUnderTest], ...] = (
    things_come_to_rest,
    a_settled_world_stays_as_it_is,
    sliding_objects_stop_where_friction_says,
    mass_does_not_change_how_far_things_slide,
    what_leaves_at_the_mouth_has_spilled,
)
