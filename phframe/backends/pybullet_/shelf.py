"""A shelf and what stands on it as bodies of PyBullet.

Board and walls are boxes for the arm and planes for the objects: on planes, cylinders stand perfectly still and are
quicker by far to simulate. What is held outside must not find a plane under it: while an object is held, it meets a
box that ends at the mouth, the edge.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from phframe.backends.pybullet_.bodies import ARM, BOARDS, BOX, OBJECT, OBJECT_MEETS, PLANE, Maker, Surfaces
from phframe.backends.pybullet_.output_capture import bullet
from phframe.core import Scene, Shelf, State, coulomb_with_board
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


def build_shelf(client: int, scene: Scene, state: State, surfaces: Surfaces) -> Bodies:
    """Make the shelf and the objects that have not spilled."""
    maker = Maker(client, surfaces)
    boxes = _boxes(maker, scene.shelf)
    edge = maker.box(slabs(scene.shelf)[0], BOARDS, 0)
    _add_planes(maker, scene.shelf)
    frictions = [coulomb_with_board(scene, item) for item in scene.objects]
    boards = {friction: maker.plane(*LEVEL, friction, BOARDS, 0) for friction in dict.fromkeys(frictions)}
    there = state.on_board.nonzero()[0].tolist()
    objects = {row: maker.cylinder(scene.objects[row], state.poses[row]) for row in there}
    for row, body in objects.items():
        stand(client, body, boards[frictions[row]], stands=True)
    return Bodies(
        objects,
        tuple(boards[friction] for friction in frictions),
        edge,
        boxes | {body: scene.ids[row] for row, body in objects.items()},
        frozenset(body for body, name in boxes.items() if name in WALLS),
        {body: row for row, body in objects.items()},
    )


def stand(client: int, body: int, board: int, *, stands: bool) -> None:
    """Let an object meet a board, or not."""
    bullet.setCollisionFilterPair(body, board, -1, -1, int(stands), physicsClientId=client)
    # Bullet looks at who may meet whom only when their boxes begin to overlap, or here:
    bullet.setCollisionFilterGroupMask(body, -1, OBJECT, OBJECT_MEETS, physicsClientId=client)


def set_edge(client: int, edge: int, friction: float, surfaces: Surfaces) -> None:
    """Give the board that ends at the mouth the coefficient of what is about to stand on it."""
    bullet.changeDynamics(edge, -1, **surfaces.against_objects(friction), physicsClientId=client)


def _boxes(maker: Maker, shelf: Shelf) -> dict[int, str]:
    """What the arm meets, and what it is called."""
    return {maker.box(slab, BOX, ARM): slab.name for slab in slabs(shelf)}


def _add_planes(maker: Maker, shelf: Shelf) -> None:
    """Walls and ceiling as objects meet them."""
    for point, normal in _planes(shelf):
        maker.soften(maker.plane(point, normal, shelf.wall_friction, PLANE, OBJECT))


def _planes(shelf: Shelf) -> Iterator[tuple[Vector, Vector]]:
    """Point and normal of the walls and the ceiling, seen from within."""
    yield (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    yield (0.0, shelf.width, 0.0), (0.0, -1.0, 0.0)
    yield (shelf.depth, 0.0, 0.0), (-1.0, 0.0, 0.0)
    yield (0.0, 0.0, shelf.height), (0.0, 0.0, -1.0)
