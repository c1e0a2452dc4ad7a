"""A shelf and what stands on it as bodies of PyBullet.

Board and walls are boxes for the arm and planes for the objects: on planes, cylinders stand perfectly still and are
quicker by far to simulate. What is held outside must not find a plane under it: while an object is held, it meets a
box that ends at the mouth, the edge.

Bullet multiplies the coefficients of two bodies that touch. So that every pair has its own, whatever the others
have, objects have the root of that between objects, all else what makes the product right, and there is a board for
every coefficient that objects have with it. Turning on the spot is resisted by boards, walls and arm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from phframe.backends.pybullet_quiet import bullet
from phframe.core import FloatArray, Scene, Shelf, State, coulomb_with_board

THICKNESS = 0.1
"""Of board, walls and ceiling (m)."""
LEAST = 1e-3
"""An object's own coefficient where there is no friction between objects: not 0, by which nothing can be multiplied."""
ARM, OBJECT, PLANE, BOX, BOARD = 1, 2, 4, 8, 16
"""Collision bits of the arm, of objects, of what objects meet at walls, of what the arm meets, of boards."""
Corner = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Surfaces:
    """Friction between bodies.

    Attributes:
        objects: Coulomb coefficient of object against object.
        arm: Of the arm against all else.
        turning: Against turning on the spot (m).
        rolling: Against rolling (m).
    """

    objects: float
    arm: float
    turning: float
    rolling: float

    @property
    def own(self) -> float:
        """The coefficient that objects themselves have in Bullet."""
        return max(math.sqrt(self.objects), LEAST)

    def against_objects(self, coefficient: float) -> dict[str, float]:
        """What a body has in Bullet so that objects have a coefficient with it."""
        own = self.own
        return {"lateralFriction": coefficient / own, "spinningFriction": self.turning / own}


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
    maker = _Maker(client, surfaces)
    board, *walls = (maker.box(lower, upper, BOX, ARM) for _, lower, upper in _solids(scene.shelf))
    edge = maker.box(*_board(scene.shelf), BOARD, 0)
    for point, normal in _planes(scene.shelf):
        maker.plane(point, normal, scene.shelf.wall_friction, PLANE, OBJECT)
    frictions = [coulomb_with_board(scene, item) for item in scene.objects]
    boards = {
        friction: maker.plane((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), friction, BOARD, 0)
        for friction in dict.fromkeys(frictions)
    }
    objects = {row: maker.cylinder(scene, row, state.poses[row]) for row in state.on_board.nonzero()[0].tolist()}
    for row, body in objects.items():
        stand(client, body, boards[frictions[row]], stands=True)
    names = dict(zip((board, *walls), (name for name, *_ in _solids(scene.shelf)), strict=True))
    return Bodies(
        objects,
        tuple(boards[friction] for friction in frictions),
        edge,
        names | {body: scene.ids[row] for row, body in objects.items()},
        frozenset(walls),
        {body: row for row, body in objects.items()},
    )


def stand(client: int, body: int, board: int, *, stands: bool) -> None:
    """Let an object meet a board, or not."""
    bullet.setCollisionFilterPair(body, board, -1, -1, int(stands), physicsClientId=client)
    # Bullet looks at who may meet whom only when their boxes begin to overlap, or here:
    bullet.setCollisionFilterGroupMask(body, -1, OBJECT, ARM | OBJECT | PLANE, physicsClientId=client)


def set_edge(client: int, edge: int, friction: float, surfaces: Surfaces) -> None:
    """Give the board that ends at the mouth the coefficient of what is about to stand on it."""
    bullet.changeDynamics(edge, -1, **surfaces.against_objects(friction), physicsClientId=client)


class _Maker:
    """Makes bodies in a client."""

    def __init__(self, client: int, surfaces: Surfaces) -> None:
        self._client, self._surfaces = client, surfaces
        # Bodies without one are given a mesh to look at, which takes longer than all the rest.
        self._look = bullet.createVisualShape(bullet.GEOM_BOX, halfExtents=[0.01] * 3, physicsClientId=client)

    def box(self, lower: Corner, upper: Corner, bits: int, meets: int) -> int:
        """What the arm meets, or something held."""
        half = [(b - a) / 2.0 for a, b in zip(lower, upper, strict=True)]
        middle = [(a + b) / 2.0 for a, b in zip(lower, upper, strict=True)]
        shape = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=half, physicsClientId=self._client)
        body = self._body(0.0, shape, middle, bits, meets)
        self._set(body, lateralFriction=self._surfaces.own)  # with the arm, as objects have it
        return body

    def plane(self, point: Corner, normal: Corner, friction: float, bits: int, meets: int) -> int:
        """What objects stand on or meet at a wall."""
        shape = bullet.createCollisionShape(bullet.GEOM_PLANE, planeNormal=normal, physicsClientId=self._client)
        body = self._body(0.0, shape, point, bits, meets)
        self._set(body, **self._surfaces.against_objects(friction))
        return body

    def cylinder(self, scene: Scene, row: int, pose: FloatArray) -> int:
        """An object, at rest."""
        item = scene.objects[row]
        radius, height = item.shape.radius, item.shape.height
        shape = bullet.createCollisionShape(
            bullet.GEOM_CYLINDER, radius=radius, height=height, physicsClientId=self._client
        )
        place, (w, *xyz) = pose[:3].tolist(), pose[3:].tolist()
        body = self._body(item.mass, shape, place, OBJECT, ARM | OBJECT | PLANE, [*xyz, w])
        self._set(
            body,
            lateralFriction=self._surfaces.own,
            spinningFriction=0.0,
            rollingFriction=0.0,
            linearDamping=0.0,
            angularDamping=0.0,
        )
        return body

    def _body(
        self, mass: float, shape: int, place: Corner | list[float], bits: int, meets: int, turned: object = (0, 0, 0, 1)
    ) -> int:
        body: int = bullet.createMultiBody(
            mass, shape, self._look, basePosition=place, baseOrientation=turned, physicsClientId=self._client
        )
        bullet.setCollisionFilterGroupMask(body, -1, bits, meets, physicsClientId=self._client)
        return body

    def _set(self, body: int, **dynamics: float) -> None:
        bullet.changeDynamics(body, -1, **dynamics, physicsClientId=self._client)


def _board(shelf: Shelf) -> tuple[Corner, Corner]:
    return (0.0, -THICKNESS, -THICKNESS), (shelf.depth + THICKNESS, shelf.width + THICKNESS, 0.0)


def _solids(shelf: Shelf) -> Iterator[tuple[str, Corner, Corner]]:
    """Name, least and greatest corner (m) of board, walls and ceiling."""
    depth, width, height, t = shelf.depth, shelf.width, shelf.height, THICKNESS
    yield "board", *_board(shelf)
    yield "south wall", (0.0, -t, 0.0), (depth, 0.0, height)
    yield "north wall", (0.0, width, 0.0), (depth, width + t, height)
    yield "back wall", (depth, -t, 0.0), (depth + t, width + t, height)
    yield "ceiling", (0.0, -t, height), (depth + t, width + t, height + t)


def _planes(shelf: Shelf) -> Iterator[tuple[Corner, Corner]]:
    """Point and normal of the walls and the ceiling, seen from within."""
    yield (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)
    yield (0.0, shelf.width, 0.0), (0.0, -1.0, 0.0)
    yield (shelf.depth, 0.0, 0.0), (-1.0, 0.0, 0.0)
    yield (0.0, 0.0, shelf.height), (0.0, 0.0, -1.0)
