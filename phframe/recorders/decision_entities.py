"""A decision drawn over the scene: corridor, who hangs together, rectangle, sweep, and what is expected of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import rerun as rr

from phframe.core import Action, FloatArray, GripperPath, Phase, Scene, State, Step
from phframe.core.topology import FLOAT32_SLACK
from phframe.pushing import Corridor, PushDecision
from phframe.recorders import palette
from phframe.recorders.filling import filling
from phframe.recorders.object_solids import disc_radius
from phframe.recorders.stream import Stream

FILLING_LINES = 24
ABOVE = 0.004
"""How far above the objects lines are drawn in 3D (m)."""
NOTICEABLE = 0.002
"""Objects expected to move by less (m) are not marked."""
PUSHES = (Phase.SWEEP, Phase.WITHDRAW)
"""The phases whose legs become arrows: those in which something is moved on purpose."""


def log_decision(stream: Stream, scene: Scene, step: Step) -> None:
    """Draw the decision behind a step; whatever it does not have is wiped off."""
    decision = PushDecision.of(step.decision)
    height = max(item.shape.height for item in scene.objects) + ABOVE
    _log_corridor(stream, decision.corridor)
    links, colors = _links(scene, decision, step.before)
    _log_lines(stream, "links", links, colors, height, thickness=0.9)
    _log_lines(stream, "rectangle", _rectangle(decision), [palette.RECTANGLE], height, thickness=1.4)
    _log_path(stream, step.action, height)
    _log_expected(stream, scene, step)


def _log_corridor(stream: Stream, corridor: Corridor | None) -> None:
    fill, edges, slab, radius = _no_lines(), _no_lines(), rr.Boxes3D(half_sizes=[]), 0.0
    if corridor is not None:
        edges, slab = _sides(corridor), _slab(corridor)
        fill, radius = filling(_corners(corridor), FILLING_LINES)
    area = rr.LineStrips2D(fill, radii=radius, colors=palette.CORRIDOR, draw_order=-20.0)
    stream.put("top/decision/corridor/area", area)
    line = rr.LineStrips2D(edges, radii=-1.0, colors=palette.CORRIDOR_EDGE, draw_order=-10.0)
    stream.put("top/decision/corridor/edges", line)
    stream.put("world/decision/corridor", slab)


def _corners(corridor: Corridor) -> FloatArray:
    """``(4, 2)`` counter-clockwise in the shelf frame (m)."""
    south, north = _sides(corridor)
    return np.vstack([south, north[::-1]])


def _sides(corridor: Corridor) -> list[FloatArray]:
    aside = [corridor.axis - corridor.half_width, corridor.axis + corridor.half_width]
    return [corridor.to_shelf(np.array([[corridor.start, y], [corridor.end, y]])) for y in aside]


def _slab(corridor: Corridor) -> rr.Boxes3D:
    half = [(corridor.end - corridor.start) / 2.0, corridor.half_width, 0.0005]
    turned = rr.RotationAxisAngle([0.0, 0.0, 1.0], radians=corridor.angle)
    return rr.Boxes3D(
        centers=[[*_corners(corridor).mean(axis=0), 0.001]],
        half_sizes=[half],
        rotation_axis_angles=[turned],
        colors=palette.CORRIDOR_GLASS,
        fill_mode="solid",
    )


def _links(scene: Scene, decision: PushDecision, state: State) -> tuple[list[FloatArray], list[palette.Color]]:
    """A line, and its colour, for every two members of a component no farther apart than the radius chosen."""
    if decision.labels is None or decision.radius is None:
        return _no_lines(), []
    at = state.positions[[scene.index(member) for member in decision.members]].reshape(-1, 2)
    pairs = list(_near(at, decision.radius + FLOAT32_SLACK))
    return [at[[i, j]] for i, j in pairs], [palette.component_color(int(decision.labels[i])) for i, _ in pairs]


def _near(points: FloatArray, radius: float) -> Iterator[tuple[int, int]]:
    first, second = np.triu_indices(len(points), k=1)
    near = np.linalg.norm(points[first] - points[second], axis=1) <= radius
    return zip(first[near].tolist(), second[near].tolist(), strict=True)


def _rectangle(decision: PushDecision) -> list[FloatArray]:
    if decision.rectangle is None or decision.corridor is None:
        return _no_lines()
    corners = decision.rectangle.corners
    return [decision.corridor.to_shelf(np.vstack([corners, corners[:1]]))]


def _log_path(stream: Stream, action: Action, height: float) -> None:
    path = action.path
    _log_lines(stream, "path", [path.poses[:, :2]], [palette.PATH], height, thickness=1.0)
    origins, vectors = _arrows(path)
    arrows = rr.Arrows2D(origins=origins, vectors=vectors, colors=palette.SWEEP, radii=-1.6, draw_order=17.0)
    stream.put("top/decision/sweep", arrows)
    raised = _raised(origins, height)
    solid = rr.Arrows3D(origins=raised, vectors=_raised(vectors, 0.0), colors=palette.SWEEP, radii=0.003)
    stream.put("world/decision/sweep", solid)


def _arrows(path: GripperPath) -> tuple[FloatArray, FloatArray]:
    """Origins and vectors ``(k, 2)`` of the legs in which something is moved on purpose."""
    legs = np.diff(path.poses[:, :2], axis=0)
    moving = np.array([phase in PUSHES for phase in path.phases]) & (np.linalg.norm(legs, axis=1) > 0.0)
    return path.poses[:-1, :2][moving], legs[moving]


def _log_expected(stream: Stream, scene: Scene, step: Step) -> None:
    """Thin circles where the plan expects the objects that are to move."""
    moves = np.zeros(len(scene.objects), dtype=bool)
    centers, radii = np.zeros((0, 2)), np.zeros(0)
    if step.expected is not None:
        moves = (step.expected.displacement(step.before) > NOTICEABLE) & step.expected.on_board
        centers = step.expected.positions[moves]
        radii = np.array([disc_radius(item.shape) for item, each in zip(scene.objects, moves, strict=True) if each])
    sizes = np.column_stack([radii, radii])
    circles = rr.Ellipses2D(centers=centers, half_sizes=sizes, line_radii=-0.7, colors=palette.EXPECTED, draw_order=8.0)
    stream.put("top/decision/expected", circles)


def _log_lines(
    stream: Stream,
    name: str,
    lines: list[FloatArray],
    colors: Sequence[palette.Color],
    height: float,
    thickness: float,
) -> None:
    """Lines of the plane, from the top and in 3D at a height (m)."""
    flat = rr.LineStrips2D(lines, radii=-thickness, colors=colors, draw_order=16.0)
    stream.put(f"top/decision/{name}", flat)
    solid = rr.LineStrips3D([_raised(line, height) for line in lines], radii=-thickness, colors=colors)
    stream.put(f"world/decision/{name}", solid)


def _raised(points: FloatArray, height: float) -> FloatArray:
    """Points ``(k, 2)`` of the plane as points ``(k, 3)`` at a height (m)."""
    return np.column_stack([points, np.full(len(points), height)])


def _no_lines() -> list[FloatArray]:
    return []
