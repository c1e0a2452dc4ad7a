"""Drives the arm of a world along one trajectory of its joints and tells what happened."""

from __future__ import annotations

import math
from collections import deque

from phframe.backends.articulated.commands import accepted, commands
from phframe.backends.articulated.contacts import TouchLog
from phframe.backends.articulated.force_limiter import ForceLimiter
from phframe.backends.articulated.world import ArticulatedWorld
from phframe.backends.contract import first_contacts, force_reason, touch_reason
from phframe.core import FORCE_WINDOW, JointTrajectory, Motion, Settle, Stop, StopReason, Trajectory, Watch

SURVEY = 10
"""Control steps between looks at what has left the board."""
CALM_CHECK = 5
"""Control steps between looks at whether all is at rest."""
COMPLYING = 0.1
"""For at least this long (s) a stopped arm complies to what presses on it, so that it stands with no preload."""
LONGEST_COMPLYING, COMPLIED = 0.5, 3.0
"""A slow, heavy one does so for up to so long (s), until it is pressed by no more than this (N)."""


class JointDrive:
    """One run along one trajectory: made, run once and dropped.

    Args:
        world: What moves.
        trajectory: Where the joints go.
        stall_lag: How far the fingertip may fall behind before it counts as stalled (m).
        stop: When to end early.
        watch: Who looks on.

    Raises:
        InputError: If the arm cannot follow the trajectory from where it is.
    """

    def __init__(
        self,
        world: ArticulatedWorld,
        trajectory: Trajectory,
        *,
        stall_lag: float,
        stop: Stop | None,
        watch: Watch | None,
    ) -> None:
        self._world, self._engine = world, world.engine
        self._trajectory: JointTrajectory = accepted(world, trajectory)
        self._period = world.engine.period
        self._stall_lag, self._stop, self._watch = stall_lag, stop, watch
        self._touches = TouchLog(world)
        window = max(1, round(FORCE_WINDOW / self._period))
        self._forces = deque([0.0] * window, maxlen=window)
        self._limiter = ForceLimiter(world.engine, world.arm, self._trajectory.force_limit)
        self._tick, self._pressed, self._next_look = 0, 0, 0.0
        self._force = self._lag = 0.0
        self._stalled, self._settled = False, True
        self._cause: StopReason | None = None

    def run(self, settle: Settle | None) -> Motion:
        """Follow the trajectory, then wait for rest.

        Raises:
            SimulationDivergedError: If the engine's numbers are no longer physical.
        """
        self._world.refuse_divergence()
        self._world.parked = False
        self._look(always=True)
        with self._engine.running():
            self._follow()
            followed = self._tick * self._period
            self._limiter.release()
            if self._ended:
                self._stop = None  # one cause: what comes after is none of it
                self._comply()
            if settle is not None:
                self._settle(settle)
            self._world.survey()
        self._look(always=True)
        return self._motion(followed)

    @property
    def _ended(self) -> bool:
        return self._stalled or self._cause is not None

    def _follow(self) -> None:
        """Tell the joints where to be, step by step, until something ends it."""
        told = commands(self._world, self._trajectory)
        phase, command, advance = None, self._engine.command, self._advance
        for control, now, (x, y) in zip(told.controls, told.phases, told.tips.tolist(), strict=True):
            if now is not phase:
                phase = now
                self._touches.forget_phase()
            command(control)
            if self._pressed and self._limiter.heed(self._forces[-1], touched=any(self._forces)):
                self._engine.comply()
            tip_x, tip_y = advance()
            lag = math.hypot(tip_x - x, tip_y - y)
            if lag > self._lag:
                self._note_lag(lag)
            if self._stalled or self._cause is not None:
                self._stalled = self._stalled and self._cause is None
                return
        self._world.stand_still(self._trajectory.positions[-1])

    def _advance(self) -> tuple[float, float]:
        """One control step, and where the fingertip then is, x and y (m). The hot path."""
        world = self._world
        tip_x, tip_y, touching, force = self._engine.advance()
        self._tick = tick = self._tick + 1
        if touching or self._pressed or world.held is not None:
            self._feel(touching, force)
        if tick % SURVEY == 0:
            world.survey()
        if self._watch is not None:
            self._look()
        return tip_x, tip_y

    def _feel(self, touching: float, force: float) -> None:
        """Note so many contacts of the arm and the force (N) on it, and what they are a reason to stop for."""
        if touching:
            self._pressed = len(self._forces)
        elif self._pressed:
            self._pressed -= 1
        self._touches.look(self._tick * self._period, touching)
        self._forces.append(force)
        self._force = max(self._force, sum(self._forces) / len(self._forces))
        stop = self._stop
        if stop is not None and self._cause is None and (stop.force is not None or self._touches.any_news):
            self._cause = self._reason(stop)

    def _note_lag(self, lag: float) -> None:
        """Note how far at most the fingertip has been from where it is meant to be."""
        self._lag = lag
        self._stalled = self._stalled or lag > self._stall_lag

    def _reason(self, stop: Stop) -> StopReason | None:
        """Why to end early now, if there is a reason."""
        return touch_reason(stop, self._touches.news()) or force_reason(stop, self._force)

    def _comply(self) -> None:
        """Let what presses on the arm push it back, and stand where it then is."""
        least, most = (round(time / self._period) for time in (COMPLYING, LONGEST_COMPLYING))
        for tick in range(most):
            if tick >= least and self._forces[-1] <= COMPLIED:
                break
            self._engine.comply()
            self._advance()
        self._world.stand_still(self._engine.arm().joints)

    def _settle(self, settle: Settle) -> None:
        """Wait until everything has been calm for long enough."""
        calm, begin = 0, self._tick
        span = CALM_CHECK * self._period
        while calm * span < settle.hold and (self._tick - begin) * self._period < settle.timeout:
            for _ in range(CALM_CHECK):
                self._advance()
            calm = calm + 1 if (self._world.speeds < settle.speed).all() else 0
        self._settled = calm * span >= settle.hold

    def _look(self, *, always: bool = False) -> None:
        """Show the world to whoever looks on, once in every period."""
        watch, time = self._watch, self._tick * self._period
        if watch is None or not (always or time >= self._next_look - 1e-9):
            return
        watch.look(time, self._world.read_state())
        self._next_look = (math.floor(time / watch.period + 1e-9) + 1) * watch.period

    def _motion(self, followed: float) -> Motion:
        contacts, walls = (
            tuple(first_contacts(self._touches.found, self._trajectory.gripper, walls=walls, delay=self._period / 2.0))
            for walls in (False, True)
        )
        return Motion(
            duration=self._tick * self._period,
            contacts=contacts,
            wall_contacts=walls,
            largest_force=self._force,
            stalled=self._stalled,
            stopped=self._cause,
            tracking_error=self._lag,
            settled=self._settled,
            followed=followed,
        )
