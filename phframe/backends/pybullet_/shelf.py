"""A shelf and what stands on it as bodies of PyBullet.

Board and walls are boxes for the arm and planes for the objects: on planes, cylinders stand perfectly still and are
quicker by far to simulate. Planes have no end, and what is held outside must find none there, neither under it nor beside
it: while an object is held, it meets boxes that end at the mouth, a board, which is called the edge, and side walls.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from phframe.backends.pybullet_.bodies import (
    ARM,
    BOARDS,
    BOX,
    HELD,
    HELD_MEETS,
    OBJECT,
    OBJECT_MEETS,
    PLANE,
    BodyMaker,
)
from phframe.backends.pybullet_.options import PybulletOptions
from phframe.backends.pybullet_.output_capture import bullet
from phframe.core import FloatArray, Scene, Shelf, coulomb_with_board
from phframe.geometry.slabs import WALLS, Vector, slabs

LEVEL: tuple[Vector, Vector] = ((0.0, 0.0, 0.0), (0.0, 0.0, 1.0))
"""Point and normal of the board's surface."""


@dataclass(frozen=True, slots=True)
class Bodies:
    """Where everything but the arm is, by PyBullet's numbers.

    Attributes:
        objects: Of every object that has not spilled, by row.
        boards: What each object stands on, by row.
        edge: The board that ends at the mouth.
        names: What a body is called in a contact.
        walls: Which bodies are walls or the ceiling.
        rows: Which object a body is.
    """

    objects: dict[int, int]
    boards: tuple[int, ...]
    edge: int
    names: Mapping[int, str]
    walls: frozenset[int]
    rows: Mapping[int, int]


def build_shelf(
    client: int, scene: Scene, poses: FloatArray, spilled: frozenset[int], options: PybulletOptions
) -> Bodies:
    """Make the shelf, and the objects that have not spilled at poses ``(n, 7)``.

    Raises:
        UnknownShapeError: If PyBullet has no primitive for the shape of an object.
    """
    maker = BodyMaker(client, options)
    boxes = _boxes(maker, scene.shelf)
    edge = maker.box(slabs(scene.shelf)[0], BOARDS, 0)
    _add_planes(maker, scene.shelf)
    frictions = [coulomb_with_board(scene, item) for item in scene.objects]
    boards = {friction: maker.plane(*LEVEL, friction, BOARDS, 0) for friction in dict.fromkeys(frictions)}
    there = [row for row in range(len(scene.objects)) if row not in spilled]
    objects = {row: maker.item(scene.objects[row], poses[row]) for row in there}
    for row, body in objects.items():
        _let_stand(client, body, boards[frictions[row]], stands=True)
        _let_meet(client, body, held=False)
    for wall in slabs(scene.shelf)[1:]:
        maker.wall(wall, scene.shelf.wall_friction)
    return Bodies(
        objects,
        tuple(boards[friction] for friction in frictions),
        edge,
        boxes | {body: scene.ids[row] for row, body in objects.items()},
        frozenset(body for body, name in boxes.items() if name in WALLS),
        {body: row for row, body in objects.items()},
    )


def set_held(client: int, scene: Scene, bodies: Bodies, row: int, options: PybulletOptions, *, held: bool) -> None:
    """Let an object meet boxes, which end at the mouth, as it must while it is held, or planes."""
    body, friction = bodies.objects[row], coulomb_with_board(scene, scene.objects[row])
    bullet.changeDynamics(bodies.edge, -1, **options.against_objects(friction), physicsClientId=client)
    for board, stands in ((bodies.edge, held), (bodies.boards[row], not held)):
        _let_stand(client, body, board, stands=stands)
        _let_meet(client, body, held=held)


def _let_stand(client: int, body: int, board: int, *, stands: bool) -> None:
    bullet.setCollisionFilterPair(body, board, -1, -1, int(stands), physicsClientId=client)


def _let_meet(client: int, body: int, *, held: bool) -> None:
    # Bullet looks at who may meet whom only when their boxes begin to overlap, or here:
    kind, meets = (HELD, HELD_MEETS) if held else (OBJECT, OBJECT_MEETS)
    bullet.setCollisionFilterGroupMask(body, -1, kind, meets, physicsClientId=client)


def _boxes(maker: BodyMaker, shelf: Shelf) -> dict[int, str]:
    """What the arm meets, and what it is called."""
    return {maker.box(slab, BOX, ARM): slab.name for slab in slabs(shelf)}


def _add_planes(maker: BodyMaker, shelf: Shelf) -> None:
    """Walls and ceiling as objects meet them."""
    for point, normal in _planes(shelf):
        maker.soften(maker.plane(point, normal, shelf.wall_friction, PLANE, OBJECT))


def _planes(shelf: Shelf) -> Iterator[tuple[Vector, Vector]]:
    """Point and normal of the walls and the ceiling, seen from within."""
    yield (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    yield (0.0, shelf.width, 0.0), (0.0, -1.0, 0.0)
    yield (shelf.depth, 0.0, 0.0), (-1.0, 0.0, 0.0)
    yield (0.0, 0.0, shelf.height), (0.0, 0.0, -1.0)
