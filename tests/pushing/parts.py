"""What the tests of pushing/ share: a shelf, the planar arm, and plain geometry that owes nothing to the code under test."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import Action, Cylinder, FloatArray, Outline, Rejection, Scene, SceneObject, Shelf
from phframe.pushing import Corridor, Retrieve, RetrieveOptions

often = settings(max_examples=25, deadline=None)
"""Enough examples to find what is wrong within some runs; machines that are busy are no failure."""
ARM = PlanarArm(PlanarArmOptions()).shape
SHELF = Shelf(depth=0.6, width=0.6)
RADIUS = 0.03
HALF_WIDTH = 0.12
RETRIEVE = Retrieve(RetrieveOptions())


def rejections(actions: Sequence[Action]) -> tuple[Rejection, ...]:
    """Actions that came to nothing, for a reason of no importance."""
    return tuple(Rejection(action, "it came to nothing") for action in actions)


def scene_of(target: tuple[float, float], *obstacles: tuple[float, float], shelf: Shelf = SHELF) -> Scene:
    """Equal cylinders: the target, and obstacles called o0, o1 and so on."""
    standing = [SceneObject(f"o{number}", Cylinder(RADIUS), place) for number, place in enumerate(obstacles)]
    return Scene("made", shelf, (SceneObject("target", Cylinder(RADIUS), target), *standing), "target")


def mirrored(scene: Scene) -> Scene:
    """The same scene with north and south exchanged."""
    width = scene.shelf.width
    objects = tuple(
        SceneObject(item.id, item.shape, (item.position[0], width - item.position[1])) for item in scene.objects
    )
    return Scene(scene.name, scene.shelf, objects, scene.target)


@st.composite
def shelves(draw: st.DrawFn) -> Shelf:
    """Shelves at least as wide as the corridor."""
    return Shelf(depth=draw(st.floats(0.4, 0.8)), width=draw(st.floats(0.3, 0.9)))


def places(shelf: Shelf, nearest: float = 0.0) -> st.SearchStrategy[tuple[float, float]]:
    """Where an object may stand, no nearer to the mouth than a depth."""
    return st.tuples(st.floats(nearest, shelf.depth - RADIUS), st.floats(RADIUS, shelf.width - RADIUS))


def boundary(outlines: Sequence[Outline], spacing: float = 0.004) -> FloatArray:
    """Points ``(k, 2)`` all along the edges of outlines, vertices included."""
    points = []
    for outline in outlines:
        for begin, end in zip(outline.vertices, np.roll(outline.vertices, -1, axis=0), strict=True):
            count = max(2, math.ceil(float(np.linalg.norm(end - begin)) / spacing))
            points.append(begin + np.linspace(0.0, 1.0, count)[:, None] * (end - begin))
    return np.concatenate(points)


def posed(points: FloatArray, x: float, y: float, yaw: float) -> FloatArray:
    """Points ``(k, 2)`` of the fingertip frame in the frame in which the fingertip's pose is given."""
    c, s = math.cos(yaw), math.sin(yaw)
    return np.column_stack([x + c * points[:, 0] - s * points[:, 1], y + s * points[:, 0] + c * points[:, 1]])


def distance_from_walls(points: FloatArray, shelf: Shelf) -> FloatArray:
    """Distances ``(k,)`` of points ``(k, 2)`` from the nearest wall; negative inside one."""
    x, y = points.T
    gaps = []
    for along, across in ((-x, y), (-x, shelf.width - y)):
        outside = np.hypot(np.maximum(along, 0.0), np.maximum(across, 0.0))
        gaps.append(np.where((along < 0.0) & (across < 0.0), np.maximum(along, across), outside))
    return np.asarray(np.minimum(np.minimum(*gaps), shelf.depth - x))


def gap_to_walls(outlines: Sequence[Outline], pose: FloatArray, shelf: Shelf = SHELF) -> float:
    """Between convex outlines at a pose and the nearest wall; negative where one is inside.

    Nearest is either a corner of an outline to a wall, or an edge to one of the two corners of the mouth; where an edge
    cuts a wall, points along it lie inside.
    """
    deepest = float(distance_from_walls(posed(boundary(outlines), *pose), shelf).min())
    if deepest < 0.0:
        return deepest
    corners = np.array([[0.0, 0.0], [0.0, shelf.width]])
    gaps = []
    for outline in outlines:
        polygon = posed(outline.vertices, *pose)
        gaps += [distance_from_walls(polygon, shelf).min(), *(_from_polygon(corner, polygon) for corner in corners)]
    return float(min(gaps))


def _from_polygon(point: FloatArray, polygon: FloatArray) -> float:
    """Distance of a point from a convex counter-clockwise polygon; negative inside."""
    edges = np.roll(polygon, -1, axis=0) - polygon
    offset = point - polygon
    fraction = np.clip((offset * edges).sum(axis=1) / (edges * edges).sum(axis=1), 0.0, 1.0)
    distance = float(np.linalg.norm(offset - fraction[:, None] * edges, axis=1).min())
    inside = (edges[:, 0] * offset[:, 1] - edges[:, 1] * offset[:, 0] > 0.0).all()
    return -distance if inside else distance


def gaps_to_points(outlines: Sequence[Outline], pose: FloatArray, points: FloatArray) -> FloatArray:
    """Distances ``(k,)`` of points from convex outlines at a pose; negative inside one."""
    polygons = [posed(outline.vertices, *pose) for outline in outlines]
    return np.array([min(_from_polygon(point, polygon) for polygon in polygons) for point in points])


def highest(outlines: Sequence[Outline], tilt: float, x: float, direction: int) -> float:
    """How far tilted convex outlines reach to one side at x: the least of the bounds that their edges set."""
    reaches = []
    for outline in outlines:
        polygon = posed(outline.vertices, 0.0, 0.0, tilt)
        edges = np.roll(polygon, -1, axis=0) - polygon
        normals = np.column_stack([edges[:, 1], -edges[:, 0]])
        if polygon[:, 0].min() <= x <= polygon[:, 0].max():
            facing = direction * normals[:, 1] > 1e-12
            offsets = (normals * polygon).sum(axis=1)
            bounds = direction * (offsets[facing] - normals[facing, 0] * x) / normals[facing, 1]
            reaches.append(float(bounds.min()))
    return max(reaches, default=-math.inf)


def in_strip(corridor: Corridor, target: FloatArray, points: FloatArray) -> NDArray[np.bool_]:
    """The paper's membership by cross and dot products: no frame, no rotation."""
    ahead = np.array([math.cos(corridor.angle), math.sin(corridor.angle)])
    offset = points - target
    across = ahead[0] * offset[:, 1] - ahead[1] * offset[:, 0]
    along = (points - corridor.origin) @ ahead
    return np.asarray((np.abs(across) <= corridor.half_width) & (along >= 0.0) & (offset @ ahead < 0.0))
