"""A shelf seen from above as a pymunk space: walls, objects with friction on the board, an arm on a force-limited drive."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import pymunk

from phframe.backends.contract import GRAVITY
from phframe.backends.pymunk_.measures import Measures
from phframe.backends.pymunk_.shapes import Footprint, footprint
from phframe.core import ArmShape, Condition, FloatArray, Outline, Scene, SceneObject, State, coulomb_with_board, yaw_of

WALL_THICKNESS = 0.1
ARM, OBJECT, WALL = 1, 2, 3
"""Collision types."""
FEET = 6
"""Points that an object stands on; fewer resist differently in different directions."""
TRIM = 1e-6
"""By how much the arm's outlines are smaller than they are (m)."""


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


@dataclass(slots=True)
class ShelfItem:
    """An object on the board or in the hand.

    Attributes:
        thing: As the scene has it.
        body: Where it is.
        shape: Its outline.
        floor: Joints of limited force that stand for its friction with the board.
        friction: Most that the board resists its sliding with, ``mu m g`` (N).
        on_board: Whether it stands on the board; what is held outside does not.
    """

    thing: SceneObject
    body: pymunk.Body
    shape: pymunk.Shape
    floor: tuple[pymunk.Constraint, ...]
    friction: float
    on_board: bool = True

    @property
    def name(self) -> str:
        """Its id."""
        return self.thing.id

    @property
    def radius(self) -> float:
        """Its bounding radius seen from above (m)."""
        return self.thing.radius


@dataclass(frozen=True, slots=True)
class MovingFinger:
    """A part of the arm that moves as the gripper opens, in plain numbers: it is asked for at every step of a grasp.

    Attributes:
        polygon: Its shape.
        side: Which way it moves: +1 left, -1 right.
        corners: As it lies when closed, in the fingertip frame (m).
        back: Least x of the corners (m).
        front: Greatest x of the corners (m).
    """

    polygon: pymunk.Poly
    side: int
    corners: tuple[tuple[float, float], ...]
    back: float
    front: float


@dataclass(slots=True)
class DrivenArm:
    """The arm: a body that a force-limited drive draws along with a carrier, which goes exactly where it is told.

    Attributes:
        body: Origin at the fingertip.
        carrier: Kinematic.
        drive: Joins the two; its impulse is what the world pushes back with.
        parts: Its shapes, and the outlines they have when the fingers are closed.
        fingers: The parts that move with the opening.
    """

    body: pymunk.Body
    carrier: pymunk.Body
    drive: pymunk.PivotJoint
    parts: tuple[tuple[pymunk.Poly, Outline], ...]
    fingers: tuple[MovingFinger, ...]


@dataclass(slots=True)
class ShelfSpace:
    """Everything in one space, and what a State says of it besides poses.

    Attributes:
        scene: What is modelled.
        space: The pymunk space.
        items: Objects on the board or in the hand, by id.
        arm: The arm.
        spilled: Last pose ``(7,)`` of what has left the board, by id.
        toppled: Ids of what lay on its side when the state was restored.
        names: What each shape is called, of objects, walls and parts of the arm.
        measures: Of the arm.
        opening: Distance between the fingers now (m).
        command: Distance they are told to have (m).
        held: Id of the object in the hand.
        parked: The arm is out of the way and has not been placed yet.
        at_rest: Nothing moves.
        tick: Steps since the motion began.
        touched: Arm contacts since the motion began: step, part of the arm, what it met, whether that is a wall.
        grip: Joints that hold the object in the hand.
    """

    scene: Scene
    space: pymunk.Space
    items: dict[str, ShelfItem]
    arm: DrivenArm
    spilled: dict[str, FloatArray]
    toppled: frozenset[str]
    names: dict[pymunk.Shape, str]
    measures: Measures
    opening: float
    command: float
    held: str | None = None
    parked: bool = True
    at_rest: bool = True
    tick: int = 0
    touched: list[tuple[int, str, str, bool]] = field(default_factory=list)
    grip: tuple[pymunk.Constraint, ...] = ()


@dataclass(frozen=True, slots=True)
class PymunkModel:
    """What every world of one physics object has in common.

    Attributes:
        scene: What is modelled.
        shape: Of the arm.
        measures: Of the arm.
        surfaces: Coefficients of friction.
        iterations: Of the solver, per step.
        arm_mass: Inertia of the arm as the world feels it (kg).
    """

    scene: Scene
    shape: ArmShape
    measures: Measures
    surfaces: PymunkSurfaces
    iterations: int
    arm_mass: float


def build_world(model: PymunkModel, state: State) -> ShelfSpace:
    """A new space that holds ``state``; always new, since a used one remembers what ran in it."""
    scene, shape, surfaces = model.scene, model.shape, model.surfaces
    space = pymunk.Space()
    space.iterations = model.iterations
    space.collision_slop = 1e-4
    walls = _add_walls(space, scene, surfaces)
    spilled = {scene.ids[row]: state.poses[row] for row in np.flatnonzero(~state.on_board)}
    items = {
        item.id: _add_item(space, scene, item, state.poses[row], surfaces)
        for row, item in enumerate(scene.objects)
        if item.id not in spilled
    }
    arm = _add_arm(space, shape, surfaces, model.arm_mass)
    toppled = frozenset(name for name, c in zip(scene.ids, state.conditions, strict=True) if c is Condition.TOPPLED)
    closed, names = shape.min_opening, _names(walls, items, arm)
    world = ShelfSpace(
        scene, space, items, arm, spilled, toppled, names, model.measures, opening=closed, command=closed
    )
    for kind in (OBJECT, WALL):
        space.on_collision(ARM, kind, begin=note_contact, data=world)
    return world


def _names(walls: dict[pymunk.Shape, str], items: dict[str, ShelfItem], arm: DrivenArm) -> dict[pymunk.Shape, str]:
    objects = {item.shape: name for name, item in items.items()}
    return {**walls, **objects, **{shape: outline.part for shape, outline in arm.parts}}


def note_contact(arbiter: pymunk.Arbiter, _: pymunk.Space, world: ShelfSpace) -> None:
    """Write down that the arm touches something; the arm's shape comes first."""
    part, other = arbiter.shapes
    world.touched.append((world.tick, world.names[part], world.names[other], other.collision_type == WALL))


def overlap(world: ShelfSpace) -> float:
    """How deep the arm is in whatever it touches (m): pymunk lets bodies overlap where they press on each other."""
    depths = [0.0]
    world.arm.body.each_arbiter(_note_depth, depths)
    return max(depths)


def _note_depth(arbiter: pymunk.Arbiter, depths: list[float]) -> None:
    depths.extend(-point.distance for point in arbiter.contact_point_set.points)


def _add_walls(space: pymunk.Space, scene: Scene, surfaces: PymunkSurfaces) -> dict[pymunk.Shape, str]:
    depth, width, t = scene.shelf.depth, scene.shelf.width, WALL_THICKNESS
    corners = {
        "south wall": (0.0, -t, depth, 0.0),
        "north wall": (0.0, width, depth, width + t),
        "back wall": (depth, -t, depth + t, width + t),
    }
    walls: dict[pymunk.Shape, str] = {}
    for name, (x0, y0, x1, y1) in corners.items():
        wall = pymunk.Poly(space.static_body, [(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
        wall.friction = surfaces.partner_factor(scene.shelf.wall_friction)
        wall.collision_type = WALL
        space.add(wall)
        walls[wall] = name
    return walls


def _add_item(
    space: pymunk.Space, scene: Scene, item: SceneObject, pose: FloatArray, surfaces: PymunkSurfaces
) -> ShelfItem:
    body = pymunk.Body(item.mass, 1.0)
    friction = coulomb_with_board(scene, item) * item.mass * GRAVITY
    foot = footprint(body, item.shape, item.mass, friction)
    body.moment = foot.inertia
    body.position = float(pose[0]), float(pose[1])
    body.angle = yaw_of(pose)
    foot.primitive.friction = surfaces.object_factor
    foot.primitive.collision_type = OBJECT
    floor = _floor(space, body, friction, foot, surfaces.standing)
    space.add(body, foot.primitive, *floor)
    return ShelfItem(item, body, foot.primitive, floor, friction)


def _floor(
    space: pymunk.Space, body: pymunk.Body, friction: float, foot: Footprint, standing: float | None
) -> tuple[pymunk.Constraint, ...]:
    """Coulomb friction (N) with the board, in joints whose bias is off: they resist motion and never push back.

    The limit surface, the forces and torques at which an object begins to slide (Goyal, Ruina and Papadopoulos, 1991), is
    a box where sliding and turning are two joints that know nothing of one another, and nearly the true one where the
    object stands on points around its edge: what slides already is turned by little.
    """
    if standing is None:
        slide = pymunk.PivotJoint(space.static_body, body, (0.0, 0.0), (0.0, 0.0))
        spin = pymunk.GearJoint(space.static_body, body, 0.0, 1.0)
        return _limited(slide, friction), _limited(spin, foot.spin_limit)
    angles = [math.tau * point / FEET for point in range(FEET)]
    distance = foot.edge * standing
    points = [(distance * math.cos(angle), distance * math.sin(angle)) for angle in angles]
    return tuple(_limited(pymunk.PivotJoint(space.static_body, body, (0.0, 0.0), at), friction / FEET) for at in points)


def _limited(joint: pymunk.Constraint, force: float) -> pymunk.Constraint:
    joint.max_bias = 0.0
    joint.max_force = force
    return joint


def _trimmed(vertices: FloatArray) -> tuple[tuple[float, float], ...]:
    """An outline, a trifle smaller: a centre exactly in line with an edge, where planners aim, Chipmunk takes for inside."""
    middle = (vertices.max(axis=0) + vertices.min(axis=0)) / 2.0
    return tuple((x, y) for x, y in (vertices - TRIM * np.sign(vertices - middle)).tolist())


def _add_arm(space: pymunk.Space, shape: ArmShape, surfaces: PymunkSurfaces, mass: float) -> DrivenArm:
    body = pymunk.Body(mass, mass)
    carrier = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
    drive = pymunk.PivotJoint(carrier, body, (0.0, 0.0), (0.0, 0.0))
    align = pymunk.GearJoint(carrier, body, 0.0, 1.0)
    space.add(body, carrier, drive, align)
    parts, fingers = [], []
    for outline in shape.closed:
        corners = _trimmed(outline.vertices)
        polygon = pymunk.Poly(body, corners)
        polygon.friction = surfaces.partner_factor(surfaces.arm)
        polygon.collision_type = ARM
        polygon.filter = pymunk.ShapeFilter(group=1)
        space.add(polygon)
        parts.append((polygon, outline))
        if outline.side:
            depths = [x for x, _ in corners]
            fingers.append(MovingFinger(polygon, outline.side, corners, min(depths), max(depths)))
    return DrivenArm(body, carrier, drive, tuple(parts), tuple(fingers))
