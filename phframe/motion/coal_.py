"""Collisions of a robot with itself, a shelf and what stands on it, by Pinocchio and Coal."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from contextlib import contextmanager
from itertools import combinations, product
from typing import Any

import coal
import numpy as np
import pinocchio

from phframe.core import BasePose, FloatArray, Scene, State
from phframe.geometry.slabs import slabs
from phframe.urdf.convex_hull import ConvexHull
from phframe.urdf.reader import read_robot
from phframe.urdf.solids import rotation
from phframe.urdf.writer import robot_urdf

WALL_MARGIN = 0.0015
"""Kept between the robot and the shelf (m)."""
OBJECT_MARGIN = 0.001
"""Kept between the robot and objects that it must not touch (m)."""
YIELDING = 5e-4
"""By how much what touches at the beginning may come nearer still (m)."""


class CollisionModel:
    """A robot before a shelf with objects.

    Objects and fingers are put in place first, then configurations are looked at.

    Args:
        urdf: The robot.
        joints: Names of the joints that move, in the order of joint values; all others stay at 0.
        fingers: Names of the joints of the two fingers.
        overlapping: Pairs of links whose covers may overlap.
        scene: The shelf and its objects.
        base_pose: Where the robot's base stands.
    """

    def __init__(
        self,
        urdf: str,
        joints: Collection[str],
        fingers: Collection[str],
        overlapping: Collection[tuple[str, str]],
        scene: Scene,
        base_pose: BasePose,
    ) -> None:
        whole = pinocchio.buildModelFromXML(urdf)
        covers = _collision_geometry(whole, urdf)
        moving = {*joints, *fingers}
        others = [number for number, name in enumerate(whole.names) if number and name not in moving]
        self._model, self._geometry = pinocchio.buildReducedModel(whole, covers, others, pinocchio.neutral(whole))
        self._data, self._values = self._model.createData(), np.zeros(self._model.nq)
        self._rows, self._finger_rows = (
            np.array([self._model.idx_qs[self._model.getJointId(name)] for name in names])
            for names in (joints, fingers)
        )
        self._scene, self._base = scene, placement(base_pose)
        self._links = [_link_of(self._model, item) for item in self._geometry.geometryObjects]
        self._shelf, self._objects = self._add_surroundings()
        self._fingers = frozenset(self._model.getJointId(name) for name in fingers)
        self._pair_up({frozenset(pair) for pair in overlapping})
        self._checks = self._geometry.createData()
        self._set_margins()
        seconds = [pair.second for pair in self._geometry.collisionPairs]
        self._pairs_by_row = [np.flatnonzero(np.array(seconds) == number).tolist() for number in self._objects]
        self._manager = pinocchio.BroadPhaseManager_DynamicAABBTreeCollisionManager(
            self._model, self._geometry, self._checks
        )

    def place(self, state: State) -> None:
        """Let the objects stand where a state has them; what has spilled is far away."""
        away = pinocchio.SE3(np.eye(3), np.array([-10.0, 0.0, 0.0]))
        for row, number in enumerate(self._objects):
            x, y, z, scalar, i, j, k = state.poses[row].tolist()
            pose = pinocchio.XYZQUATToSE3(np.array([x, y, z, i, j, k, scalar]))
            seen = self._base.actInv(pose) if state.on_board[row] else away
            self._geometry.geometryObjects[number].placement = seen

    def open(self, fingers: FloatArray) -> None:
        """Let the joints of the fingers have values ``(2,)``."""
        self._values[self._finger_rows] = fingers

    def allow(self, rows: Collection[int]) -> None:
        """Let the robot touch the objects in these rows of the scene, and no others."""
        for row, pairs in enumerate(self._pairs_by_row):
            for index in pairs:
                self._checks.activeCollisionPairs[index] = row not in rows

    @contextmanager
    def tolerating(self, q: FloatArray) -> Iterator[None]:
        """Lets what touches at joint values ``(dof,)`` touch in this block, no deeper: whoever begins there must get away."""
        requests = self._checks.collisionRequests
        before = {index: requests[index].security_margin for index, _ in self._touching(q)}
        for index, margin in before.items():
            requests[index].security_margin = min(margin, self._gap(index) - YIELDING)
        try:
            yield
        finally:
            for index, margin in before.items():
                requests[index].security_margin = margin

    def is_free(self, q: FloatArray) -> bool:
        """Whether the robot touches nothing at joint values ``(dof,)``."""
        return not pinocchio.computeCollisions(self._model, self._data, self._manager, self._all(q), True)

    def collisions(self, q: FloatArray) -> tuple[tuple[str, str], ...]:
        """What touches what at joint values ``(dof,)``: a link of the robot, and a link, a wall or an object."""
        return tuple((self._links[pair.first], self._links[pair.second]) for _, pair in self._touching(q))

    def _touching(self, q: FloatArray) -> list[tuple[int, Any]]:
        """Index and pair of all that collide."""
        pinocchio.computeCollisions(self._model, self._data, self._geometry, self._checks, self._all(q), False)
        active, results = self._checks.activeCollisionPairs, self._checks.collisionResults
        pairs = enumerate(self._geometry.collisionPairs)
        return [(index, pair) for index, pair in pairs if active[index] and results[index].isCollision()]

    def _gap(self, index: int) -> float:
        """Distance between what may collide, as last looked at (m); how deep it collides, if below 0."""
        return float(pinocchio.computeDistance(self._geometry, self._checks, index).min_distance)

    def _all(self, q: FloatArray) -> FloatArray:
        self._values[self._rows] = q
        return self._values

    def _add_surroundings(self) -> tuple[list[int], list[int]]:
        """Put shelf and objects in; their numbers."""
        slabbed = slabs(self._scene.shelf)
        shelf = [self._add(slab.name, coal.Box(*slab.size), np.array(slab.center)) for slab in slabbed]
        objects = []
        for item in self._scene.objects:
            cylinder = coal.Cylinder(item.shape.radius, item.shape.height)
            objects.append(self._add(item.id, cylinder, np.zeros(3)))
        self._object_numbers = frozenset(objects)
        return shelf, objects

    def _add(self, name: str, shape: Any, at: FloatArray) -> int:
        placement = self._base.actInv(pinocchio.SE3(np.eye(3), at))
        # Ids may clash with links' names, which the engine would not have twice.
        thing = pinocchio.GeometryObject(f"surroundings/{len(self._links)}", 0, 0, placement, shape)
        self._links.append(name)
        return int(self._geometry.addGeometryObject(thing))

    def _pair_up(self, overlapping: set[frozenset[str]]) -> None:
        """Say what may collide with what: moving links with all that they are not joined to."""
        geometry = self._geometry
        geometry.removeAllCollisionPairs()
        own = range(len(geometry.geometryObjects) - len(self._shelf) - len(self._objects))
        for first, second in combinations(own, 2):
            if (
                self._may_meet(first, second)
                and frozenset((self._links[first], self._links[second])) not in overlapping
            ):
                geometry.addCollisionPair(pinocchio.CollisionPair(first, second))
        moving = [number for number in own if geometry.geometryObjects[number].parentJoint]
        for first, second in product(moving, (*self._shelf, *self._objects)):
            geometry.addCollisionPair(pinocchio.CollisionPair(first, second))

    def _may_meet(self, first: int, second: int) -> bool:
        """Whether two covers move against one another and belong neither to joined links nor to the two fingers."""
        a, b = (self._geometry.geometryObjects[number].parentJoint for number in (first, second))
        parents = self._model.parents
        return bool(a != b and parents[a] != b and parents[b] != a and not self._fingers >= {a, b})

    def _set_margins(self) -> None:
        for index, pair in enumerate(self._geometry.collisionPairs):
            if pair.second in self._object_numbers:
                self._checks.collisionRequests[index].security_margin = OBJECT_MARGIN
            elif pair.second in self._shelf:
                self._checks.collisionRequests[index].security_margin = WALL_MARGIN


def placement(base_pose: BasePose) -> Any:
    """Where a robot's base stands in the shelf frame."""
    x, y, z, scalar, i, j, k = base_pose.pose.tolist()
    return pinocchio.XYZQUATToSE3(np.array([x, y, z, i, j, k, scalar]))


def _collision_geometry(model: Any, urdf: str) -> Any:
    """Primitives as Pinocchio reads them, and convex hulls."""
    robot = read_robot(urdf)
    text = robot_urdf(robot.without_hulls())
    geometry = pinocchio.buildGeomFromUrdfString(model, text, pinocchio.GeometryType.COLLISION)
    for number, (link, hull) in enumerate(robot.hulls):
        frame = model.getFrameId(link)
        at = model.frames[frame].placement * pinocchio.SE3(rotation(hull.rpy), np.array(hull.at))
        joint = model.frames[frame].parentJoint
        geometry.addGeometryObject(pinocchio.GeometryObject(f"hull/{number}", joint, frame, at, _convex(hull)))
    return geometry


def _convex(hull: ConvexHull) -> Any:
    points, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    points.extend(list(hull.vertices))
    triangles.extend([coal.Triangle(a, b, c) for a, b, c in hull.triangles.tolist()])
    return coal.Convex(points, triangles)


def _link_of(model: Any, item: Any) -> str:
    return str(model.frames[item.parentFrame].name)
