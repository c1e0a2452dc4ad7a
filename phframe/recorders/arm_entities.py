"""The arm in 3D, its outlines made solid, and from the top: logged once, then only moved."""

from __future__ import annotations

import numpy as np
import rerun as rr

from phframe.core import ArmShape, FloatArray, Outline
from phframe.recorders import palette
from phframe.recorders.filling import filling
from phframe.recorders.frames import Frames, changes
from phframe.recorders.stream import Stream

FILLING_LINES = 8


def log_arm(stream: Stream, arm: ArmShape) -> None:
    """The shape of every part, fingers closed, in the frame of the fingertip."""
    for outline in arm.closed:
        color = palette.FINGER if outline.side else palette.LINK
        stream.keep(f"world/{_part(outline)}", _prism(outline, color))
        edge = np.vstack([outline.vertices, outline.vertices[:1]])
        fill, radius = filling(outline.vertices, FILLING_LINES)
        stream.keep(f"top/{_part(outline)}/fill", rr.LineStrips2D(fill, radii=radius, colors=color, draw_order=14.0))
        stream.keep(
            f"top/{_part(outline)}/edge", rr.LineStrips2D([edge], radii=-0.8, colors=palette.FINGER, draw_order=15.0)
        )


def log_motion(stream: Stream, arm: ArmShape, frames: Frames, action: int) -> None:
    """Where the fingertip and the fingers are in every frame."""
    moving = changes(frames.grippers)
    place, yaw = frames.grippers[moving, :2], frames.grippers[moving, 2]
    # At height 0 from the top: the viewer draws what stands higher in a 2D view aside from where it is.
    for view, height in (("world", arm.height), ("top", 0.0)):
        raised = np.column_stack([place, np.full(len(place), height)])
        columns = rr.Transform3D.columns(translation=raised, quaternion=_about_vertical(yaw))
        stream.put_many(f"{view}/arm", frames.times[moving], action, columns)
    for outline in arm.closed:
        if outline.side:
            _log_finger(stream, outline, frames.openings - arm.min_opening, frames, action)


def _log_finger(stream: Stream, outline: Outline, opened: FloatArray, frames: Frames, action: int) -> None:
    moving = changes(opened)
    aside = _sideways(outline.side * opened[moving] / 2.0)
    for view in ("world", "top"):
        columns = rr.Transform3D.columns(translation=aside)
        stream.put_many(f"{view}/{_part(outline)}", frames.times[moving], action, columns)


def _part(outline: Outline) -> str:
    return f"arm/{rr.escape_entity_path_part(outline.part)}"


def _about_vertical(yaw: FloatArray) -> FloatArray:
    """Quaternions ``(m, 4)``, scalar last, of turns by ``yaw`` ``(m,)``."""
    nothing = np.zeros_like(yaw)
    return np.column_stack([nothing, nothing, np.sin(yaw / 2.0), np.cos(yaw / 2.0)])


def _sideways(distance: FloatArray) -> FloatArray:
    nothing = np.zeros_like(distance)
    return np.column_stack([nothing, distance, nothing])


def _prism(outline: Outline, color: palette.Color) -> rr.Mesh3D:
    """An outline made solid, from its bottom to its top."""
    points = outline.vertices
    low, high = (np.column_stack([points, np.full(len(points), z)]) for z in (outline.bottom, outline.top))
    quads = np.stack([low, np.roll(low, -1, axis=0), np.roll(high, -1, axis=0), high], axis=1)
    faces = [high, low[::-1], *quads]
    return _flat_shaded(faces, color)


def _flat_shaded(faces: list[FloatArray], color: palette.Color) -> rr.Mesh3D:
    """A mesh of convex faces ``(k, 3)``, counter-clockwise seen from outside, each with corners of its own."""
    normals = [np.repeat(_normal(face)[None], len(face), axis=0) for face in faces]
    starts = np.cumsum([0, *(len(face) for face in faces[:-1])])
    fans = [start + _fan(len(face)) for start, face in zip(starts, faces, strict=True)]
    return rr.Mesh3D(
        vertex_positions=np.vstack(faces),
        vertex_normals=np.vstack(normals),
        triangle_indices=np.vstack(fans),
        albedo_factor=color,
    )


def _normal(face: FloatArray) -> FloatArray:
    across = np.cross(face[1] - face[0], face[2] - face[0])
    return np.asarray(across / np.linalg.norm(across))


def _fan(corners: int) -> np.ndarray[tuple[int, int], np.dtype[np.int64]]:
    """Triangles ``(k - 2, 3)`` that cover a convex polygon of ``k`` corners."""
    second = np.arange(1, corners - 1)
    return np.column_stack([np.zeros_like(second), second, second + 1])
