"""A shelf and what stands on it as a MuJoCo spec.

Board and walls are boxes for the arm and planes for the objects, which MuJoCo keeps perfectly still on planes. Each
object is a free body with two geoms of the same shape: one that meets arm, walls and objects, and one, its foot, that
meets the board with the object's own friction. What is held outside must not find a plane under it: while an object is
held, its foot meets the box, which ends at the mouth.

MuJoCo's own convex collision is off and libccd's is used. Where a box's edge meets a cylinder, the contacts of the
former push along a face of the box instead of from the edge to the axis, by which pushed objects slip past the fingers
(MuJoCo 4.0.0, native CCD with multiple contacts; with single contacts, pressed objects chatter and sink in).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import mujoco

from phframe.core import Scene, SceneObject, Shelf, coulomb_with_board
from phframe.geometry.slabs import Slab, Vector, slabs

ARM_KIND, ARM_MEETS = 1, 2
"""Collision bits of the arm: it meets what has bit 2, and never itself."""
WALL, PLANE, BOX = 4, 8, 16
"""Collision bits of the planes that are walls, of the plane that is the board, of the box that is the board."""
OBJECT_KIND, OBJECT_MEETS = ARM_MEETS, ARM_KIND | ARM_MEETS | WALL
"""Collision bits of objects: they meet the arm, one another and walls; their feet meet one of the boards."""
Turn = tuple[float, float, float, float]
CONTACT = (0.02, 1.0)
"""Time constant (s) and damping ratio of contacts: stiff, and damped so that what is hit hardly rebounds."""


@dataclass(frozen=True, slots=True)
class Surfaces:
    """Friction between bodies, and how contacts are solved.

    Attributes:
        objects: Coulomb coefficient of object against object.
        turning: Friction against turning on a spot (m).
        rolling: Friction against rolling (m).
        cone: ``elliptic`` is Coulomb's; ``pyramidal`` is quicker to solve.
        firmness: Stiffness of friction over that of contact, MuJoCo's impratio.
    """

    objects: float
    turning: float
    rolling: float
    cone: Literal["elliptic", "pyramidal"]
    firmness: float

    def triple(self, coefficient: float) -> list[float]:
        """Sliding, turning and rolling, as MuJoCo wants them."""
        return [coefficient, self.turning, self.rolling]


def shelf_spec(scene: Scene, surfaces: Surfaces, *, step: float, sleep: bool) -> Any:
    """The shelf with its objects, each at its place in the scene; no arm yet."""
    spec = mujoco.MjSpec()
    _set_options(spec.option, surfaces, step, sleep)
    _add_boards(spec, scene.shelf, surfaces.triple(scene.shelf.board_friction))
    _add_walls(spec, scene.shelf, surfaces.triple(scene.shelf.wall_friction))
    for row, item in enumerate(scene.objects):
        _add_object(
            spec, row, item, surfaces.triple(surfaces.objects), surfaces.triple(coulomb_with_board(scene, item))
        )
    return spec


def object_name(row: int) -> str:
    """What the object in a row of the scene is called in the spec; ids could clash with other names."""
    return f"object/{row}"


def foot_name(row: int) -> str:
    """What its foot is called."""
    return f"foot/{row}"


def _set_options(option: Any, surfaces: Surfaces, step: float, sleep: bool) -> None:
    option.timestep = step
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    cones = {"elliptic": mujoco.mjtCone.mjCONE_ELLIPTIC, "pyramidal": mujoco.mjtCone.mjCONE_PYRAMIDAL}
    option.cone, option.impratio = cones[surfaces.cone], surfaces.firmness
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET | mujoco.mjtDisableBit.mjDSBL_NATIVECCD
    if sleep:
        option.enableflags |= mujoco.mjtEnableBit.mjENBL_SLEEP


def _add_boards(spec: Any, shelf: Shelf, friction: list[float]) -> None:
    _add_plane(spec, (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), PLANE, friction)
    _add_box(spec, slabs(shelf)[0], BOX, friction)


def _add_walls(spec: Any, shelf: Shelf, friction: list[float]) -> None:
    for wall in slabs(shelf)[1:]:
        _add_box(spec, wall, 0, friction)
    depth, width, height = shelf.depth, shelf.width, shelf.height
    for point, turned in (
        ((0.0, 0.0, 0.0), (1.0, -1.0, 0.0, 0.0)),
        ((0.0, width, 0.0), (1.0, 1.0, 0.0, 0.0)),
        ((depth, 0.0, 0.0), (1.0, 0.0, -1.0, 0.0)),
        ((0.0, 0.0, height), (0.0, 1.0, 0.0, 0.0)),
    ):
        _add_plane(spec, point, turned, WALL, friction)


def _add_plane(spec: Any, point: Vector, turned: Turn, meets: int, friction: list[float]) -> None:
    """What objects meet at a wall or stand on; its z axis points inwards."""
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        pos=point,
        quat=turned,
        size=[1.0, 1.0, 0.1],
        priority=1,  # its friction counts against objects, whatever theirs is
        condim=4,
        solref=CONTACT,
        friction=friction,
        contype=meets,
        conaffinity=0,
    )


def _add_box(spec: Any, slab: Slab, meets: int, friction: list[float]) -> None:
    """What the arm meets at a wall."""
    spec.worldbody.add_geom(
        name=slab.name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=slab.center,
        size=[length / 2.0 for length in slab.size],
        priority=1,
        condim=4,
        solref=CONTACT,
        friction=friction,
        contype=meets,
        conaffinity=ARM_KIND,
    )


def _add_object(spec: Any, row: int, item: SceneObject, friction: list[float], foot_friction: list[float]) -> None:
    half = item.shape.height / 2.0
    body = spec.worldbody.add_body(name=object_name(row), pos=[*item.position, half])
    body.add_freejoint(name=object_name(row))
    shape = {"type": mujoco.mjtGeom.mjGEOM_CYLINDER, "size": [item.shape.radius, half, 0.0], "solref": CONTACT}
    body.add_geom(
        name=object_name(row),
        mass=item.mass,
        friction=friction,
        condim=4,
        contype=OBJECT_KIND,
        conaffinity=OBJECT_MEETS,
        **shape,
    )
    body.add_geom(
        name=foot_name(row),
        mass=0.0,
        friction=foot_friction,
        priority=2,  # its friction counts on the board
        condim=6,  # rolling too, so that what has toppled comes to rest
        contype=0,
        conaffinity=PLANE,
        **shape,
    )
