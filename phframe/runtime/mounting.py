"""Which arm carries a run out, and where its base stands: what its options leave to the scene is chosen before anything else."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from phframe.core import ArmModel, BasePose, RunSpec, Scene
from phframe.registry import Kind, create, identify, refuse_stored_code
from phframe.runtime.scenes import find_scene

Told = Callable[[int, int], None]
"""Is told how many of how many choices have been looked at."""


def arm_in(
    scene: Scene, arm: Any, options: Mapping[str, Any], told: Told = lambda done, of: None
) -> tuple[ArmModel[Any], BasePose]:
    """An arm, and where its base stands: where its options have it, else the scene, else where it has itself.

    Args:
        scene: The scene.
        arm: A registered name, a class in a file, a class or an object.
        options: Of the arm, by key.
        told: Is told how far the choice is, where there is one.

    Raises:
        PhframeError: If the arm or its options cannot be used.
    """
    made: ArmModel[Any] = create(Kind.ARM, arm, options).mounted(scene, told)
    return made, made.mount or _named(scene, arm) or made.default_base_pose(scene.shelf)


def mounted(spec: RunSpec, told: Told = lambda done, of: None) -> RunSpec:
    """The run with what its arms' options leave to the scene chosen, so that it can be repeated without choosing again.

    Raises:
        PhframeError: If the scene, an arm or its options cannot be used.
    """
    changed = {part: found for part in ("arm", "plan_arm") if (found := _chosen(spec, part, told)) is not None}
    options = {**spec.options, **{part: given for part, (_, given) in changed.items()}}
    return replace(spec, options=options, **{part: arm for part, (arm, _) in changed.items()}) if changed else spec


def _chosen(spec: RunSpec, part: str, told: Told) -> tuple[Any, dict[str, Any]] | None:
    """An arm and its options, once they are chosen; None: they are as they were given."""
    arm, given = getattr(spec, part), spec.options.get(part, {})
    refuse_stored_code(part, arm)
    if arm is None or (isinstance(arm, str | type) and "mount" not in given):
        return None
    before: ArmModel[Any] = create(Kind.ARM, arm, given)
    after = before.mounted(find_scene(spec.scene, spec.options.get("scenes")), told)
    if after is before:
        return None
    if not isinstance(arm, str | type):
        return after, {}
    name, options = identify(Kind.ARM, arm, given)
    old, new = (each.options.model_dump(mode="json") for each in (before, after))
    return name, {**options, **{key: value for key, value in new.items() if value != old[key]}}


def _named(scene: Scene, arm: Any) -> BasePose | None:
    """Where the scene has the arm stand, if it names it; a class or an object bears the name it is registered by."""
    name, _ = identify(Kind.ARM, arm)
    return scene.base_poses.get(name) if isinstance(name, str) else None
