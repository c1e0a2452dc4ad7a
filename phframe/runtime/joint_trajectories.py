"""The joint trajectories of an episode in the layout of ROS, and as a table."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np

from phframe.core import ArmModel, Episode, FloatArray, InputError, JointTrajectory, Step

FORMAT = 1
"""Of both files."""
NANOSECONDS = 1_000_000_000


@dataclass(frozen=True, slots=True)
class ActionTrajectory:
    """What the arm was driven along for one action.

    Attributes:
        number: Of the action in the episode, from 1.
        action: Its name.
        joints: Names of the arm's joints.
        fingers: Names of the fingers' joints.
        trajectory: Joint values, times, openings and phases.
        travel: Values of the finger joints ``(k, 2)`` at the times (m).
    """

    number: int
    action: str
    joints: tuple[str, ...]
    fingers: tuple[str, ...]
    trajectory: JointTrajectory
    travel: FloatArray


def joint_trajectories(episode: Episode, arm: ArmModel[Any], number: int | None = None) -> list[ActionTrajectory]:
    """The trajectories that an episode drove, one for each action, in order.

    Args:
        episode: What was carried out.
        arm: The arm that carried it out.
        number: Of the only action that is wanted, from 1; None: all.

    Raises:
        InputError: If nothing was carried out, there is no such action, or no joints were driven.
    """
    refuse_no_joints(episode)
    count = len(episode.steps)
    if number is not None and not 1 <= number <= count:
        raise InputError(f"there is no action {number}; the episode has actions 1 to {count}")
    wanted = range(1, count + 1) if number is None else (number,)
    return [_of_step(each, episode.steps[each - 1], episode, arm) for each in wanted]


def refuse_no_joints(episode: Episode) -> None:
    """Raise where an episode drove no joints.

    Raises:
        InputError: If it carried nothing out, or on a backend that moves grippers only.
    """
    if not episode.steps:
        raise InputError(f"{episode.scene.name}: no action was carried out ({episode.reason}), so nothing was driven")
    if not all(isinstance(step.trajectory, JointTrajectory) for step in episode.steps):
        raise InputError(
            f"the episode was carried out in {episode.spec.name_of('backend')!r}, which moves the gripper and no joints, so it has "
            "no joint trajectories. Solve the scene again with a backend that drives joints: --backend mujoco"
        )


def _of_step(number: int, step: Step, episode: Episode, arm: ArmModel[Any]) -> ActionTrajectory:
    driven = step.trajectory
    assert isinstance(driven, JointTrajectory), "checked"
    if driven.positions.shape[1] != len(arm.joints):
        raise InputError(
            f"action {number} drives {driven.positions.shape[1]} joints, but the arm {episode.spec.name_of('arm')!r} has "
            f"{len(arm.joints)}: the episode was run with another one"
        )
    half = (driven.gripper.openings - arm.shape.min_opening) / 2.0
    travel = np.array([joint.lower for joint in arm.fingers.joints]) + half[:, None]
    joints, fingers = (tuple(joint.name for joint in group) for group in (arm.joints, arm.fingers.joints))
    return ActionTrajectory(number, step.action.name, joints, fingers, driven, travel)


def as_json(episode: Episode, trajectories: Sequence[ActionTrajectory]) -> str:
    """One JSON object; its ``arm`` and ``gripper`` have the layout of ``trajectory_msgs/JointTrajectory``."""
    content = {
        "format": FORMAT,
        "scene": episode.scene.name,
        "arm": episode.spec.name_of("arm"),
        "backend": episode.spec.name_of("backend"),
        "trajectories": [_as_object(each) for each in trajectories],
    }
    return json.dumps(content, allow_nan=False) + "\n"


def _as_object(each: ActionTrajectory) -> dict[str, Any]:
    driven = each.trajectory
    return {
        "number": each.number,
        "action": each.action,
        "duration": driven.duration,
        "force_limit": driven.force_limit,
        "phases": list(_phases(driven)),
        "arm": _message(each.joints, driven.times, driven.positions, driven.velocities),
        "gripper": _message(each.fingers, *_corners(driven.times, each.travel)),
    }


def _phases(driven: JointTrajectory) -> Iterator[dict[str, Any]]:
    """The phases in order, each with the times at which it begins and ends (s)."""
    for phase, legs in groupby(range(len(driven.gripper.phases)), key=driven.gripper.phases.__getitem__):
        rows = list(legs)
        yield {"phase": str(phase), "begin": float(driven.times[rows[0]]), "end": float(driven.times[rows[-1] + 1])}


def _message(
    names: Sequence[str], times: FloatArray, positions: FloatArray, velocities: FloatArray | None = None
) -> dict[str, Any]:
    """A ``trajectory_msgs/JointTrajectory``; its times rise from point to point, as controllers demand."""
    stamps = [round(float(time) * NANOSECONDS) for time in times]
    kept = [row for row, stamp in enumerate(stamps) if row + 1 == len(stamps) or stamp < stamps[row + 1]]
    points = [
        {
            "positions": positions[row].tolist(),
            "velocities": [] if velocities is None else velocities[row].tolist(),
            "time_from_start": dict(zip(("sec", "nanosec"), divmod(stamps[row], NANOSECONDS), strict=True)),
        }
        for row in kept
    ]
    return {"joint_names": list(names), "points": points}


def _corners(times: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The samples between which values change evenly, those of a line in one piece left out."""
    kept = [0]
    for row in range(1, len(times) - 1):
        span = times[row + 1] - times[kept[-1]]
        fraction = (times[row] - times[kept[-1]]) / span if span > 0.0 else 0.0
        even = values[kept[-1]] + fraction * (values[row + 1] - values[kept[-1]])
        if np.abs(even - values[row]).max() > 1e-9:
            kept.append(row)
    kept.append(len(times) - 1)
    return times[kept], values[kept]


def as_csv(trajectories: Sequence[ActionTrajectory]) -> str:
    """A table of all samples: action, phase, time, a position and a velocity for each joint, fingers and opening."""
    first = trajectories[0]
    velocities = [f"{name}_velocity" for name in first.joints]
    text = io.StringIO()
    table = csv.writer(text, lineterminator="\n")
    table.writerow(["number", "action", "phase", "time", *first.joints, *velocities, *first.fingers, "opening"])
    for each in trajectories:
        table.writerows(_rows(each))
    return text.getvalue()


def _rows(each: ActionTrajectory) -> Iterator[list[Any]]:
    driven = each.trajectory
    phases = (driven.gripper.phases[0], *driven.gripper.phases)
    for row, phase in enumerate(phases):
        figures = (driven.positions[row], driven.velocities[row], each.travel[row])
        numbers = [repr(float(number)) for group in figures for number in group]
        time, opening = float(driven.times[row]), float(driven.gripper.openings[row])
        yield [each.number, each.action, str(phase), repr(time), *numbers, repr(opening)]
