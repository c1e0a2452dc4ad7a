"""States and trajectories as arrays, and arrays as states and motions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from phframe.backends.fast_ import layout
from phframe.backends.fast_.layout import WALL_NAMES
from phframe.core import (
    ArmShape,
    ArmState,
    Condition,
    Contact,
    FloatArray,
    Floats,
    GripperTrajectory,
    Motion,
    Phase,
    Scene,
    Settle,
    SimulationDivergedError,
    State,
    Stop,
    StopCause,
    StopReason,
    Value,
)

PHASES = {phase: number for number, phase in enumerate(Phase)}
"""Numbers of the phases."""


class StateReader:
    """Turns states of one scene and arm into arrays and back.

    Args:
        scene: The scene.
        shape: Of the arm.
    """

    def __init__(self, scene: Scene, shape: ArmShape) -> None:
        self._ids, self._shape = scene.ids, shape
        self._rows = {name: row for row, name in enumerate(scene.ids)}
        self._heights = np.array([item.shape.height / 2.0 for item in scene.objects])
        self._upright = (Condition.UPRIGHT,) * len(scene.ids)

    def bodies(self, state: State) -> FloatArray:
        """The rows of the objects ``(n, 7)``: poses, speeds (0), presence."""
        w, x, y, z = state.poses[:, 3:].T
        found = np.zeros((len(self._ids), layout.PRESENT + 1))
        found[:, : layout.Y + 1] = state.poses[:, :2]
        found[:, layout.TURN] = np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))
        found[:, layout.PRESENT] = 1.0 if state.conditions == self._upright else state.on_board
        return found

    def arm(self, state: State) -> FloatArray:
        """The row of the arm."""
        row = np.zeros(layout.ARM_FIELDS)
        row[layout.HELD], row[layout.RESTING] = -1.0, 1.0
        row[layout.OPENING] = row[layout.COMMAND] = self._shape.min_opening
        if state.arm is None:
            row[layout.PARKED] = 1.0
            return row
        row[layout.BODY_X : layout.YAW + 1] = row[layout.CARRIER_X : layout.CARRIER_YAW + 1] = state.arm.gripper
        row[layout.OPENING], row[layout.COMMAND] = state.arm.opening, state.arm.commanded_opening
        row[layout.HELD] = -1.0 if state.held is None else self._rows[state.held]
        return row

    def state(self, bodies: FloatArray, arm: FloatArray, before: State) -> State:
        """The state that arrays hold.

        Args:
            bodies: The rows of the objects.
            arm: The row of the arm.
            before: What was restored: what lay on its side or had spilled then does so now.
        """
        bodies = bodies[: len(self._ids)]
        half, present = bodies[:, layout.TURN] / 2.0, bodies[:, layout.PRESENT]
        full = np.zeros((len(bodies), 7))
        full[:, :2], full[:, 2] = bodies[:, : layout.Y + 1], self._heights
        full[:, 3], full[:, 6] = np.cos(half), np.sin(half)
        conditions = self._upright
        if not present.all() or before.conditions != self._upright:
            gone = ~before.on_board
            full[gone] = before.poses[gone]
            conditions = tuple(
                was if there == 1.0 else Condition.SPILLED
                for was, there in zip(before.conditions, present.tolist(), strict=True)
            )
        held = int(arm[layout.HELD])
        return State(full, conditions, None if held < 0 else self._ids[held], _arm_state(arm))

    def motion(self, figures: FloatArray, events: FloatArray, trajectory: GripperTrajectory) -> Motion:
        """What is told of a motion.

        Args:
            figures: See ``FastRun``.
            events: Likewise.
            trajectory: That was followed.

        Raises:
            SimulationDivergedError: If an object became faster than physics allows.
        """
        told = figures.tolist()
        if told[layout.DIVERGED] >= 0.0:
            name = self._ids[int(told[layout.DIVERGED])]
            raise SimulationDivergedError(
                f"the simulation diverged: {name!r} moves too fast; try a smaller backend step"
            )
        contacts = [self._contact(event, trajectory) for event in events[: int(told[layout.EVENTS])].tolist()]
        return Motion(
            duration=told[layout.TIME],
            contacts=tuple(contact for wall, contact in contacts if not wall),
            wall_contacts=tuple(contact for wall, contact in contacts if wall),
            largest_force=told[layout.LARGEST_FORCE],
            stalled=told[layout.STALLED] == 1.0,
            stopped=self._reason(told),
            tracking_error=told[layout.LARGEST_LAG],
            settled=told[layout.SETTLED] == 1.0,
            followed=told[layout.FOLLOWED],
        )

    def _contact(self, event: list[float], trajectory: GripperTrajectory) -> tuple[bool, Contact]:
        time, part, what, leg = event
        name, wall = self._name(int(what))
        return wall, Contact(time, name, trajectory.phases[int(leg)], self._shape.closed[int(part)].part)

    def _name(self, what: int) -> tuple[str, bool]:
        """What an object or a wall is called, and whether it is a wall."""
        wall = what - len(self._ids)
        return (self._ids[what], False) if wall < 0 else (WALL_NAMES[wall], True)

    def _reason(self, told: list[float]) -> StopReason | None:
        cause = int(told[layout.CAUSE])
        if cause == layout.NO_CAUSE:
            return None
        if cause == layout.FORCE_CAUSE:
            return StopReason(StopCause.FORCE, force=told[layout.CAUSE_FORCE])
        name, wall = self._name(int(told[layout.CAUSE_BODY]))
        return StopReason(StopCause.WALL if wall else StopCause.CONTACT, name)

    def limits(self, force: float, stop: Stop | None, braking: float | None, settle: Settle | None) -> FloatArray:
        """The row of ``FastPath.limits``."""
        found = np.zeros(layout.STOPS + len(self._ids) + len(WALL_NAMES))
        stop_force = np.inf if stop is None or stop.force is None else stop.force
        waiting = (0.0, 0.0, 0.0) if settle is None else (settle.speed, settle.hold, settle.timeout)
        found[: layout.STOPS] = force, stop_force, braking or 0.0, *waiting
        if stop is not None:
            found[layout.STOPS + len(self._ids) :] = stop.wall
            for name in stop.bodies & self._rows.keys():
                found[layout.STOPS + self._rows[name]] = 1.0
        return found


def _arm_state(arm: FloatArray) -> ArmState | None:
    if arm[layout.PARKED] == 1.0:
        return None
    return ArmState(arm[layout.BODY_X : layout.YAW + 1], float(arm[layout.OPENING]), float(arm[layout.COMMAND]))


def legs_of(trajectory: GripperTrajectory) -> FloatArray:
    """The rows of ``FastPath.legs``."""
    legs = np.zeros((len(trajectory.times), layout.LEG_FIELDS))
    legs[:, layout.AT], legs[:, layout.AT_OPENING] = trajectory.times, trajectory.openings
    legs[:, layout.AT_X : layout.AT_YAW + 1] = trajectory.poses
    legs[:-1, layout.PHASE] = [PHASES[phase] for phase in trajectory.phases]
    return legs


@dataclass(frozen=True, slots=True, eq=False)
class FastSnapshot(Value):
    """A state and how fast its objects move.

    Attributes:
        state: Poses, conditions, what is held, the arm.
        velocities: ``(n, 3)`` of the objects, x, y (m/s) and spin (rad/s).
    """

    state: State
    velocities: Floats

    def __post_init__(self) -> None:
        self._freeze("velocities")
