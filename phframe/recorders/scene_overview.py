"""What can be said of a scene before anything is done: its corridor, and which obstacles are in it."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.core import Infeasible, Scene
from phframe.pushing import Corridor, RetrieveOptions, find_corridor


@dataclass(frozen=True, slots=True)
class SceneOverview:
    """A scene as it is written, and its corridor.

    Attributes:
        scene: The scene.
        half_width: Of the corridor, w (m).
        corridor: To the target; or why there is none.
        members: Ids of the obstacles in it.
    """

    scene: Scene
    half_width: float
    corridor: Corridor | Infeasible
    members: tuple[str, ...]


def scene_overview(scene: Scene) -> SceneOverview:
    """The overview of a scene, with the corridor that must be empty for its target to count as cleared (Algorithm 1)."""
    half_width, positions = RetrieveOptions().half_width, scene.initial_state().positions
    corridor = find_corridor(positions[scene.target_index], scene.shelf, half_width)
    if isinstance(corridor, Infeasible):
        return SceneOverview(scene, half_width, corridor, ())
    inside = corridor.contains(positions)
    members = (each for each, within in zip(scene.ids, inside, strict=True) if within and each != scene.target)
    return SceneOverview(scene, half_width, corridor, tuple(members))
