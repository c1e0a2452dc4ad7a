"""Drives the arm of a pymunk world along one trajectory and tells what happened."""

from __future__ import annotations

import math

import numpy as np

from phframe.backends.pymunk_gripper import between_fingers, hold, place_arm, set_opening
from phframe.backends.pymunk_quiet import quiet_ticks
from phframe.backends.pymunk_report import motion_of
from phframe.backends.pymunk_state import is_calm, read_state, refuse_divergence, spill
from phframe.backends.pymunk_world import World, note_contact
from phframe.core import FORCE_WINDOW, FloatArray, GripperTrajectory, InputError, Motion, Phase, Settle, Stop, Watch

SPILL_CHECK = 30
"""Steps between looks at what has left the board: 1/8 s at the default step."""
CALM_CHECK = 6
"""Steps between looks at whether all is at rest."""
START_POSITION, START_YAW = 2e-3, 1e-2
"""How far from the arm (m, rad) a trajectory may begin."""
SATURATED = 0.999
"""Share of the force limit at which the drive has nothing left to give."""


class Drive:
    """One run along one trajectory: made, run once and dropped.

    Args:
        world: What moves. A parked arm is put at the trajectory's beginning.
        trajectory: Where the fingertip goes.
        step: Time step (s).
        stall_lag: How far the arm may fall behind before it counts as stalled (m).
        stop: When to end early.
        watch: Who looks on.
    """

    def __init__(
        self,
        world: World,
        trajectory: GripperTrajectory,
        *,
        step: float,
        stall_lag: float,
        stop: Stop | None,
        watch: Watch | None,
    ) -> None:
        self._world, self._trajectory, self._step = world, trajectory, step
        self._stall_lag, self._stop, self._watch = stall_lag, stop, watch
        self._ticks = np.rint(trajectory.times / step).astype(int).tolist()
        self._window = max(1, round(FORCE_WINDOW / step)) if stop is None else 1
        self._period = None if watch is None else max(1, round(watch.period / step))
        self._full_impulse = trajectory.force_limit * step * SATURATED
        self.lag = self.force = 0.0
        self.stalled, self.settled = False, True
        self.cause: str | None = None

    def run(self, settle: Settle | None) -> Motion:
        """Follow the trajectory, then wait for rest."""
        world = self._world
        self._begin()
        for leg in range(len(self._trajectory.phases)):
            if self._ticks[leg + 1] > world.tick and not self._ended:
                self._follow(leg)
        followed = world.tick
        self._halt()
        if settle is not None:
            self._settle(settle)
        self._look(always=True)
        return motion_of(self, world, self._trajectory, self._step, followed)

    @property
    def _ended(self) -> bool:
        return self.stalled or self.cause is not None

    def _begin(self) -> None:
        """Put a parked arm where the trajectory begins, and pass over the time in which nothing can happen."""
        world, trajectory = self._world, self._trajectory
        world.tick = 0
        world.touched.clear()
        world.arm.drive.max_force = trajectory.force_limit
        if world.parked:
            place_arm(world, trajectory.poses[0])
            set_opening(world, float(trajectory.openings[0]))
        _refuse_jump(world, trajectory.poses[0])
        self._look(always=True)
        if world.at_rest and world.held is None:
            self._pass_over(quiet_ticks(world, trajectory, self._ticks))

    def _pass_over(self, ticks: int) -> None:
        """Put the arm where it is after so many steps; show it on the way to whoever looks on."""
        stops = [ticks] if self._period is None or ticks == 0 else [*range(self._period, ticks, self._period), ticks]
        for self._world.tick in stops if ticks else []:
            pose, opening = self._trajectory.at(self._world.tick * self._step)
            place_arm(self._world, pose)
            set_opening(self._world, opening)
            self._look()

    def _follow(self, leg: int) -> None:
        """Drive the carrier along what is left of a leg."""
        world, trajectory, end = self._world, self._trajectory, self._ticks[leg + 1]
        world.arm.body.each_arbiter(note_contact, world.space, world)
        self._set_speed(trajectory.poses[leg + 1], (end - world.tick) * self._step)
        world.at_rest = False
        grips = trajectory.openings[leg] != trajectory.openings[leg + 1]
        while world.tick < end and not self._ended:
            if grips:
                self._move_fingers(closing=trajectory.phases[leg] is Phase.GRASP)
            self._advance(min(world.tick + (1 if grips else self._window), end))
            self._inspect()
        refuse_divergence(world)

    def _set_speed(self, target: FloatArray, duration: float) -> None:
        """Make the carrier arrive at a pose in time; the drive need not accelerate the arm itself."""
        carrier, body = self._world.arm.carrier, self._world.arm.body
        x, y = carrier.position
        carrier.velocity = (float(target[0]) - x) / duration, (float(target[1]) - y) / duration
        carrier.angular_velocity = (float(target[2]) - carrier.angle) / duration
        body.velocity, body.angular_velocity = carrier.velocity, carrier.angular_velocity

    def _move_fingers(self, *, closing: bool) -> None:
        """Set the opening for the next step; fingers that close on an object hold it and stop."""
        world = self._world
        _, world.command = self._trajectory.at((world.tick + 1) * self._step)
        if closing and world.held is None and (item := between_fingers(world)) is not None:
            hold(world, item)
        if world.held is None:
            set_opening(world, world.command)

    def _advance(self, end: int) -> None:
        """Step to a number of steps and note the mean force on the way; the hot path."""
        world, step, dt, drive = self._world, self._world.space.step, self._step, self._world.arm.drive
        begin, total = world.tick, 0.0
        for world.tick in range(begin + 1, end + 1):
            step(dt)
            total += drive.impulse
            if self._period is not None:
                self._look()
        mean = total / (end - begin)
        self.force = max(self.force, mean / dt)
        if mean >= self._full_impulse:
            self._note_lag()

    def _note_lag(self) -> None:
        """The drive gives all it has: see how far the arm is behind, and whether that is a stall."""
        arm = self._world.arm
        lag = arm.body.position.get_distance(arm.carrier.position)
        self.lag = max(self.lag, lag)
        self.stalled = self.stalled or lag > self._stall_lag

    def _inspect(self) -> None:
        """Take out what spilled and see whether the motion must end."""
        if self._world.tick % SPILL_CHECK < self._window:
            spill(self._world)
        if self._stop is not None and self.cause is None:
            self.cause = _cause(self._stop, self._world, self.force)

    def _halt(self) -> None:
        """Stand still, and where the arm could not follow, forget where it should have been."""
        arm = self._world.arm
        arm.carrier.velocity = arm.body.velocity = 0.0, 0.0
        arm.carrier.angular_velocity = arm.body.angular_velocity = 0.0
        if self._ended:
            arm.carrier.position, arm.carrier.angle = arm.body.position, arm.body.angle
        spill(self._world)

    def _settle(self, settle: Settle) -> None:
        """Wait until everything has been calm for long enough."""
        world = self._world
        calm, limit = 0, world.tick + math.ceil(settle.timeout / self._step)
        while calm * self._step < settle.hold and world.tick < limit and not world.at_rest:
            self._advance(world.tick + CALM_CHECK)
            refuse_divergence(world)
            spill(world)
            calm = calm + CALM_CHECK if is_calm(world, settle.speed) else 0
        world.at_rest = self.settled = world.at_rest or calm * self._step >= settle.hold

    def _look(self, *, always: bool = False) -> None:
        """Show the world to whoever looks on, once in every period."""
        if self._watch is not None and (always or self._world.tick % (self._period or 1) == 0):
            self._watch.look(self._world.tick * self._step, read_state(self._world))


def _refuse_jump(world: World, pose: FloatArray) -> None:
    x, y = world.arm.body.position
    distance, turn = math.hypot(pose[0] - x, pose[1] - y), abs(float(pose[2]) - world.arm.body.angle)
    if distance > START_POSITION or turn > START_YAW:
        raise InputError(f"the trajectory begins {distance:.3f} m and {turn:.3f} rad from where the arm is")


def _cause(stop: Stop, world: World, force: float) -> str | None:
    """Why a motion must end now, if it must."""
    for _, _, name, wall in world.touched:
        if (wall and stop.wall) or name in stop.bodies:
            return f"contact with {'the ' if wall else ''}{name}"
    if stop.force is not None and force > stop.force:
        return f"a force of {force:.0f} N"
    return None
