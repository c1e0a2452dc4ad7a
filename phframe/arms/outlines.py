"""A gripper seen from above, from the covers in its URDF."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from phframe.core import FloatArray, Outline
from phframe.urdf.model import Connection
from phframe.urdf.reader import Robot
from phframe.urdf.solids import Solid, rotation

SIDES = (1, -1)
MOST_CORNERS = 4
"""An outline with more is replaced by the box around it: a planner's time grows with the corners."""


def gripper_outlines(robot: Robot, tip: str, fingers: Sequence[str]) -> tuple[Outline, ...]:
    """The fingers and all that is fixed to the fingertip's link, the fingers closed.

    Each finger is one outline. Covers of a finger that reach past the middle, such as knuckles that slide past one
    another, do not count among it: each is one outline with all its travel.

    Args:
        robot: The robot.
        tip: The link whose frame is the fingertip's.
        fingers: The sliding joints of the left and the right finger, closed at their lower limits.
    """
    places = _places(robot, tip, fingers)
    sides = {robot.joint(name).child: side for name, side in zip(fingers, SIDES, strict=True)}
    outlines: list[Outline] = []
    for link, place in places.items():
        parts = [(solid, _placed(solid, place)) for solid in robot.covers[link]]
        if link in sides:
            travel = _travel(robot.joint(fingers[SIDES.index(sides[link])]))
            outlines += _finger(link, parts, sides[link], travel)
        else:
            outlines += [_outline(_name(link, solid), points) for solid, points in parts]
    return tuple(outlines)


Part = tuple[Solid, FloatArray]


def _finger(link: str, parts: Sequence[Part], side: int, travel: float) -> Iterator[Outline]:
    own = [points for _, points in parts if (side * points[:, 1]).min() >= 0.0]
    if own:
        yield _outline("left finger" if side == 1 else "right finger", np.vstack(own), side)
    for solid, points in parts:
        if (side * points[:, 1]).min() < 0.0:
            opened = points + np.array([0.0, side * travel, 0.0])
            yield _outline(_name(link, solid), np.vstack([points, opened]))


def _outline(name: str, points: FloatArray, side: int = 0) -> Outline:
    seen = _hull(points[:, :2])
    corners = seen if len(seen) <= MOST_CORNERS else _box(seen)
    return Outline(name, corners, side, float(points[:, 2].min()), float(points[:, 2].max()))


def _name(link: str, solid: Solid) -> str:
    return f"{link.replace('_', ' ')} {solid.part}".strip()


def _travel(finger: Connection) -> float:
    return finger.joint.upper - finger.joint.lower if finger.joint else 0.0


def _placed(solid: Solid, place: FloatArray) -> FloatArray:
    return np.asarray(solid.corners() @ place[:3, :3].T + place[:3, 3])


def _places(robot: Robot, tip: str, fingers: Sequence[str]) -> Mapping[str, FloatArray]:
    """Where the links stand ``(4, 4)`` that move with the fingertip, seen from it."""
    top, place = tip, np.eye(4)
    while top in robot.connections and robot.connections[top].joint is None:
        place = _step(robot.connections[top]) @ place
        top = robot.connections[top].parent
    places: dict[str, FloatArray] = {top: np.asarray(np.linalg.inv(place), dtype=np.float64)}
    waiting = [top]
    while waiting:
        link = waiting.pop()
        for child, connection in robot.connections.items():
            if connection.parent == link and (connection.joint is None or connection.joint.name in fingers):
                places[child] = places[link] @ _step(connection)
                waiting.append(child)
    return places


def _step(connection: Connection) -> FloatArray:
    """The child's frame ``(4, 4)`` in the parent's, a sliding joint at its lower limit."""
    axes = rotation(connection.rpy)
    lower = connection.joint.lower if connection.joint else 0.0
    place = np.eye(4)
    place[:3, :3] = axes
    place[:3, 3] = np.asarray(connection.at) + axes @ np.asarray(connection.axis) * lower
    return place


def _box(points: FloatArray) -> FloatArray:
    (x0, y0), (x1, y1) = points.min(axis=0), points.max(axis=0)
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])


def _hull(points: FloatArray) -> FloatArray:
    """Corners ``(k, 2)`` of the convex hull of points ``(n, 2)``, counter-clockwise (Andrew's monotone chain)."""
    ordered = np.unique(np.round(points, 9), axis=0)
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    return np.array([*lower[:-1], *upper[:-1]])


def _chain(points: FloatArray) -> list[FloatArray]:
    chain: list[FloatArray] = []
    for point in points:
        while len(chain) > 1 and _turns_right(chain[-2], chain[-1], point):
            chain.pop()
        chain.append(point)
    return chain


def _turns_right(a: FloatArray, b: FloatArray, c: FloatArray) -> bool:
    return bool((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) <= 1e-12)
