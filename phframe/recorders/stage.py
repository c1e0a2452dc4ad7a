"""A scene and an arm as MuJoCo draws them: bodies that are put where they are, and no physics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import mujoco
import numpy as np

from phframe.core import BasePose, FloatArray, Scene, Shelf, State
from phframe.recorders import palette
from phframe.recorders.arm_bodies import ArmBodies
from phframe.recorders.bodies import Body, Piece, Primitive
from phframe.recorders.coloring import object_color
from phframe.recorders.object_solids import primitive_of
from phframe.recorders.shelf_look import drawn_board, drawn_walls

EDGE = 0.0015
"""Half the thickness of the shelf's edges (m)."""
SKY = (156, 167, 181), (98, 109, 123)
"""Colours above and below the horizon, between those of the shelf and of dark robots."""


class Stage:
    """What there is to be photographed.

    Args:
        scene: The scene.
        bodies: The arm.
        width: Of the pictures (pixels).
        height: Of the pictures (pixels).

    Attributes:
        model: MuJoCo's.
        data: MuJoCo's.
    """

    def __init__(self, scene: Scene, bodies: ArmBodies, width: int, height: int) -> None:
        spec = mujoco.MjSpec()
        _set_light(spec, scene.shelf, width, height)
        _add_shelf(spec, scene.shelf)
        for row, item in enumerate(scene.objects):
            piece = Piece("", primitive_of(item.shape), palette.OBJECT)
            _add_piece(spec, _add_body(spec, _object(row)), _object(row), piece)
        for body in bodies.bodies:
            _add_arm_part(spec, body)
        self._scene = scene
        self.model: Any = spec.compile()
        self.data: Any = mujoco.MjData(self.model)

    def show(self, state: State, arm: Mapping[str, FloatArray], components: Mapping[str, int]) -> None:
        """Put everything where it is, in its colour.

        Args:
            state: Of the objects.
            arm: Pose ``(7,)`` of every body of the arm, by name.
            components: Of objects, by id.
        """
        for row, object_id in enumerate(self._scene.ids):
            self._place(_object(row), state.poses[row])
            color = object_color(self._scene, object_id, state, components)
            self.model.geom(_object(row)).rgba = _rgba(color)
        for name, pose in arm.items():
            self._place(_arm(name), pose)
        mujoco.mj_forward(self.model, self.data)

    def _place(self, name: str, pose: FloatArray) -> None:
        (row,) = self.model.body(name).mocapid
        self.data.mocap_pos[row], self.data.mocap_quat[row] = pose[:3], pose[3:]


def camera(shelf: Shelf, base_pose: BasePose) -> Any:
    """From before the shelf and above into it, a little from the side on which the arm does not stand."""
    north = base_pose.y <= 0.5 * shelf.width
    seen = mujoco.MjvCamera()
    seen.lookat = [0.04 * shelf.depth, (0.48 if north else 0.52) * shelf.width, 0.02]
    seen.distance = 0.85 + 0.9 * max(shelf.depth, shelf.width)
    seen.azimuth, seen.elevation = (-36.0 if north else 36.0), -36.0
    return seen


def _set_light(spec: Any, shelf: Shelf, width: int, height: int) -> None:
    view = spec.visual
    view.global_.offwidth, view.global_.offheight = width, height
    view.headlight.ambient, view.headlight.diffuse, view.headlight.specular = [0.35] * 3, [0.35] * 3, [0.1] * 3
    view.quality.shadowsize = 1024
    view.map.znear, view.map.zfar = 0.01, 50.0
    sky = spec.add_texture(
        name="sky", type=mujoco.mjtTexture.mjTEXTURE_SKYBOX, builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT
    )
    sky.rgb1, sky.rgb2 = (np.array(color) / 255.0 for color in SKY)
    sky.width = sky.height = 256
    # Along the side walls, so that they shade nothing.
    lamp = spec.worldbody.add_light(pos=[-0.4, shelf.width / 2.0, 2.0], dir=[0.25, 0.0, -1.0], diffuse=[0.5] * 3)
    lamp.type = mujoco.mjtLightType.mjLIGHT_DIRECTIONAL


def _add_shelf(spec: Any, shelf: Shelf) -> None:
    depth, width, height = shelf.depth, shelf.width, shelf.height
    low, high = drawn_board(shelf)
    _add_box(spec, low, high, palette.BOARD)
    for low, high in drawn_walls(shelf):
        _add_box(spec, low, high, palette.WALL)
    corners = [(x, y) for x in (0.0, depth) for y in (0.0, width)]
    for x, y in corners:
        _add_box(spec, (x - EDGE, y - EDGE, 0.0), (x + EDGE, y + EDGE, height), palette.EDGE)
    for x, z in ((0.0, 0.0), (depth, 0.0), (depth, height)):  # none over the mouth: it would shade the board
        _add_box(spec, (x - EDGE, 0.0, z - EDGE), (x + EDGE, width, z + EDGE), palette.EDGE)
    for y, z in ((0.0, 0.0), (0.0, height), (width, 0.0), (width, height)):
        _add_box(spec, (0.0, y - EDGE, z - EDGE), (depth, y + EDGE, z + EDGE), palette.EDGE)


def _add_box(spec: Any, low: Iterable[float], high: Iterable[float], color: palette.Color) -> None:
    a, b = np.array(list(low)), np.array(list(high))
    geom = spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, pos=(a + b) / 2.0, size=(b - a) / 2.0)
    geom.rgba = _rgba(color)


def _add_body(spec: Any, name: str) -> Any:
    return spec.worldbody.add_body(name=name, mocap=True)


def _add_arm_part(spec: Any, body: Body) -> None:
    part = _add_body(spec, _arm(body.name))
    for piece in body.pieces:
        _add_piece(spec, part, f"{_arm(body.name)}/{piece.name}", piece)


def _add_piece(spec: Any, part: Any, name: str, piece: Piece) -> None:
    shape, kinds = piece.shape, mujoco.mjtGeom
    if isinstance(shape, Primitive):
        kind = {"box": kinds.mjGEOM_BOX, "cylinder": kinds.mjGEOM_CYLINDER, "sphere": kinds.mjGEOM_SPHERE}[shape.kind]
        geom = part.add_geom(name=name, type=kind, pos=shape.pose[:3], quat=shape.pose[3:])
        geom.size = _half_size(shape)
    else:
        # Of a shell, since a surface need not be closed; nothing is weighed here.
        mesh = spec.add_mesh(name=name, inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL)
        mesh.uservert, mesh.userface = shape.vertices.ravel(), shape.triangles.ravel()
        geom = part.add_geom(name=name, type=kinds.mjGEOM_MESH, meshname=name)
    geom.contype = geom.conaffinity = 0
    geom.rgba = _rgba(piece.color)


def _half_size(shape: Primitive) -> list[float]:
    """As MuJoCo wants it: half lengths, or a radius and half a length."""
    match shape.kind:
        case "box":
            return [length / 2.0 for length in shape.size]
        case "cylinder":
            return [shape.size[0], shape.size[1] / 2.0, 0.0]
        case _:
            return [shape.size[0], 0.0, 0.0]


def _object(row: int) -> str:
    return f"object/{row}"


def _arm(name: str) -> str:
    return f"arm/{name}"


def _rgba(color: palette.Color) -> FloatArray:
    return np.array(color) / 255.0
