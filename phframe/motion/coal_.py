"""Collision checking of a robot against itself, a shelf and the objects in it, by Pinocchio and Coal."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import combinations, product
from typing import Any

import coal
import numpy as np
import pinocchio

from phframe.core import (
    ArmModel,
    BasePose,
    Cylinder,
    FloatArray,
    SceneObject,
    Shape,
    Shelf,
    State,
    UnknownShapeError,
)
from phframe.geometry.slabs import slabs
from phframe.motion.collision_checking import CollisionContext
from phframe.motion.pinocchio_ import se3
from phframe.urdf.convex_hull import ConvexHull
from phframe.urdf.description import ArmDescription
from phframe.urdf.reader import read_robot
from phframe.urdf.solids import rotation
from phframe.urdf.writer import robot_urdf

TOLERANCE = 5e-4
"""By how much what touches at the start may come nearer still (m)."""
FAR_AWAY = pinocchio.SE3(np.eye(3), np.array([-10.0, 0.0, 0.0]))
"""Of the robot: where objects are put that have left the board."""


class CollisionModel:
    """Collision geometry of a robot, a shelf and objects, and which pairs of it are looked at.

    Pairs of links that one joint connects, the two fingers, and the description's allowed collision pairs are not. It
    holds no state of the world: a checker does, for one context.

    Args:
        arm: The robot; joints that neither it nor its fingers use stay at 0.
        description: Of the robot.
        shelf: The shelf.
        objects: What stands in it.
        base_pose: Where the robot's base stands.
        wall_margin: Distance kept between the robot and the shelf (m).
        object_margin: Distance kept between the robot and objects that it must not touch (m).

    Raises:
        UnknownShapeError: If Coal has no primitive for the shape of an object.
    """

    def __init__(
        self,
        arm: ArmModel[Any],
        description: ArmDescription,
        shelf: Shelf,
        objects: Sequence[SceneObject],
        base_pose: BasePose,
        wall_margin: float,
        object_margin: float,
    ) -> None:
        self.model, self.geometry = _reduced(arm.urdf(), {*description.joints, *description.fingers})
        self.data = self.model.createData()
        self.rows, self._finger_rows = (
            np.array([self.model.idx_qs[self.model.getJointId(name)] for name in names])
            for names in (description.joints, description.fingers)
        )
        self._closed = np.array([joint.lower for joint in arm.fingers.joints])
        self._least, self._base = arm.shape.min_opening, se3(base_pose.pose)
        self.bodies = [str(self.model.frames[item.parentFrame].name) for item in self.geometry.geometryObjects]
        own = range(len(self.bodies))
        walls = [self._add(slab.name, coal.Box(*slab.size), np.array(slab.center)) for slab in slabs(shelf)]
        self._objects = [self._add(item.id, _primitive(item.shape), np.zeros(3)) for item in objects]
        self._pair_up(own, [*walls, *self._objects], description)
        self._margins = dict.fromkeys(walls, wall_margin) | dict.fromkeys(self._objects, object_margin)
        self._allowing: dict[frozenset[str], Any] = {}

    def checker(self, context: CollisionContext) -> CollisionChecker:
        """The checker for a context: made once, asked often."""
        return CollisionChecker(self, context)

    def placed(self, state: State) -> Any:
        """The geometry with the objects where a state has them."""
        geometry = pinocchio.GeometryModel(self.geometry)
        for row, number in enumerate(self._objects):
            at = self._base.actInv(se3(state.poses[row])) if state.on_board[row] else FAR_AWAY
            geometry.geometryObjects[number].placement = at
        return geometry

    def requests(self, allowed: frozenset[str]) -> Any:
        """The engine's buffers, in which objects may be touched: shared by all checkers that allow the same ones."""
        if allowed not in self._allowing:
            self._allowing[allowed] = buffers = self.geometry.createData()
            touched = {number for number in self._objects if self.bodies[number] in allowed}
            for index, pair in enumerate(self.geometry.collisionPairs):
                buffers.collisionRequests[index].security_margin = self._margins.get(pair.second, 0.0)
                buffers.activeCollisionPairs[index] = pair.second not in touched
        return self._allowing[allowed]

    def values(self, opening: float) -> FloatArray:
        """All joint values of the model with the fingers so far apart (m) and its other joints at 0."""
        values = np.zeros(self.model.nq)
        values[self._finger_rows] = self._closed + max(0.0, opening - self._least) / 2.0
        return values

    def _add(self, name: str, shape: Any, at: FloatArray) -> int:
        """Put a thing in that does not move with the robot; its number."""
        placement = self._base.actInv(pinocchio.SE3(np.eye(3), at))
        # Ids may clash with links' names, which the engine would not have twice.
        thing = pinocchio.GeometryObject(f"surroundings/{len(self.bodies)}", 0, 0, placement, shape)
        self.bodies.append(name)
        return int(self.geometry.addGeometryObject(thing))

    def _pair_up(self, own: Collection[int], surroundings: Collection[int], description: ArmDescription) -> None:
        """Say what may collide with what: moving links with all that they are not joined to."""
        geometry, allowed = self.geometry, {frozenset(pair) for pair in description.allowed_collisions}
        fingers = frozenset(self.model.getJointId(name) for name in description.fingers)
        geometry.removeAllCollisionPairs()
        for pair in combinations(own, 2):
            if self._may_meet(*pair, fingers) and frozenset(self.bodies[number] for number in pair) not in allowed:
                geometry.addCollisionPair(pinocchio.CollisionPair(*pair))
        moving = [number for number in own if geometry.geometryObjects[number].parentJoint]
        for pair in product(moving, surroundings):
            geometry.addCollisionPair(pinocchio.CollisionPair(*pair))

    def _may_meet(self, first: int, second: int, fingers: frozenset[int]) -> bool:
        """Whether two shapes move against one another and belong neither to joined links nor to the two fingers."""
        a, b = (self.geometry.geometryObjects[number].parentJoint for number in (first, second))
        parents = self.model.parents
        return bool(a != b and parents[a] != b and parents[b] != a and not fingers >= {a, b})


class CollisionChecker:
    """Says whether configurations are collision-free in one context.

    Args:
        model: Robot, shelf and objects.
        context: Where the objects are, how far the fingers are open and what may be touched.
    """

    def __init__(self, model: CollisionModel, context: CollisionContext) -> None:
        self._model = model
        self._geometry, self._requests = model.placed(context.state), model.requests(context.allowed)
        self._values, self._rows = model.values(context.opening), model.rows
        self._manager = self._broad_phase()
        if context.start is not None and not self.is_free(context.start):
            self._tolerate(self._touching(context.start))
            self._manager = self._broad_phase()

    def is_free(self, q: FloatArray) -> bool:
        """Whether the robot is collision-free at joint values ``(dof,)``."""
        self._values[self._rows] = q
        model = self._model
        return not pinocchio.computeCollisions(model.model, model.data, self._manager, self._values, True)

    def collisions(self, q: FloatArray) -> tuple[tuple[str, str], ...]:
        """What touches what at joint values ``(dof,)``: a link of the robot, and a link, a wall or an object."""
        bodies, pairs = self._model.bodies, self._geometry.collisionPairs
        touching = (pairs[index] for index in self._touching(q))
        return tuple((bodies[pair.first], bodies[pair.second]) for pair in touching)

    def _broad_phase(self) -> Any:
        """A tree of boxes: only pairs whose boxes overlap are looked at closely."""
        manager = pinocchio.BroadPhaseManager_DynamicAABBTreeCollisionManager
        return manager(self._model.model, self._geometry, self._requests)

    def _touching(self, q: FloatArray) -> list[int]:
        """Indices of all pairs that collide."""
        self._values[self._rows] = q
        model, requests = self._model, self._requests
        pinocchio.computeCollisions(model.model, model.data, self._geometry, requests, self._values, False)
        active, results = requests.activeCollisionPairs, requests.collisionResults
        return [index for index in range(len(results)) if active[index] and results[index].isCollision()]

    def _tolerate(self, pairs: list[int]) -> None:
        """Let pairs that collide where the joints are now come no nearer than ``TOLERANCE`` more, in buffers of its own."""
        gaps = [pinocchio.computeDistance(self._geometry, self._requests, index).min_distance for index in pairs]
        self._requests = self._requests.copy()
        for index, gap in zip(pairs, gaps, strict=True):
            request = self._requests.collisionRequests[index]
            request.security_margin = min(request.security_margin, gap - TOLERANCE)


def _reduced(urdf: str, moving: set[str]) -> tuple[Any, Any]:
    """Kinematic model and collision geometry of a robot in which only some joints move."""
    whole = pinocchio.buildModelFromXML(urdf)
    shapes = _collision_geometry(whole, urdf)
    others = [number for number, name in enumerate(whole.names) if number and name not in moving]
    model, geometry = pinocchio.buildReducedModel(whole, shapes, others, pinocchio.neutral(whole))
    return model, geometry


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


def _primitive(shape: Shape) -> Any:
    match shape:
        case Cylinder():
            return coal.Cylinder(shape.radius, shape.height)
        case _:
            raise UnknownShapeError(shape, "collision checking")


def _convex(hull: ConvexHull) -> Any:
    points, triangles = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    points.extend(list(hull.vertices))
    triangles.extend([coal.Triangle(a, b, c) for a, b, c in hull.triangles.tolist()])
    return coal.Convex(points, triangles)
