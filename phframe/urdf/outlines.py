"""A gripper seen from above: convex outlines of the collision geometry in its URDF."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from phframe.core import ArmError, FloatArray, Outline
from phframe.geometry.convex_hull import convex_hull
from phframe.urdf.driven import placements
from phframe.urdf.model import CollisionGeometry, Robot

SIDES = (1, -1)
MOST_CORNERS = 4
"""An outline with more is replaced by the box around it: a planner's time grows with the corners."""
MIDDLE = 1e-3
"""A finger that reaches past the middle by no more (m) ends there: round pads that meet, and prisms around them."""

Part = tuple[CollisionGeometry, FloatArray]


def gripper_outlines(robot: Robot, tip: str, fingers: Sequence[str]) -> tuple[Outline, ...]:
    """The fingers and all that is fixed to the fingertip's link, the fingers closed.

    Each finger is one outline. Parts of a finger that reach past the middle, such as knuckles that slide past one
    another, do not count among it: each is one outline with all its travel.

    Args:
        robot: The robot, as it is driven.
        tip: The link whose frame is the fingertip's.
        fingers: The sliding joints of the left and the right finger, closed at their lower limits.

    Raises:
        ArmError: If a finger has nothing that collides on its side of the middle.
    """
    sides = {robot.joint(name).child: (side, name) for name, side in zip(fingers, SIDES, strict=True)}
    outlines: list[Outline] = []
    for link, place in placements(robot, tip, fingers).items():
        shapes = robot.collision_geometry[link]
        parts = [(shape, np.asarray(shape.corners() @ place[:3, :3].T + place[:3, 3])) for shape in shapes]
        if link in sides:
            side, name = sides[link]
            outlines += _finger(robot, name, parts, side)
        else:
            outlines += [_outline(_name(link, shape), points) for shape, points in parts]
    return tuple(outlines)


def _finger(robot: Robot, name: str, parts: Sequence[Part], side: int) -> Iterator[Outline]:
    carried = robot.joint(name)
    assert carried.joint is not None, "found by its joint"
    called = "left finger" if side == 1 else "right finger"
    own = [points for _, points in parts if _inmost(points, side) >= -MIDDLE]
    if not own:
        _refuse(called, carried.child, parts, side)
    ended = np.vstack(own)
    ended[:, 1] = side * np.maximum(side * ended[:, 1], 0.0)
    yield _outline(called, ended, side)
    opened = np.array([0.0, side * (carried.joint.upper - carried.joint.lower), 0.0])
    for shape, points in parts:
        if _inmost(points, side) < -MIDDLE:
            yield _outline(_name(carried.child, shape), np.vstack([points, points + opened]))


def _refuse(called: str, link: str, parts: Sequence[Part], side: int) -> None:
    if not parts:
        raise ArmError(f"the {called}, link {link!r}, has no collision geometry: what a grasp must touch is needed")
    if all((side * points[:, 1]).max() < 0.0 for _, points in parts):
        raise ArmError(
            f"the {called}, link {link!r}, is on the other side of the fingertip: under 'fingers' the left one, at "
            "positive y, comes first; or look at 'tip'"
        )
    raise ArmError(
        f"all collision geometry of the {called}, link {link!r}, reaches past the middle when it is closed, by "
        f"{max(-_inmost(points, side) for _, points in parts):.3g} m: look at 'tip' and at the joint's limits"
    )


def _inmost(points: FloatArray, side: int) -> float:
    """Least distance from the middle (m), below 0 beyond it."""
    return float((side * points[:, 1]).min())


def _outline(name: str, points: FloatArray, side: int = 0) -> Outline:
    seen = convex_hull(points[:, :2])
    if len(seen) < 3:
        raise ArmError(f"the collision geometry of the gripper's {name} has no extent seen from above")
    corners = seen if len(seen) <= MOST_CORNERS else _box(seen)
    return Outline(name, corners, side, float(points[:, 2].min()), float(points[:, 2].max()))


def _name(link: str, shape: CollisionGeometry) -> str:
    return f"{link.replace('_', ' ')} {shape.part}".strip()


def _box(points: FloatArray) -> FloatArray:
    (x0, y0), (x1, y1) = points.min(axis=0), points.max(axis=0)
    return np.array([[x0, y0], [x1, y0], [x1, y1], [x0, y1]])
