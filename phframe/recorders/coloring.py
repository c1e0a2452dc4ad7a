"""Which object has which colour, in every recording alike."""

from __future__ import annotations

from collections.abc import Mapping

from phframe.core import Condition, Scene, State
from phframe.pushing import PushDecision
from phframe.recorders import palette


def components_of(decision: PushDecision) -> dict[str, int]:
    """The component of each member, by id; empty where there are none."""
    if decision.labels is None:
        return {}
    return {member: int(label) for member, label in zip(decision.members, decision.labels, strict=True)}


def object_color(scene: Scene, object_id: str, state: State, components: Mapping[str, int]) -> palette.Color:
    """By what became of an object, then whether it is the target, then its component."""
    fallen = palette.fallen_color(condition_shown(scene, object_id, state))
    if fallen is not None:
        return fallen
    if object_id == scene.target:
        return palette.TARGET
    return palette.component_color(components[object_id]) if object_id in components else palette.OBJECT


def condition_shown(scene: Scene, object_id: str, state: State) -> Condition:
    """What became of an object; one that is held did not fall."""
    return Condition.UPRIGHT if object_id == state.held else state.conditions[scene.index(object_id)]
