"""The numbers of an episode over time."""

from __future__ import annotations

import numpy as np
import rerun as rr
from rerun.components import AggregationPolicy, InterpolationMode

from phframe.core import FloatArray, Plan, Scene, State, Step
from phframe.pushing import Corridor, PushDecision
from phframe.recorders import palette
from phframe.recorders.frames import Frames, changes
from phframe.recorders.stream import Stream

OBSTACLES = "numbers/corridor/obstacles"
FORCE = "numbers/force/largest"
TARGET = "numbers/displacement/target"
DEVIATION = "numbers/displacement/deviation"
CHOSEN_RADIUS = "numbers/radius/chosen"
PERSISTENT_RADII = "numbers/radius/persistent"
PLANNING = {
    "numbers/planning/total": "total",
    "numbers/planning/simulation": "simulation",
    "numbers/planning/topology": "topology",
    "numbers/planning/motion_planning": "motion planning",
}


def log_styles(stream: Stream) -> None:
    """Names, colours and shapes of all series."""
    after, before = InterpolationMode.StepAfter, InterpolationMode.StepBefore
    stream.keep(OBSTACLES, _line("obstacles in the corridor", palette.BLUE_INK, after))
    stream.keep(FORCE, _line("largest force (N)", palette.PINK_INK, before))
    stream.keep(TARGET, _line("target displaced", palette.AMBER_INK, InterpolationMode.Linear))
    stream.keep(DEVIATION, _line("deviation from the plan", palette.VIOLET_INK, before))
    stream.keep(CHOSEN_RADIUS, _line("chosen", palette.GREEN_INK, after))
    stream.keep(PERSISTENT_RADII, _points("persistent", palette.BLUE_INK))
    for (entity, name), color in zip(PLANNING.items(), palette.INKS, strict=False):
        stream.keep(entity, _points(name, color))


def log_beginning(stream: Stream) -> None:
    """Where the series of what actions did start."""
    for entity in (FORCE, TARGET, DEVIATION):
        stream.put(entity, rr.Scalars(0.0))


def log_planning(stream: Stream, plan: Plan) -> None:
    """What a plan cost."""
    cost = plan.cost
    for entity, seconds in zip(
        PLANNING, (cost.total, cost.simulation, cost.topology, cost.motion_planning), strict=True
    ):
        stream.put(entity, rr.Scalars(1000.0 * seconds))


def log_decision(stream: Stream, decision: PushDecision) -> None:
    """The persistent radii, as many values at one moment, and the one chosen."""
    for radius in decision.persistent_radii:
        stream.put(PERSISTENT_RADII, rr.Scalars(1000.0 * radius))
    if decision.radius is not None:
        stream.put(CHOSEN_RADIUS, rr.Scalars(1000.0 * decision.radius))


def log_motion(stream: Stream, scene: Scene, corridor: Corridor | None, frames: Frames, action: int) -> None:
    """Obstacles in the corridor, and how far the target is from where it was, until it is held."""
    if corridor is not None:
        _log_changes(stream, OBSTACLES, _obstacles(scene, corridor, frames), frames, action)
    free = sum(state.held != scene.target for state in frames.states)
    moved = 1000.0 * _target_moved(scene, frames)[:free]
    _log_changes(stream, TARGET, moved, frames, action)


def log_outcome(stream: Stream, step: Step) -> None:
    """What an action did, at its end."""
    stream.put(FORCE, rr.Scalars(step.motion.largest_force))
    if step.expected is not None:
        stream.put(DEVIATION, rr.Scalars(1000.0 * deviation(step.expected, step.after)))


def deviation(expected: State, after: State) -> float:
    """The largest distance (m) of an object on the board from where it was expected."""
    both = expected.on_board & after.on_board
    distance = np.linalg.norm(expected.poses[both, :3] - after.poses[both, :3], axis=1)
    return float(distance.max(initial=0.0))


def _line(name: str, color: palette.Color, interpolation: InterpolationMode) -> rr.SeriesLines:
    return rr.SeriesLines(
        names=name, colors=color, widths=1.5, interpolation_mode=interpolation, aggregation_policy=AggregationPolicy.Off
    )


def _points(name: str, color: palette.Color) -> rr.SeriesPoints:
    return rr.SeriesPoints(names=name, colors=color, markers="Circle", marker_sizes=3.5)


def _obstacles(scene: Scene, corridor: Corridor, frames: Frames) -> FloatArray:
    others = np.arange(len(scene.objects)) != scene.target_index
    return np.array([_count(corridor, state, others) for state in frames.states], dtype=np.float64)


def _count(corridor: Corridor, state: State, others: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> int:
    return int(corridor.contains(state.positions[others & state.on_board]).sum())


def _target_moved(scene: Scene, frames: Frames) -> FloatArray:
    start = scene.objects[scene.target_index].position
    return np.asarray(np.linalg.norm(frames.poses[:, scene.target_index, :2] - start, axis=1))


def _log_changes(stream: Stream, entity: str, values: FloatArray, frames: Frames, action: int) -> None:
    if len(values):
        kept = changes(values)
        stream.put_many(entity, frames.times[kept], action, rr.Scalars.columns(scalars=values[kept]))
