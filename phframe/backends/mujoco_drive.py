"""Drives the arm of a MuJoCo world along one trajectory of its joints and tells what happened."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator

import mujoco

from phframe.backends.mujoco_commands import accepted, commands
from phframe.backends.mujoco_limiter import Limiter
from phframe.backends.mujoco_touch import Touches
from phframe.backends.mujoco_warnings import caught_warnings
from phframe.backends.mujoco_world import World, read_state, refuse_divergence, spill
from phframe.core import FORCE_WINDOW, Contact, JointTrajectory, Motion, Settle, Stop, Trajectory, Watch

CONTROL_PERIOD = 0.004
"""Between commands to the servos, and between looks at what the arm touches (s)."""
SURVEY = 10
"""Control steps between looks at what has left the board."""
CALM_CHECK = 5
"""Control steps between looks at whether all is at rest."""
YIELDING = 0.1
"""For at least this long (s) a stopped arm gives way to what presses on it, so that it stands with no preload."""
LONGEST_YIELDING, YIELDED = 0.5, 3.0
"""A slow, heavy one does so for up to so long (s), until it is pressed by no more than this (N)."""


class Drive:
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
        self, world: World, trajectory: Trajectory, *, stall_lag: float, stop: Stop | None, watch: Watch | None
    ) -> None:
        self._world, self._model, self._data = world, world.model.mj, world.data
        self._trajectory: JointTrajectory = accepted(world, trajectory)
        self._substeps = max(1, round(CONTROL_PERIOD / self._model.opt.timestep))
        self._period = self._substeps * self._model.opt.timestep
        self._stall_lag, self._stop, self._watch = stall_lag, stop, watch
        self._touches = Touches(world)
        window = max(1, round(FORCE_WINDOW / self._period))
        self._forces = deque([0.0] * window, maxlen=window)
        self._limiter = Limiter(world, self._trajectory.force_limit)
        self._tick, self._pressed, self._next_look = 0, 0, 0.0
        self._tip = [0.0, 0.0, 0.0]
        self._force = self._lag = 0.0
        self._stalled, self._settled = False, True
        self._cause: str | None = None
        self._warnings: list[str] = []

    def run(self, settle: Settle | None) -> Motion:
        """Follow the trajectory, then wait for rest.

        Raises:
            SimulationDivergedError: If the engine's numbers are no longer physical.
        """
        self._world.parked = False
        self._look(always=True)
        with caught_warnings() as self._warnings:
            self._follow()
            followed = self._tick * self._period
            self._limiter.release()
            if self._ended:
                self._yield()
            if settle is not None:
                self._settle(settle)
            self._survey()
        self._look(always=True)
        return self._motion(followed)

    @property
    def _ended(self) -> bool:
        return self._stalled or self._cause is not None

    def _follow(self) -> None:
        """Tell the servos where to be, step by step, until something ends it."""
        told = commands(self._world.model, self._trajectory, self._period)
        phase, ctrl = None, self._data.ctrl
        for control, now, (x, y) in zip(told.controls, told.phases, told.tips.tolist(), strict=True):
            if now is not phase:
                phase = now
                self._touches.forget_phase()
            ctrl[:] = control
            if self._pressed and self._limiter.heed(self._forces[-1], touched=any(self._forces)):
                self._give_way()
            self._advance()
            self._note_lag(x, y)
            if self._ended:
                self._stalled = self._stalled and self._cause is None
                return
        self._data.ctrl[: self._world.model.dof] = self._trajectory.positions[-1]

    def _give_way(self) -> None:
        """Ask nothing of the arm but to come to a stop where it is."""
        self._data.ctrl[: self._world.model.dof] = self._world.joints

    def _advance(self) -> None:
        """One control step. The hot path."""
        mujoco.mj_step(self._model, self._data, self._substeps)
        self._tick += 1
        self._tip = self._data.xpos[self._world.model.tip].tolist()
        touching, *force = self._data.sensordata.tolist()
        if touching:
            self._pressed = len(self._forces)
        if self._pressed or self._world.held is not None:
            self._feel(touching, math.hypot(*force))
        if self._tick % SURVEY == 0:
            self._survey()
        if self._watch is not None:
            self._look()

    def _feel(self, touching: float, force: float) -> None:
        """Note so many contacts of the arm and the force (N) on it, and what they are a reason to stop for."""
        self._pressed -= self._pressed > 0 and not touching
        self._touches.look(self._tick * self._period, touching)
        self._forces.append(force)
        self._force = max(self._force, sum(self._forces) / len(self._forces))
        if self._stop is not None and self._cause is None:
            self._cause = self._reason(self._stop)

    def _survey(self) -> None:
        refuse_divergence(self._world, self._warnings)
        spill(self._world)

    def _note_lag(self, x: float, y: float) -> None:
        """See how far the fingertip is from where it is meant to be."""
        lag = math.hypot(self._tip[0] - x, self._tip[1] - y)
        self._lag = max(self._lag, lag)
        self._stalled = self._stalled or lag > self._stall_lag

    def _reason(self, stop: Stop) -> str | None:
        """Why to end early now, if there is a reason."""
        for _, _, name, wall in self._touches.news():
            if (wall and stop.wall) or name in stop.bodies:
                return f"contact with {'the ' if wall else ''}{name}"
        if stop.force is not None and self._force > stop.force:
            return f"a force of {self._force:.0f} N"
        return None

    def _yield(self) -> None:
        """Let what presses on the arm push it back, and stand where it then is."""
        least, most = (round(time / self._period) for time in (YIELDING, LONGEST_YIELDING))
        for tick in range(most):
            if tick >= least and self._forces[-1] <= YIELDED:
                break
            self._give_way()
            self._advance()
        self._give_way()

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
        watch.look(time, read_state(self._world))
        self._next_look = (math.floor(time / watch.period + 1e-9) + 1) * watch.period

    def _motion(self, followed: float) -> Motion:
        return Motion(
            duration=self._tick * self._period,
            contacts=tuple(self._contacts(walls=False)),
            wall_contacts=tuple(self._contacts(walls=True)),
            largest_force=self._force,
            stalled=self._stalled,
            stopped=self._cause,
            tracking_error=self._lag,
            settled=self._settled,
            followed=followed,
        )

    def _contacts(self, *, walls: bool) -> Iterator[Contact]:
        """The first contact of each part with each body in each phase."""
        seen = set()
        for time, part, body, wall in self._touches.found:
            phase = self._trajectory.gripper.phase_at(time - self._period / 2.0)
            if wall is walls and (part, body, phase) not in seen:
                seen.add((part, body, phase))
                yield Contact(time, body, phase, part)
