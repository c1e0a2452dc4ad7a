"""The arm in 3D and from the top: logged once, then only moved."""

from __future__ import annotations

import numpy as np
import rerun as rr

from phframe.core import ArmShape, FloatArray
from phframe.recorders import palette
from phframe.recorders.arm_bodies import ArmBodies, parts_of
from phframe.recorders.filling import filling
from phframe.recorders.frames import Frames, changes, quaternions_xyzw
from phframe.recorders.solid_entities import solid
from phframe.recorders.stream import Stream

FILLING_LINES = 8


def log_arm(stream: Stream, arm: ArmShape, bodies: ArmBodies) -> None:
    """The shape of every body in its own frame, and of every outline, fingers closed, in that of the fingertip."""
    for body in bodies.bodies:
        for piece in body.pieces:
            stream.keep(f"{_body(body.name)}/{rr.escape_entity_path_part(piece.name)}", solid(piece.shape, piece.color))
    for part, outlines in parts_of(arm).items():
        color = palette.FINGER if outlines[0].side else palette.LINK
        fills = [filling(outline.vertices, FILLING_LINES) for outline in outlines]
        lines = [line for fill, _ in fills for line in fill]
        radii = [radius for fill, radius in fills for _ in fill]
        edges = [np.vstack([outline.vertices, outline.vertices[:1]]) for outline in outlines]
        stream.keep(f"{_part(part)}/fill", rr.LineStrips2D(lines, radii=radii, colors=color, draw_order=14.0))
        stream.keep(f"{_part(part)}/edge", rr.LineStrips2D(edges, radii=-0.8, colors=palette.FINGER, draw_order=15.0))


def log_motion(stream: Stream, arm: ArmShape, bodies: ArmBodies, frames: Frames, action: int) -> None:
    """Where every body is in every frame; from the top, the fingertip and the fingers."""
    for name, poses in bodies.poses(frames).items():
        moving = changes(poses)
        columns = rr.Transform3D.columns(translation=poses[moving, :3], quaternion=quaternions_xyzw(poses[moving]))
        stream.put_many(_body(name), frames.times[moving], action, columns)
    moving = changes(frames.grippers)
    place, yaw = frames.grippers[moving, :2], frames.grippers[moving, 2]
    # At height 0: the viewer draws what stands higher in a 2D view aside from where it is.
    flat = np.column_stack([place, np.zeros(len(place))])
    columns = rr.Transform3D.columns(translation=flat, quaternion=_about_vertical(yaw))
    stream.put_many("top/arm", frames.times[moving], action, columns)
    for part, outlines in parts_of(arm).items():
        if side := outlines[0].side:
            _log_finger(stream, part, side * (frames.openings - arm.min_opening) / 2.0, frames, action)


def _log_finger(stream: Stream, part: str, aside: FloatArray, frames: Frames, action: int) -> None:
    moving = changes(aside)
    columns = rr.Transform3D.columns(translation=_sideways(aside[moving]))
    stream.put_many(_part(part), frames.times[moving], action, columns)


def _body(name: str) -> str:
    return f"world/arm/{rr.escape_entity_path_part(name)}"


def _part(name: str) -> str:
    return f"top/arm/{rr.escape_entity_path_part(name)}"


def _about_vertical(yaw: FloatArray) -> FloatArray:
    """Quaternions ``(m, 4)``, scalar last, of turns by ``yaw`` ``(m,)``."""
    nothing = np.zeros_like(yaw)
    return np.column_stack([nothing, nothing, np.sin(yaw / 2.0), np.cos(yaw / 2.0)])


def _sideways(distance: FloatArray) -> FloatArray:
    nothing = np.zeros_like(distance)
    return np.column_stack([nothing, distance, nothing])
