"""One scene for people, and as JSON."""

from __future__ import annotations

import math
from typing import Any

from rich.console import Group, RenderableType
from rich.text import Text

from phframe.cli.listing_table import table
from phframe.core import Scene, SceneObject
from phframe.pushing import Corridor
from phframe.recorders.scene_overview import SceneOverview
from phframe.scenes.writer import scene_content

FORMAT = 1
"""Of the JSON object."""


def overview_as_json(overview: SceneOverview) -> dict[str, Any]:
    """One object: ``format``, the ``scene`` as in its file, its ``coverage``, and its ``corridor``."""
    return {
        "format": FORMAT,
        "scene": scene_content(overview.scene),
        "coverage": overview.scene.coverage,
        "corridor": _corridor_as_json(overview),
    }


def overview_as_table(overview: SceneOverview) -> RenderableType:
    """What the scene is in three sentences, and its objects in a table."""
    scene = overview.scene
    heading = Text.assemble((scene.name, "bold"), f"\n{_shelf(scene)}\n{_target(scene)}\n{_corridor(overview)}\n")
    rows = table("id", "x (m)", "y (m)", "size (m)", "")
    for item in scene.objects:
        rows.add_row(item.id, *(f"{v:.4f}" for v in item.position), _size(item), _part(overview, item))
    return Group(heading, rows)


def _corridor_as_json(overview: SceneOverview) -> dict[str, Any]:
    corridor, members = overview.corridor, list(overview.members)
    if isinstance(corridor, Corridor):
        angle, beside, reason = corridor.angle, corridor.beside, ""
    else:
        angle, beside, reason = None, None, corridor.reason
    return {"half_width": overview.half_width, "angle": angle, "beside": beside, "members": members, "reason": reason}


def _shelf(scene: Scene) -> str:
    shelf = scene.shelf
    return (
        f"shelf: {shelf.depth:g} m deep, {shelf.width:g} m wide, {shelf.height:g} m high; "
        f"{len(scene.objects)} objects cover {scene.coverage:.1%} of its board"
    )


def _target(scene: Scene) -> str:
    target, shelf = scene.objects[scene.target_index], scene.shelf
    x, y = target.position
    side, distance = ("south", y) if y <= shelf.width / 2.0 else ("north", shelf.width - y)
    return f"target: {target.id}, its centre {x:.3f} m from the mouth and {distance:.3f} m from the {side} wall"


def _corridor(overview: SceneOverview) -> str:
    corridor = overview.corridor
    if not isinstance(corridor, Corridor):
        return f"corridor: none, since {corridor.reason}"
    way = "straight" if corridor.beside is None else f"at {math.degrees(corridor.angle):.1f} degrees"
    return f"corridor: {way}, half-width {overview.half_width:g} m, obstacles in it: {len(overview.members)}"


def _size(item: SceneObject) -> str:
    figures = ", ".join(f"{name} {value:g}" for name, value in item.shape.figures().items())
    return f"{item.shape.kind}, {figures}"


def _part(overview: SceneOverview, item: SceneObject) -> str:
    if item.id == overview.scene.target:
        return "target"
    return "in the corridor" if item.id in overview.members else ""
