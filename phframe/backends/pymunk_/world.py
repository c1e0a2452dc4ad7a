"""A shelf seen from above as a pymunk space: walls, objects with friction on the board, an arm on a force-limited drive."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from phframe.backends.pymunk_.chipmunk import (
    ChipmunkBody,
    ChipmunkSpace,
    Handle,
    Point,
    contacts,
    kind_of,
    limit,
    polygon,
)
from phframe.backends.pymunk_.measures import Measures
from phframe.backends.pymunk_.shapes import Footprint, footprint
from phframe.core import ArmShape, Condition, FloatArray, Scene, SceneObject, State, drag_on_board, yaw_of

WALL_THICKNESS = 0.1
ARM, OBJECT, WALL = 1, 2, 3
"""Collision types."""
OTHERS = 1 << 31
"""The category of what is no part of the arm; each part has one of its own, from the first bit."""
ARM_GROUP = 1
"""What passes through one another: the parts of the arm and what it holds."""
CENTER = (0.0, 0.0)
FEET = 6
"""Points that an object stands on; fewer resist differently in different directions."""
FOOT_ANGLES = tuple(math.tau * point / FEET for point in range(FEET))
TRIM = 1e-6
"""By how much the arm's outlines are smaller than they are (m)."""
SLOP = 1e-4
"""Overlap that the solver leaves alone (m)."""


@dataclass(frozen=True, slots=True)
class PymunkSurfaces:
    """Coulomb coefficients between bodies; pymunk multiplies those of the two shapes that touch.

    Attributes:
        objects: Object against object.
        arm: Arm against object.
        standing: Fraction of its radius at which an object stands on the board; None: it slides and turns separately.
    """

    objects: float
    arm: float
    standing: float | None

    @property
    def object_factor(self) -> float:
        """An object's factor in every product."""
        return math.sqrt(self.objects)

    def partner_factor(self, coefficient: float) -> float:
        """The factor of what touches an object with a coefficient."""
        return coefficient / self.object_factor if self.object_factor > 0.0 else 0.0


Circle = tuple[float, float, float]
"""Centre and bounding radius of an object (m)."""


@dataclass(slots=True)
class ShelfItem:
    """An object on the board or in the hand.

    Attributes:
        thing: As the scene has it.
        name: Its id.
        radius: Its bounding radius seen from above (m).
        found: Centre and bounding radius where the state had it (m): it is there still as long as it has no floor.
        body: Where it is.
        foot: Its outline, and what it stands with.
        friction: Most that the board resists its sliding with, ``mu m g`` (N).
        floor: Joints of limited force that stand for that friction; none yet while nothing can have moved it.
        meets: Categories of what it touches where they meet: all but the parts of the arm that pass over it.
        on_board: Whether it stands on the board; what is held outside does not.
    """

    thing: SceneObject
    name: str
    radius: float
    found: Circle
    body: ChipmunkBody
    foot: Footprint
    friction: float
    meets: int
    floor: tuple[Handle, ...] = ()
    on_board: bool = True

    @property
    def shape(self) -> Handle:
        """Its outline."""
        return self.foot.primitive

    @property
    def meets_arm(self) -> bool:
        """Whether any part of the arm meets it."""
        return self.meets != OTHERS


@dataclass(frozen=True, slots=True)
class MovingFinger:
    """A part of the arm that moves as the gripper opens, in plain numbers: it is asked for at every step of a grasp.

    Attributes:
        polygon: Its shape.
        side: Which way it moves: +1 left, -1 right.
        corners: As it lies when closed, in the fingertip frame (m).
        back: Least x of the corners (m).
        front: Greatest x of the corners (m).
        category: Of its shape.
    """

    polygon: Handle
    side: int
    corners: tuple[Point, ...]
    back: float
    front: float
    category: int


@dataclass(slots=True)
class DrivenArm:
    """The arm: a body that a force-limited drive draws along with a carrier, which goes exactly where it is told.

    Attributes:
        body: Origin at the fingertip.
        carrier: Kinematic.
        drive: Joins the two; its impulse is what the world pushes back with.
        names: What its shapes are called.
        fingers: The parts that move with the opening.
    """

    body: ChipmunkBody
    carrier: ChipmunkBody
    drive: Handle
    names: dict[Handle, str]
    fingers: tuple[MovingFinger, ...]


@dataclass(slots=True)
class ShelfSpace:
    """Everything in one space, and what a State says of it besides poses.

    Attributes:
        scene: What is modelled.
        space: The space.
        items: Objects on the board or in the hand, by id.
        arm: The arm.
        spilled: Last pose (7 numbers) of what has left the board, by id.
        toppled: Ids of what lay on its side when the state was restored.
        names: What each shape is called, of objects, walls and parts of the arm.
        measures: Of the arm.
        standing: Fraction of its radius at which an object stands on the board, as ``PymunkSurfaces`` has it.
        opening: Distance between the fingers now (m).
        command: Distance they are told to have (m).
        held: Id of the object in the hand.
        parked: The arm is out of the way and has not been placed yet.
        at_rest: Nothing moves.
        tick: Steps since the motion began.
        begun: Shapes, the arm's first, that began to touch in the last step and are not in ``touched`` yet.
        touched: Arm contacts since the motion began: step, part of the arm, what it met, whether that is a wall.
        grip: Joints that hold the object in the hand.
    """

    scene: Scene
    space: ChipmunkSpace
    items: dict[str, ShelfItem]
    arm: DrivenArm
    spilled: dict[str, list[float]]
    toppled: set[str]
    names: dict[Handle, str]
    measures: Measures
    standing: float | None
    opening: float
    command: float
    held: str | None = None
    parked: bool = True
    at_rest: bool = True
    tick: int = 0
    begun: list[tuple[Handle, Handle]] = field(default_factory=list)
    touched: list[tuple[int, str, str, bool]] = field(default_factory=list)
    grip: tuple[Handle, ...] = ()

    @property
    def movable(self) -> list[ShelfItem]:
        """What may have moved since the state was restored: the rest is as it was."""
        return [item for item in self.items.values() if item.floor]


@dataclass(frozen=True, slots=True)
class PymunkModel:
    """What every world of one physics object has in common.

    Attributes:
        scene: What is modelled.
        shape: Of the arm.
        outlines: The same as the engine has them, closed: corners in the fingertip frame (m).
        measures: Of the arm.
        surfaces: Coefficients of friction.
        iterations: Of the solver, per step.
        arm_mass: Inertia of the arm as the world feels it (kg).
        meeting: Categories of the parts of the arm that meet what is so tall (m), for the heights of all objects.
    """

    scene: Scene
    shape: ArmShape
    outlines: tuple[tuple[Point, ...], ...]
    measures: Measures
    surfaces: PymunkSurfaces
    iterations: int
    arm_mass: float
    meeting: Mapping[float, int]


def category_of(part: int) -> int:
    """The category of a part of the arm, by its place among the outlines; from the 31st on they share one."""
    return 1 << min(part, 30)


def meeting(shape: ArmShape, height: float) -> int:
    """The categories of the parts of an arm that meet what is so tall (m)."""
    return sum({category_of(part) for part, meets in enumerate(shape.meets(height)) if meets})


def build_world(model: PymunkModel, state: State) -> ShelfSpace:
    """A new space that holds ``state``; always new, since a used one remembers what ran in it."""
    scene, surfaces, closed = model.scene, model.surfaces, model.measures.min_opening
    space = ChipmunkSpace(model.iterations, SLOP)
    walls = _add_walls(space, scene, surfaces)
    found = zip(scene.objects, state.poses.tolist(), state.conditions, strict=True)
    items, spilled, toppled = {}, {}, set()
    for item, pose, condition in found:
        if condition is Condition.SPILLED:
            spilled[item.id] = pose
        else:
            items[item.id] = _add_item(space, model, item, pose)
        if condition is Condition.TOPPLED:
            toppled.add(item.id)
    arm = _add_arm(space, model)
    names = {**walls, **{item.shape: name for name, item in items.items()}, **arm.names}
    world = ShelfSpace(
        scene, space, items, arm, spilled, toppled, names, model.measures, surfaces.standing, closed, closed
    )
    for kind in (OBJECT, WALL):
        space.on_touch(ARM, kind, world.begun)
    return world


def note_contact(world: ShelfSpace, part: Handle, other: Handle) -> None:
    """Write down that a part of the arm touches something."""
    world.touched.append((world.tick, world.names[part], world.names[other], kind_of(other) == WALL))


def overlap(world: ShelfSpace) -> float:
    """How deep the arm is in whatever it touches (m): bodies overlap where they press on each other."""
    return max((depth for _, _, depth in contacts(world.arm.body)), default=0.0)


def _add_walls(space: ChipmunkSpace, scene: Scene, surfaces: PymunkSurfaces) -> dict[Handle, str]:
    depth, width, t = scene.shelf.depth, scene.shelf.width, WALL_THICKNESS
    corners = {
        "south wall": (0.0, -t, depth, 0.0),
        "north wall": (0.0, width, depth, width + t),
        "back wall": (depth, -t, depth + t, width + t),
    }
    friction = surfaces.partner_factor(scene.shelf.wall_friction)
    walls: dict[Handle, str] = {}
    for name, (x0, y0, x1, y1) in corners.items():
        wall = polygon(space.board, [(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
        walls[space.add_shape(wall, friction, WALL)] = name
    return walls


def _add_item(space: ChipmunkSpace, model: PymunkModel, item: SceneObject, pose: list[float]) -> ShelfItem:
    (x, y, *_), radius = pose, item.radius
    friction = drag_on_board(model.scene, item)
    foot = footprint(space, item.shape, item.mass, friction)
    foot.body.position, foot.body.angle = (x, y), yaw_of(pose)
    meets = OTHERS | model.meeting[item.shape.height]
    space.add_shape(foot.primitive, model.surfaces.object_factor, OBJECT, categories=OTHERS, mask=meets)
    return ShelfItem(item, item.id, radius, (x, y, radius), foot.body, foot, friction, meets)


def lay_floor(world: ShelfSpace, item: ShelfItem) -> None:
    """Let an object feel its friction with the board, if it does not yet."""
    if not item.floor:
        item.floor = _floor(world.space, item, world.standing)


def _floor(space: ChipmunkSpace, item: ShelfItem, standing: float | None) -> tuple[Handle, ...]:
    """Coulomb friction with the board, in joints whose bias is off: they resist motion and never push back.

    The limit surface, the forces and torques at which an object begins to slide (Goyal, Ruina and Papadopoulos, 1991), is
    a box where sliding and turning are two joints that know nothing of one another, and nearly the true one where the
    object stands on points around its edge: what slides already is turned by little.
    """
    board, body, friction = space.board, item.body, item.friction
    if standing is None:
        slide, spin = space.pivot(board, body, CENTER, CENTER), space.gear(board, body, 0.0)
        return limit(slide, friction), limit(spin, item.foot.spin_limit)
    distance = item.foot.edge * standing
    points = [(distance * math.cos(angle), distance * math.sin(angle)) for angle in FOOT_ANGLES]
    return tuple(limit(space.pivot(board, body, CENTER, at), friction / FEET) for at in points)


def trimmed(vertices: FloatArray) -> tuple[Point, ...]:
    """An outline, a trifle smaller: a centre exactly in line with an edge, where planners aim, Chipmunk takes for inside."""
    middle = (vertices.max(axis=0) + vertices.min(axis=0)) / 2.0
    return tuple((x, y) for x, y in (vertices - TRIM * np.sign(vertices - middle)).tolist())


def _add_arm(space: ChipmunkSpace, model: PymunkModel) -> DrivenArm:
    body, carrier = space.body(model.arm_mass, model.arm_mass), space.kinematic()
    drive = space.pivot(carrier, body, CENTER, CENTER)
    space.gear(carrier, body, 0.0)
    friction = model.surfaces.partner_factor(model.surfaces.arm)
    names, fingers = {}, []
    for number, (outline, corners) in enumerate(zip(model.shape.closed, model.outlines, strict=True)):
        part = space.add_shape(polygon(body, corners), friction, ARM, ARM_GROUP, categories=category_of(number))
        names[part] = outline.part
        if outline.side:
            depths = [x for x, _ in corners]
            fingers.append(MovingFinger(part, outline.side, corners, min(depths), max(depths), category_of(number)))
    return DrivenArm(body, carrier, drive, names, tuple(fingers))
