"""The objects in 3D and from the top: logged once as shapes, then only moved and coloured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr

from phframe.core import Condition, Scene, State
from phframe.recorders import palette
from phframe.recorders.coloring import condition_shown, object_color
from phframe.recorders.frames import Frames, changes, quaternions_xyzw
from phframe.recorders.object_solids import disc_radius, primitive_of
from phframe.recorders.solid_entities import recolored, solid
from phframe.recorders.stream import Stream

DISCS = "top/objects"
NAMES = "top/names"
RIMS = "top/rims"
RINGS = "top/marks"
RING_GAP = 0.0035
"""Between an object and the ring around it (m)."""
RIM = 0.0022
"""Half the thickness of an object's rim (m): it has the colour, and what lies within it is dark enough for the name."""


def log_objects(stream: Stream, scene: Scene) -> None:
    """The shapes of all objects, at the origin of their own frame."""
    for item in scene.objects:
        stream.keep(_entity(item.id), solid(primitive_of(item.shape)))
    radii = np.array([disc_radius(item.shape) for item in scene.objects])
    stream.keep(DISCS, rr.Points2D.from_fields(radii=radii, show_labels=False, draw_order=10.0))
    rims = np.column_stack([radii, radii]) - RIM
    stream.keep(RIMS, rr.Ellipses2D.from_fields(half_sizes=rims, line_radii=[RIM], draw_order=11.0))
    names = rr.Points2D.from_fields(labels=short_names(scene), show_labels=True, colors=palette.TEXT, radii=0.0)
    stream.keep(NAMES, names)
    stream.keep(RINGS, rr.Ellipses2D.from_fields(line_radii=[-1.2], draw_order=9.0))


def log_motion(stream: Stream, scene: Scene, frames: Frames, action: int) -> None:
    """Where all objects are in every frame."""
    for index, item in enumerate(scene.objects):
        moving = changes(frames.poses[:, index])
        poses = frames.poses[moving, index]
        columns = rr.Transform3D.columns(translation=poses[:, :3], quaternion=quaternions_xyzw(poses))
        stream.put_many(_entity(item.id), frames.times[moving], action, columns)
    moving = changes(frames.poses)
    centers = frames.poses[moving, :, :2].reshape(-1, 2)
    lengths = [len(scene.objects)] * len(moving)
    for entity in (DISCS, NAMES):
        points = rr.Points2D.columns(positions=centers).partition(lengths)
        stream.put_many(entity, frames.times[moving], action, points)
    for entity in (RIMS, RINGS):
        ellipses = rr.Ellipses2D.columns(centers=centers).partition(lengths)
        stream.put_many(entity, frames.times[moving], action, ellipses)


def log_colors(
    stream: Stream, scene: Scene, state: State, components: Mapping[str, int], chosen: Sequence[str]
) -> None:
    """Colour objects by component, the target and what fell in their own; a ring around the chosen and the fallen."""
    colors = [object_color(scene, object_id, state, components) for object_id in scene.ids]
    for item, color in zip(scene.objects, colors, strict=True):
        stream.put(_entity(item.id), recolored(primitive_of(item.shape), color))
    stream.put(DISCS, rr.Points2D.from_fields(colors=[palette.shaded(color) for color in colors]))
    stream.put(RIMS, rr.Ellipses2D.from_fields(colors=colors))
    rings = [_ring(object_id, condition_shown(scene, object_id, state), chosen) for object_id in scene.ids]
    # An object that is not marked has a ring of no size, hidden under its disc: 2D lines are never transparent.
    sizes = [
        disc_radius(item.shape) + RING_GAP if ring else 0.0 for item, ring in zip(scene.objects, rings, strict=True)
    ]
    shown = [ring or palette.OBJECT for ring in rings]
    stream.put(RINGS, rr.Ellipses2D.from_fields(half_sizes=np.column_stack([sizes, sizes]), colors=shown))


def short_names(scene: Scene) -> list[str]:
    """The ids without what they all begin with, such as ``7`` for ``object_7``, so that they fit into a disc."""
    others = [object_id for object_id in scene.ids if object_id != scene.target]
    heads = {object_id.rpartition("_")[0] for object_id in others}
    common = f"{heads.pop()}_" if len(heads) == 1 else ""
    return ["target" if i == scene.target else i.removeprefix(common) for i in scene.ids]


def _entity(object_id: str) -> str:
    return f"world/objects/{rr.escape_entity_path_part(object_id)}"


def _ring(object_id: str, condition: Condition, chosen: Sequence[str]) -> palette.Color | None:
    return palette.fallen_color(condition) or (palette.CHOSEN if object_id in chosen else None)
