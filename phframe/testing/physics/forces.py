"""Checks that matter stays matter: walls hold, nothing passes through anything, the arm's force has a limit."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

from phframe.core import ArmState, Cylinder, FloatArray, GripperPath, Phase, Scene, SceneObject, Settle, State
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_at_most, expect_equal
from phframe.testing.physics.paths import (
    CROWD_SWEEP,
    MIDDLE,
    OUTSIDE,
    SHELF,
    crowd,
    cylinder,
    drive_in,
    finger_length,
    grasp,
    path,
    scene_of,
    sweep,
)
from phframe.testing.physics.stand import PhysicsStand, WatchLog, on_stand
from phframe.testing.subjects import PhysicsUnderTest

WALLS = ("south wall", "north wall", "back wall")
GRAVITY = 9.81


@check
def walls_hold_what_is_pressed_into_them(subject: PhysicsUnderTest) -> Faults:
    """Physics: nothing is ever squeezed through a wall; the arm stalls, and its force keeps to the trajectory's limit."""
    for wall in WALLS:
        with on_stand(subject, _against(subject, wall)[0]) as stand:
            film, limit = WatchLog(1.0 / 120.0), 40.0
            motion = stand.run(stand.start, _against(subject, wall)[1], force_limit=limit, watch=film.watch).motion
            sunk = max(_sunk(stand, state) for state in film.states)
            yield from expect_at_most(sunk, subject.tolerances.sunk, f"how far the object is in the {wall} (m)")
            yield from expect(motion.stalled, f"a stall at the {wall}", str(motion))
            most = limit * (1.0 + subject.tolerances.force)
            yield from expect_at_most(motion.largest_force, most, f"the largest force at the {wall} (N)")
            least = 0.5 * limit
            yield from expect(
                motion.largest_force >= least, f"a force near {limit:g} N at a stall", f"{motion.largest_force:g} N"
            )
            yield from expect(
                not motion.wall_contacts, f"no contact of the arm with the {wall}", str(motion.wall_contacts)
            )


@check
def walls_hold_the_arm(subject: PhysicsUnderTest) -> Faults:
    """Motion.wall_contacts: the arm's contacts with walls, by the wall's name. A wall lets no arm through."""
    ways = {
        "south wall": sweep(0.25, MIDDLE, -0.05),
        "north wall": sweep(0.25, MIDDLE, SHELF.width + 0.05),
        "back wall": drive_in(SHELF.depth + 0.05),
    }
    for wall, way in ways.items():
        with on_stand(subject, scene_of(cylinder("o", 0.45, 0.1 if wall != "south wall" else 0.5))) as stand:
            film = WatchLog(1.0 / 60.0)
            motion = stand.run(stand.start, way, watch=film.watch).motion
            yield from expect_equal({c.body for c in motion.wall_contacts}, {wall}, "the walls touched")
            yield from expect(motion.stalled, f"a stall at the {wall}", str(motion))
            tips = np.array([state.arm.gripper for state in film.states if state.arm is not None]).reshape(-1, 3)
            deepest = float(tips[:, 0].max(initial=0.0)) - SHELF.depth
            yield from expect_at_most(deepest, subject.tolerances.sunk, f"how far the fingertip is in the {wall} (m)")
            half = subject.arm.shape.insertion_width / 2.0
            beside = half - float(np.minimum(tips[:, 1], SHELF.width - tips[:, 1]).min(initial=1.0))
            yield from expect_at_most(beside, subject.tolerances.sunk, f"how far the fingers are in the {wall} (m)")


@check
def nothing_passes_through_anything(subject: PhysicsUnderTest) -> Faults:
    """State: objects are solid; they push one another aside and do not overlap."""
    with on_stand(subject, crowd()) as stand:
        film = WatchLog(1.0 / 60.0)
        made = stand.run(stand.start, CROWD_SWEEP, watch=film.watch)
        depth, radii = 0.0, stand.scene.radii
        for state in film.states:
            for a, b in combinations(np.flatnonzero(state.on_board), 2):
                gap = float(np.linalg.norm(state.positions[a] - state.positions[b]))
                depth = max(depth, float(radii[a] + radii[b]) - gap)
        yield from expect_at_most(depth, 2.0 * subject.tolerances.sunk, "how far objects are in each other (m)")
        moved = made.state.displacement(stand.start) > 0.01
        yield from expect(moved[:3].all(), "'a', 'b' and 'c', which are swept, to move", str(made.state.positions))


@check
def pushes_move_what_is_in_the_way(subject: PhysicsUnderTest) -> Faults:
    """A pushed object stays ahead of the arm, and pushes what is ahead of it."""
    with on_stand(subject, scene_of(cylinder("first", 0.15, MIDDLE), cylinder("second", 0.25, MIDDLE))) as stand:
        state = stand.run(stand.start, drive_in(0.25)).state
        first, second = (stand.center(state, name)[0] for name in ("first", "second"))
        slack = subject.tolerances.sunk
        yield from expect(first >= 0.28 - slack, "'first' at x >= 0.28 m, a radius ahead of the tip", f"{first:.4f} m")
        yield from expect(
            second >= first + 0.06 - 2.0 * slack, "'second' a diameter ahead of 'first'", f"{second:.4f} m"
        )


@check
def the_arm_passes_over_what_is_lower(subject: PhysicsUnderTest) -> Faults:
    """Outline.bottom: a part of the arm touches nothing that is no taller; its fingers close on nothing there."""
    low = Cylinder(0.03, 0.8 * (subject.arm.shape.height + min(part.bottom for part in subject.arm.shape.closed)))
    flat = SceneObject("flat", low, (0.2, MIDDLE), mass=0.3)
    with on_stand(subject, scene_of(flat, cylinder("tall", 0.45, 0.1))) as stand:
        for way in (sweep(0.3, MIDDLE - 0.05, MIDDLE + 0.05), grasp(subject.arm, 0.2)):
            made = stand.run(stand.start, way)
            moved = float(made.state.displacement(stand.start)[0])
            yield from expect_at_most(moved, subject.tolerances.sunk, "how far the arm moved what it passes over (m)")
            yield from expect_equal(made.motion.contacts, (), "the contacts with what it passes over")
            yield from expect_equal(made.state.held, None, "what is held")


@check
def a_load_too_heavy_stalls_the_arm(subject: PhysicsUnderTest) -> Faults:
    """Trajectory.force_limit: net contact force (N) above which the arm stalls; what needs less is pushed."""
    for mass, stalls in ((8.0, True), (2.0, False)):  # friction 0.5: 39.2 N and 9.8 N
        with on_stand(subject, scene_of(cylinder("load", 0.2, MIDDLE, mass=mass, friction=0.5))) as stand:
            way = drive_in(0.35, speed=subject.tolerances.load_speed)
            made = stand.run(stand.start, way, force_limit=25.0)
            moved = float(made.state.displacement(stand.start)[0])
            yield from expect_equal(made.motion.stalled, stalls, f"a stall at {mass:g} kg with a limit of 25 N")
            far = moved < 0.02 if stalls else moved > 0.15
            yield from expect(far, f"{mass:g} kg {'not ' if stalls else ''}moved", f"it moved {moved:.4f} m")
            most = 25.0 * (1.0 + subject.tolerances.force)
            yield from expect_at_most(made.motion.largest_force, most, f"the largest force at {mass:g} kg (N)")


@check
def forces_are_those_of_friction(subject: PhysicsUnderTest) -> Faults:
    """Motion.largest_force: magnitude of the sum of the contact forces on the arm, mean of 20 ms; 0 without contact."""
    with on_stand(subject, scene_of(cylinder("load", 0.2, MIDDLE, mass=3.0, friction=0.5))) as stand:
        weight = 0.5 * 3.0 * GRAVITY
        force = stand.run(stand.start, drive_in(0.3, speed=0.05)).motion.largest_force
        yield from expect(
            force >= 0.9 * weight, f"at least 0.9 of the {weight:.1f} N that friction takes", f"{force:.3g} N"
        )
        free = stand.run(stand.start, drive_in(0.1)).motion.largest_force
        yield from expect_at_most(
            free, subject.tolerances.phantom_force, "the force of an arm that touches nothing (N)"
        )


@check
def a_stalled_arm_stands_still_and_can_go_back(subject: PhysicsUnderTest) -> Faults:
    """Physics.execute: at a stall the arm stands still where it is, with no preload; from there it can go on."""
    scene, way = _against(subject, "back wall")
    with on_stand(subject, scene) as stand:
        stand.physics.restore(stand.start)
        motion = stand.physics.execute(stand.trajectory(stand.start, way), settle=Settle())
        stalled = stand.physics.observe()
        yield from expect(motion.stalled, "a stall", str(motion))
        if stalled.arm is None:
            yield from expect(False, "where the stalled arm is", "an arm that is parked")
            return
        held = stand.physics.execute(stand.standing_still(stalled, 1.0), settle=None)
        still = stand.physics.observe()
        yield from expect_at_most(
            held.largest_force, subject.tolerances.preload, "the force of an arm that stands still (N)"
        )
        yield from expect_at_most(
            _crept(stalled, still), subject.tolerances.stands_still, "how far it creeps in 1 s (m)"
        )
        out = path(_way_out(still.arm or stalled.arm), [Phase.RETREAT])
        back = stand.physics.execute(stand.trajectory(still, out), settle=Settle())
        yield from expect(back.complete, "a retreat to its end", str(back))
        again = stand.run(stalled, path(_way_out(stalled.arm), [Phase.RETREAT]))
        yield from expect(again.motion.complete, "a retreat from the restored stall to its end", str(again.motion))


def _against(subject: PhysicsUnderTest, wall: str) -> tuple[Scene, GripperPath]:
    """An object, and a path that presses it 2.5 cm into a wall without taking the arm there."""
    shape = subject.arm.shape
    finger, half = shape.insertion_width / 2.0, shape.link_width / 2.0
    nearest = max(half, shape.max_opening / 2.0 + finger) + 0.005
    radius = max(0.04, (nearest + 0.025 - finger) / 2.0)
    if wall == "back wall":
        end = SHELF.depth - 2.0 * radius + 0.025
        return scene_of(cylinder("o", SHELF.depth - radius - 0.03, MIDDLE, radius=radius)), drive_in(end)
    ahead = max(finger_length(subject.arm) - radius - 0.005, 0.005)
    y, start, end = radius + 0.02, MIDDLE, nearest
    if wall == "north wall":
        y, start, end = (SHELF.width - value for value in (y, start, end))
    return scene_of(cylinder("o", 0.3, y, radius=radius)), sweep(0.3 + ahead, start, end)


def _sunk(stand: PhysicsStand, state: State) -> float:
    """How far any object on the board is in any wall (m)."""
    return max(
        (excess for row in np.flatnonzero(state.on_board) for excess in _excess(stand, state, int(row))), default=0.0
    )


def _excess(stand: PhysicsStand, state: State, row: int) -> Iterator[float]:
    (x, y), radius, shelf = state.positions[row], float(stand.scene.radii[row]), stand.scene.shelf
    yield radius - float(y)
    yield float(y) + radius - shelf.width
    yield float(x) + radius - shelf.depth


def _way_out(arm: ArmState) -> FloatArray:
    return np.array([arm.gripper, [OUTSIDE, MIDDLE, 0.0]])


def _crept(before: State, after: State) -> float:
    if before.arm is None or after.arm is None:
        return np.inf
    return float(np.abs(after.arm.gripper[:2] - before.arm.gripper[:2]).max())


FORCE_CHECKS: tuple[Check[PhysicsUnderTest], ...] = (
    walls_hold_what_is_pressed_into_them,
    walls_hold_the_arm,
    nothing_passes_through_anything,
    pushes_move_what_is_in_the_way,
    the_arm_passes_over_what_is_lower,
    a_load_too_heavy_stalls_the_arm,
    forces_are_those_of_friction,
    a_stalled_arm_stands_still_and_can_go_back,
)
