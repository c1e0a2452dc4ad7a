"""Drives the arm of a pymunk world along one trajectory and tells what happened."""

from __future__ import annotations

import math
from collections import deque

from phframe.backends.contract import START_ANGLE, START_POSITION, first_contacts, force_reason, touch_reason
from phframe.backends.pymunk_ import chipmunk
from phframe.backends.pymunk_.braking import Pace, pace
from phframe.backends.pymunk_.fast_forward import Pose, free_fraction, is_still, stays_outside
from phframe.backends.pymunk_.floors import Lookout
from phframe.backends.pymunk_.gripper import (
    between_fingers,
    drag,
    gripped,
    hold,
    place_arm,
    place_held,
    release,
    set_opening,
)
from phframe.backends.pymunk_.state import is_calm, read_state, refuse_divergence, survey
from phframe.backends.pymunk_.world import ShelfSpace, note_contact, overlap
from phframe.core import (
    FORCE_WINDOW,
    GripperTrajectory,
    InputError,
    Motion,
    Settle,
    Stop,
    StopReason,
    Watch,
)

SURVEY = 30
"""Steps between looks at what has left the board and whether all is still again: 1/8 s at the default step."""
CALM_CHECK = 6
"""Steps between looks at whether all is at rest."""
COMPLY_SPEED, COMPLY_STEPS, COMPLY_CHECK, COMPLIED = 0.05, 60, 4, 1e-5
"""How fast (m/s), for how many steps, looking how often, and down to which overlap (m) a stalled arm complies."""
SATURATED = 0.999
"""Fraction of the force limit at which the drive has nothing left to give."""


class PymunkDrive:
    """One run along one trajectory: made, run once and dropped.

    Args:
        world: What moves. A parked arm is put at the trajectory's beginning.
        trajectory: Where the fingertip goes.
        step: Time step (s).
        stall_lag: How far the arm may fall behind before it counts as stalled (m).
        acceleration: With which the arm brakes at the end of each leg (m/s^2); None: it stops dead.
        stop: When to end early.
        watch: Who looks on.
    """

    def __init__(
        self,
        world: ShelfSpace,
        trajectory: GripperTrajectory,
        *,
        step: float,
        stall_lag: float,
        acceleration: float | None,
        stop: Stop | None,
        watch: Watch | None,
    ) -> None:
        self._world, self._trajectory, self._step = world, trajectory, step
        self._stall_lag, self._stop, self._watch = stall_lag, stop, watch
        self._acceleration = acceleration
        self._ticks = [round(time / step) for time in trajectory.times.tolist()]
        self._poses: list[Pose] = trajectory.poses.tolist()
        window = max(1, round(FORCE_WINDOW / step))
        self._impulses: deque[float] = deque([0.0] * window, window)
        self._period = None if watch is None else max(1, round(watch.period / step))
        self._full_impulse = trajectory.force_limit * step * SATURATED
        self._lag = self._force = 0.0
        self._stalled, self._settled = False, True
        self._cause: StopReason | None = None
        self._lookout = Lookout(world, step)

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
        return self._motion(followed * self._step)

    @property
    def _ended(self) -> bool:
        return self._stalled or self._cause is not None

    def _begin(self) -> None:
        """Put a parked arm where the trajectory begins, and see that the trajectory begins there."""
        world, trajectory = self._world, self._trajectory
        world.tick = 0
        world.touched.clear()
        world.begun.clear()
        chipmunk.set_max_force(world.arm.drive, trajectory.force_limit)
        if world.parked:
            place_arm(world, self._poses[0])
            set_opening(world, float(trajectory.openings[0]))
        _refuse_jump(world, self._poses[0])
        self._look(always=True)

    def _follow(self, leg: int) -> None:
        """Drive the carrier along a leg, fast-forwarding over what is free while all is still."""
        world, trajectory, end = self._world, self._trajectory, self._ticks[leg + 1]
        for part, other, _ in chipmunk.contacts(world.arm.body):
            note_contact(world, part, other)
        self._lookout.expect(self._top_speed(leg, end - world.tick))
        if trajectory.openings[leg] != trajectory.openings[leg + 1]:
            self._open_or_close(leg, end)
        pace = self._pace(leg, end - world.tick)
        while world.tick < end and not self._ended:
            if world.tick < end - pace.braking:
                self._fast_forward(leg, end, pace)
            if world.tick < end:
                self._drive(leg, end, pace)
        refuse_divergence(world)

    def _pace(self, leg: int, steps: int) -> Pace:
        """How to come to rest at the end of a leg."""
        if self._acceleration is None or steps <= 0:
            return Pace()
        x, y, _ = self._way(leg)
        return pace(math.hypot(x, y), steps, self._acceleration * self._step**2)

    def _way(self, leg: int) -> Pose:
        """How far a leg goes and turns."""
        return [b - a for a, b in zip(self._poses[leg], self._poses[leg + 1], strict=True)]

    def _top_speed(self, leg: int, steps: int) -> float:
        """How fast (m/s) any part of the arm goes on a leg at most."""
        x, y, turn = self._way(leg)
        way = math.hypot(x, y) + abs(turn) * self._world.measures.length
        return way / (self._pace(leg, steps).work(steps) * self._step)

    def _fast_forward(self, leg: int, end: int, pace: Pace) -> None:
        """Put the arm as far along a leg as nothing can happen, showing it on the way to whoever looks on."""
        world, target = self._world, self._poses[leg + 1]
        if not (world.at_rest or is_still(world)):
            return
        start = [*world.arm.carrier.position, world.arm.carrier.angle]
        force = drag(world) if start != target else 0.0
        if force >= self._strength:
            return
        held = None if world.held is None else world.items[world.held].body.position
        begin, work = world.tick, pace.work(end - world.tick)
        fraction = free_fraction(world, start, target)
        free = end - begin if fraction >= 1.0 else min(math.floor(fraction * work), end - begin - pace.braking)
        self._impulses.extend([force * self._step] * min(free, len(self._impulses)))
        self._force = max(self._force, force if free > 0 else 0.0)
        self._lookout.due = 0.0
        for world.tick in self._stops(begin, begin + free):
            done = 1.0 - pace.work(end - world.tick) / work
            x, y, turn = ((b - a) * done for a, b in zip(start, target, strict=True))
            place_arm(world, (start[0] + x, start[1] + y, start[2] + turn))
            if held is not None:
                place_held(world, (held[0] + x, held[1] + y))
            self._look()

    @property
    def _strength(self) -> float:
        """The force (N) from which on the arm stalls or stops."""
        stop = None if self._stop is None else self._stop.force
        return min(self._full_impulse / self._step, math.inf if stop is None else stop)

    def _stops(self, begin: int, end: int) -> list[int]:
        """The steps, after the first, at which somebody looks on, and the last."""
        if self._period is None or end == begin:
            return [end] if end > begin else []
        first = (begin // self._period + 1) * self._period
        return [*range(first, end, self._period), end]

    def _drive(self, leg: int, end: int, pace: Pace) -> None:
        """Step along a leg as long as the speed stays, looking after the arm on the way."""
        world, left = self._world, end - self._world.tick
        self._set_speed(self._poses[leg + 1], pace.steps(left) * self._step)
        world.at_rest = False
        self._advance(world.tick + min(SURVEY, max(left - pace.braking, 1)))
        survey(world)

    def _open_or_close(self, leg: int, end: int) -> None:
        """Move the fingers along a leg, until they hold something; before the mouth, where they meet nothing, at once."""
        world, trajectory, begin = self._world, self._trajectory, self._world.tick
        first, last = (float(opening) for opening in trajectory.openings[leg : leg + 2])
        if world.at_rest and stays_outside(world, self._poses[leg], self._poses[leg + 1]):
            set_opening(world, last)
            return
        if world.held is not None and last <= world.opening:
            world.command = last
            return
        within_reach = between_fingers(world) if last < first and world.held is None else []
        self._set_speed(self._poses[leg + 1], (end - begin) * self._step)
        world.at_rest = False
        while world.tick < end and not self._ended:
            if (item := gripped(world, within_reach)) is not None:
                hold(world, item, last)
                return
            self._set_opening(first + (last - first) * ((world.tick + 1 - begin) / (end - begin)))
            self._advance(world.tick + 1)

    def _set_opening(self, told: float) -> None:
        """Put the fingers where they are told (m); they leave what they squeeze once they are told to be wider than it."""
        world = self._world
        if world.held is not None and told <= world.opening:
            world.command = told
            return
        if world.held is not None:
            release(world)
        set_opening(world, told)

    def _set_speed(self, target: Pose, duration: float) -> None:
        """Make the carrier arrive at a pose in time; the drive need not accelerate the arm itself, nor what it can carry."""
        world, carrier, body = self._world, self._world.arm.carrier, self._world.arm.body
        x, y = carrier.position
        velocity, spin = (
            ((target[0] - x) / duration, (target[1] - y) / duration),
            (target[2] - carrier.angle) / duration,
        )
        carrier.velocity = body.velocity = velocity
        carrier.angular_velocity = body.angular_velocity = spin
        if world.held is not None and drag(world) * self._step < self._full_impulse:
            carried = world.items[world.held].body
            carried.velocity = body.velocity_at(carried.position)
            carried.angular_velocity = body.angular_velocity

    def _advance(self, end: int) -> None:
        """Step until a number of steps or an end, and keep the mean force of the last 20 ms; the hot path."""
        world, dt, step, impulse_of = self._world, self._step, chipmunk.step, chipmunk.impulse_of
        space, drive, begun = world.space.handle, world.arm.drive, world.begun
        impulses, lookout, watched, begin = self._impulses, self._lookout, self._watch is not None, world.tick
        total, window, largest, full = sum(impulses), len(impulses), 0.0, self._full_impulse
        for world.tick in range(begin + 1, end + 1):
            if world.tick >= lookout.due:
                lookout.look()
            step(space, dt)
            impulse = impulse_of(drive)
            total += impulse - impulses[0]
            impulses.append(impulse)
            mean = total / window
            if impulse > 0.0 and (mean > largest or mean >= full):
                largest = max(largest, mean)
                self._weigh(mean)
            if watched:
                self._look()
            if begun:
                self._note_touches()
            if self._stalled or self._cause is not None:
                return

    def _weigh(self, mean: float) -> None:
        """Note the mean impulse of a step; where the drive gives all it has, see whether the arm still follows."""
        self._force = max(self._force, mean / self._step)
        if mean >= self._full_impulse:
            self._note_lag()
        self._cause = self._cause or force_reason(self._stop, mean / self._step)

    def _note_touches(self) -> None:
        """Write down what the arm began to touch in a step, and see whether that ends the motion."""
        world = self._world
        for part, other in world.begun:
            note_contact(world, part, other)
        world.begun.clear()
        if self._stop is not None:
            self._cause = self._cause or touch_reason(self._stop, world.touched)

    def _note_lag(self) -> None:
        """The drive gives all it has: see how far the arm is behind, and whether that is a stall."""
        arm = self._world.arm
        (x0, y0), (x1, y1) = arm.body.position, arm.carrier.position
        lag = math.sqrt((x0 - x1) ** 2 + (y0 - y1) ** 2)
        self._lag = max(self._lag, lag)
        self._stalled = self._stalled or lag > self._stall_lag

    def _halt(self) -> None:
        """Stand still, and where the arm could not follow, forget where it should have been."""
        arm = self._world.arm
        self._stalled = self._stalled and self._cause is None
        if self._ended:
            self._stop = None  # one cause: what comes after is none of it
        if self._stalled:
            self._comply()
            self._stalled = True
        arm.carrier.velocity = arm.body.velocity = 0.0, 0.0
        arm.carrier.angular_velocity = arm.body.angular_velocity = 0.0
        if self._ended:
            arm.carrier.position, arm.carrier.angle = arm.body.position, arm.body.angle
        survey(self._world)

    def _comply(self) -> None:
        """Comply: go back along where the arm came from, while what it pressed together comes apart again."""
        arm, world = self._world.arm, self._world
        self._stalled = False
        x, y = arm.carrier.velocity
        slow = COMPLY_SPEED / max(math.hypot(x, y), COMPLY_SPEED)
        arm.carrier.position, arm.carrier.angle = arm.body.position, arm.body.angle
        arm.carrier.angular_velocity = arm.body.angular_velocity = 0.0
        until = world.tick + COMPLY_STEPS
        while world.tick < until:
            fraction = slow if overlap(world) > COMPLIED else 0.0
            arm.carrier.velocity = arm.body.velocity = -fraction * x, -fraction * y
            self._advance(world.tick + COMPLY_CHECK)

    def _settle(self, settle: Settle) -> None:
        """Wait until everything has been calm for long enough."""
        world = self._world
        world.at_rest = world.at_rest or is_still(world)
        calm, limit = 0, world.tick + math.ceil(settle.timeout / self._step)
        while calm * self._step < settle.hold and world.tick < limit and not world.at_rest:
            self._advance(world.tick + CALM_CHECK)
            refuse_divergence(world)
            survey(world)
            calm = calm + CALM_CHECK if is_calm(world, settle.speed) else 0
        world.at_rest = self._settled = world.at_rest or calm * self._step >= settle.hold

    def _look(self, *, always: bool = False) -> None:
        """Show the world to whoever looks on, once in every period."""
        if self._watch is not None and (always or self._world.tick % (self._period or 1) == 0):
            self._watch.look(self._world.tick * self._step, read_state(self._world))

    def _motion(self, followed: float) -> Motion:
        """What happened, of which the trajectory was followed for so long (s)."""
        touches = [(tick * self._step, part, body, wall) for tick, part, body, wall in self._world.touched]
        contacts, walls = (tuple(first_contacts(touches, self._trajectory, walls=walls)) for walls in (False, True))
        return Motion(
            duration=self._world.tick * self._step,
            contacts=contacts,
            wall_contacts=walls,
            largest_force=self._force,
            stalled=self._stalled,
            stopped=self._cause,
            tracking_error=self._lag,
            settled=self._settled,
            followed=followed,
        )


def _refuse_jump(world: ShelfSpace, pose: Pose) -> None:
    x, y = world.arm.body.position
    distance, turn = math.hypot(pose[0] - x, pose[1] - y), abs(pose[2] - world.arm.body.angle)
    if distance > START_POSITION or turn > START_ANGLE:
        raise InputError(f"the trajectory begins {distance:.3f} m and {turn:.3f} rad from where the arm is")
