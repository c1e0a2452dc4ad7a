"""A shelf and what stands on it as a MuJoCo spec.

Board and walls are boxes for the arm and planes for the objects, which MuJoCo keeps perfectly still on planes. Each
object is a free body with two geoms of the same shape: its hull, which meets arm, walls and objects, and its foot, which
meets the board with the object's own friction. Planes have no end, and what is held outside must find none there, neither
under it nor beside it: while an object is held, foot and hull meet boxes, which end at the mouth.

MuJoCo's own convex collision is off and libccd's is used. Where a box's edge meets a cylinder, the contacts of the
former push along a face of the box instead of from the edge to the axis, by which pushed objects slip past the fingers
(MuJoCo 4.0.0, native CCD with multiple contacts; with single contacts, pressed objects chatter and sink in).
"""

from __future__ import annotations

from typing import Any

import mujoco

from phframe.backends.mujoco_.options import MujocoOptions
from phframe.backends.mujoco_.shapes import primitive
from phframe.core import Scene, SceneObject, Shelf, coulomb_with_board
from phframe.geometry.slabs import Slab, Vector, slabs

ARM_KIND, ARM_MEETS = 1, 2
"""Collision bits of the arm: it meets what has bit 2, and never itself."""
WALL, BOARD, ENDING_BOARD, ENDING_WALL = 4, 8, 16, 32
"""Collision bits of the planes that are walls and board, and of the boxes that are, which end at the mouth."""
OBJECT_KIND = ARM_MEETS
"""Collision bit of objects: they meet the arm, one another and walls; their feet meet one of the boards."""
Quaternion = tuple[float, float, float, float]


def meets(*, held: bool) -> int:
    """What an object meets besides the board: walls that end at the mouth while it is held, endless ones else."""
    return ARM_KIND | ARM_MEETS | (ENDING_WALL if held else WALL)


def shelf_spec(scene: Scene, options: MujocoOptions) -> Any:
    """The shelf with its objects, each at its place in the scene; no arm yet.

    Raises:
        UnknownShapeError: If MuJoCo has no primitive for the shape of an object.
    """
    spec = mujoco.MjSpec()
    _set_options(spec.option, options)
    _add_boards(spec, scene.shelf, options)
    _add_walls(spec, scene.shelf, options)
    for row, item in enumerate(scene.objects):
        _add_object(spec, row, item, coulomb_with_board(scene, item), options)
    return spec


def object_name(row: int) -> str:
    """What the object in a row of the scene is called in the spec; ids could clash with other names."""
    return f"object/{row}"


def foot_name(row: int) -> str:
    """What its foot is called."""
    return f"foot/{row}"


def _set_options(option: Any, options: MujocoOptions) -> None:
    option.timestep = options.step
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    cones = {"elliptic": mujoco.mjtCone.mjCONE_ELLIPTIC, "pyramidal": mujoco.mjtCone.mjCONE_PYRAMIDAL}
    option.cone, option.impratio = cones[options.cone], options.friction_firmness
    option.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET | mujoco.mjtDisableBit.mjDSBL_NATIVECCD
    if options.sleep:
        option.enableflags |= mujoco.mjtEnableBit.mjENBL_SLEEP


def _add_boards(spec: Any, shelf: Shelf, options: MujocoOptions) -> None:
    _add_plane(spec, (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0), BOARD, shelf.board_friction, options)
    _add_box(spec, slabs(shelf)[0], ENDING_BOARD, shelf.board_friction, options)


def _add_walls(spec: Any, shelf: Shelf, options: MujocoOptions) -> None:
    for wall in slabs(shelf)[1:]:
        _add_box(spec, wall, ENDING_WALL, shelf.wall_friction, options)
    depth, width, height = shelf.depth, shelf.width, shelf.height
    for point, turned in (
        ((0.0, 0.0, 0.0), (1.0, -1.0, 0.0, 0.0)),
        ((0.0, width, 0.0), (1.0, 1.0, 0.0, 0.0)),
        ((depth, 0.0, 0.0), (1.0, 0.0, -1.0, 0.0)),
        ((0.0, 0.0, height), (0.0, 1.0, 0.0, 0.0)),
    ):
        _add_plane(spec, point, turned, WALL, shelf.wall_friction, options)


def _add_plane(spec: Any, point: Vector, turned: Quaternion, bit: int, friction: float, options: MujocoOptions) -> None:
    """What objects meet at a wall or stand on; its z axis points inwards."""
    spec.worldbody.add_geom(
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        pos=point,
        quat=turned,
        size=[1.0, 1.0, 0.1],
        priority=1,  # its friction counts against objects, whatever theirs is
        condim=4,
        solref=options.contact,
        friction=options.triple(friction),
        contype=bit,
        conaffinity=0,
    )


def _add_box(spec: Any, slab: Slab, bit: int, friction: float, options: MujocoOptions) -> None:
    """What the arm, and what it holds, meets at a wall."""
    spec.worldbody.add_geom(
        name=slab.name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=slab.center,
        size=[length / 2.0 for length in slab.size],
        priority=1,
        condim=4,
        solref=options.contact,
        friction=options.triple(friction),
        contype=bit,
        conaffinity=ARM_KIND,
    )


def _add_object(spec: Any, row: int, item: SceneObject, board: float, options: MujocoOptions) -> None:
    body = spec.worldbody.add_body(name=object_name(row), pos=[*item.position, item.shape.height / 2.0])
    body.add_freejoint(name=object_name(row))
    shape = {**primitive(item.shape), "solref": options.contact}
    body.add_geom(
        name=object_name(row),
        mass=item.mass,
        friction=options.triple(options.object_friction),
        condim=4,
        contype=OBJECT_KIND,
        conaffinity=meets(held=False),
        **shape,
    )
    body.add_geom(
        name=foot_name(row),
        mass=0.0,
        friction=options.triple(board),
        priority=2,  # its friction counts on the board
        condim=6,  # rolling too, so that what has toppled comes to rest
        contype=0,
        conaffinity=BOARD,
        **shape,
    )
