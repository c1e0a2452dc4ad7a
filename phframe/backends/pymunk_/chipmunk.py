"""Chipmunk's own functions, as pymunk brings them: around a step of some microseconds its wrappers cost more than the step.

Where Chipmunk calls back, it calls pymunk's functions, which hand over to an object with the attributes that they ask for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any
from weakref import finalize

from pymunk import Arbiter
from pymunk._chipmunk_cffi import ffi, lib

Handle = Any
"""A shape or a joint as Chipmunk has it."""
Point = tuple[float, float]

UNTURNED = (1.0, 0.0, 0.0, 1.0, 0.0, 0.0)
"""The transform that changes nothing."""
EVERYTHING = 0xFFFFFFFF
"""The mask of all categories of shapes."""

step: Callable[[Handle, float], None] = lib.cpSpaceStep
"""Step a space (its handle) by so many seconds."""
impulse_of: Callable[[Handle], float] = lib.cpConstraintGetImpulse
"""What a joint gave in the last step (Ns)."""
set_max_force: Callable[[Handle, float], None] = lib.cpConstraintSetMaxForce
"""Set the most that a joint gives (N)."""
max_force: Callable[[Handle], float] = lib.cpConstraintGetMaxForce
"""The most that a joint gives (N)."""
kind_of: Callable[[Handle], int] = lib.cpShapeGetCollisionType
"""The collision type of a shape."""
_position: Callable[[Handle], Any] = lib.cpBodyGetPosition
_velocity: Callable[[Handle], Any] = lib.cpBodyGetVelocity
_angle: Callable[[Handle], float] = lib.cpBodyGetAngle
_angular_velocity: Callable[[Handle], float] = lib.cpBodyGetAngularVelocity


class ChipmunkBody:
    """A rigid body in the plane.

    Attributes:
        handle: As Chipmunk has it.
    """

    __slots__ = ("handle",)

    def __init__(self, handle: Handle) -> None:
        self.handle = handle

    @property
    def position(self) -> Point:
        """Where its centre is (m)."""
        found = _position(self.handle)
        return found.x, found.y

    @position.setter
    def position(self, value: Point) -> None:
        lib.cpBodySetPosition(self.handle, value)

    @property
    def angle(self) -> float:
        """How far it is turned (rad)."""
        return _angle(self.handle)

    @angle.setter
    def angle(self, value: float) -> None:
        lib.cpBodySetAngle(self.handle, value)

    @property
    def velocity(self) -> Point:
        """Of its centre (m/s)."""
        found = _velocity(self.handle)
        return found.x, found.y

    @velocity.setter
    def velocity(self, value: Point) -> None:
        lib.cpBodySetVelocity(self.handle, value)

    @property
    def angular_velocity(self) -> float:
        """How fast it turns (rad/s)."""
        return _angular_velocity(self.handle)

    @angular_velocity.setter
    def angular_velocity(self, value: float) -> None:
        lib.cpBodySetAngularVelocity(self.handle, value)

    def to_local(self, point: Point) -> Point:
        """A point of the shelf in the frame of the body."""
        found = lib.cpBodyWorldToLocal(self.handle, point)
        return found.x, found.y

    def velocity_at(self, point: Point) -> Point:
        """The velocity (m/s) that a point of the shelf would have as part of the body."""
        found = lib.cpBodyGetVelocityAtWorldPoint(self.handle, point)
        return found.x, found.y


class ChipmunkSpace:
    """Bodies, their shapes and the joints between them.

    All are given back together as soon as nobody holds the space any more: none of their handles may be used then.

    Args:
        iterations: Of the solver, per step.
        slop: Overlap that is left alone (m).

    Attributes:
        handle: As Chipmunk has it.
        board: The body that everything stands on: it never moves.
    """

    def __init__(self, iterations: int, slop: float) -> None:
        self.handle: Handle = lib.cpSpaceNew()
        lib.cpSpaceSetIterations(self.handle, iterations)
        lib.cpSpaceSetCollisionSlop(self.handle, slop)
        self.board = ChipmunkBody(lib.cpSpaceGetStaticBody(self.handle))
        self._bodies: list[Handle] = []
        self._shapes: list[Handle] = []
        self._joints: list[Handle] = []
        self._called_back: list[Handle] = []
        finalize(self, _free, self.handle, self._joints, self._shapes, self._bodies, self._called_back)

    def body(self, mass: float, moment: float) -> ChipmunkBody:
        """A new body of some mass (kg) and moment of inertia (kg m^2)."""
        return self._with_body(lib.cpBodyNew(mass, moment))

    def kinematic(self) -> ChipmunkBody:
        """A new body that goes at its velocity whatever happens."""
        return self._with_body(lib.cpBodyNewKinematic())

    def _with_body(self, handle: Handle) -> ChipmunkBody:
        self._bodies.append(lib.cpSpaceAddBody(self.handle, handle))
        return ChipmunkBody(handle)

    def add_shape(
        self,
        shape: Handle,
        friction: float,
        kind: int,
        group: int = 0,
        *,
        categories: int = EVERYTHING,
        mask: int = EVERYTHING,
    ) -> Handle:
        """Add a new shape.

        Args:
            shape: Made for a body of this space that is where it is to be.
            friction: Its factor in Coulomb's coefficient.
            kind: Its collision type.
            group: Shapes of the same group pass through one another, but for group 0.
            categories: Its own, a bit each.
            mask: Categories of what it does not pass over or under.
        """
        lib.cpShapeSetFriction(shape, friction)
        lib.cpShapeSetCollisionType(shape, kind)
        set_group(shape, group, categories=categories, mask=mask)
        self._shapes.append(lib.cpSpaceAddShape(self.handle, shape))
        return shape

    def pivot(self, a: ChipmunkBody, b: ChipmunkBody, at_a: Point, at_b: Point) -> Handle:
        """A new joint that keeps a point of one body on a point of another, each in its body's frame."""
        return self._with_joint(lib.cpPivotJointNew2(a.handle, b.handle, at_a, at_b))

    def gear(self, a: ChipmunkBody, b: ChipmunkBody, phase: float) -> Handle:
        """A new joint that keeps the angle (rad) from one body to another."""
        return self._with_joint(lib.cpGearJointNew(a.handle, b.handle, phase, 1.0))

    def _with_joint(self, handle: Handle) -> Handle:
        self._joints.append(lib.cpSpaceAddConstraint(self.handle, handle))
        return handle

    def remove_joints(self, joints: Iterable[Handle]) -> None:
        """Take joints out; they may be put back."""
        for joint in joints:
            lib.cpSpaceRemoveConstraint(self.handle, joint)

    def put_back(self, joints: Iterable[Handle]) -> None:
        """Put joints back that were taken out."""
        for joint in joints:
            lib.cpSpaceAddConstraint(self.handle, joint)

    def remove(self, body: ChipmunkBody, shape: Handle) -> None:
        """Take a body with no joints and its only shape out for good."""
        lib.cpSpaceRemoveShape(self.handle, shape)
        lib.cpSpaceRemoveBody(self.handle, body.handle)

    def step(self, seconds: float) -> None:
        """Step once."""
        step(self.handle, seconds)

    def on_touch(self, first: int, second: int, begun: list[tuple[Handle, Handle]]) -> None:
        """Have two shapes, of two collision types, appended to a list when they begin to touch in a step."""
        handler = lib.cpSpaceAddCollisionHandler(self.handle, first, second)
        handler.beginFunc = lib.ext_cpCollisionBeginFunc
        handler.userData = called_back = ffi.new_handle(_BeginHandler(begun))
        self._called_back.append(called_back)


def contacts(body: ChipmunkBody) -> list[tuple[Handle, Handle, float]]:
    """The contacts that a body had in the last step: its own shape, the other, how deep they overlap (m)."""
    found: list[tuple[Handle, Handle, float]] = []
    asked = ffi.new_handle((_InSpace, lambda arbiter: found.append((*_shapes(arbiter), _depth(arbiter))), (), {}))
    lib.cpBodyEachArbiter(body.handle, lib.ext_cpBodyArbiterIteratorFunc, asked)
    return found


def circle(body: ChipmunkBody, radius: float) -> Handle:
    """A new shape: a disc about the centre of a body."""
    return lib.cpCircleShapeNew(body.handle, radius, (0.0, 0.0))


def polygon(body: ChipmunkBody, corners: Sequence[Point]) -> Handle:
    """A new shape: the convex hull of some points in the frame of a body."""
    return lib.cpPolyShapeNew(body.handle, len(corners), corners, UNTURNED, 0.0)


def set_corners(shape: Handle, corners: Sequence[Point]) -> None:
    """Give a polygon other corners, in the same order."""
    lib.cpPolyShapeSetVertsRaw(shape, len(corners), corners)


def set_group(shape: Handle, group: int, *, categories: int = EVERYTHING, mask: int = EVERYTHING) -> None:
    """Shapes of the same group pass through one another, but for group 0; arguments as for ``add_shape``."""
    lib.cpShapeSetFilter(shape, (group, categories, mask))


def limit(joint: Handle, force: float) -> Handle:
    """Let a joint resist motion with at most a force (N or Nm), and never push back."""
    lib.cpConstraintSetMaxBias(joint, 0.0)
    lib.cpConstraintSetMaxForce(joint, force)
    return joint


class _BeginHandler:
    """What pymunk's callback at the beginning of a contact asks for."""

    __slots__ = ("_begun", "_space", "data")

    def __init__(self, begun: list[tuple[Handle, Handle]]) -> None:
        self._begun, self._space, self.data = begun, None, {"begin": None}

    def _begin(self, arbiter: Arbiter, space: None, data: None) -> None:
        self._begun.append(_shapes(arbiter))


class _InSpace:
    """What pymunk's callback for each contact of a body asks of the body: a space that is there."""

    space = ()


def _shapes(arbiter: Arbiter) -> tuple[Handle, Handle]:
    first, second = ffi.new("cpShape *[1]"), ffi.new("cpShape *[1]")
    lib.cpArbiterGetShapes(arbiter._arbiter, first, second)
    return first[0], second[0]


def _depth(arbiter: Arbiter) -> float:
    return max((-point.distance for point in arbiter.contact_point_set.points), default=0.0)


def _free(space: Handle, joints: list[Handle], shapes: list[Handle], bodies: list[Handle], _: list[Handle]) -> None:
    """Give back a space and what was in it; what is called back is held as long."""
    lib.cpSpaceFree(space)
    for joint in joints:
        lib.cpConstraintFree(joint)
    for shape in shapes:
        lib.cpShapeFree(shape)
    for body in bodies:
        lib.cpBodyFree(body)
