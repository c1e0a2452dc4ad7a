"""Scenes, and plans of sure for them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from phframe.core import (
    ROOT,
    Action,
    ActionKind,
    Condition,
    ExploredTree,
    Plan,
    Scene,
    SearchNode,
    State,
    Stop,
    Transition,
)
from phframe.core.particle import Apply
from phframe.planners.sure import Sure, SureOptions
from phframe.pushing import harm
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import scene_of
from tests.pushing.worlds import task_in

ONE = scene_of((0.45, 0.3), (0.25, 0.3), (0.25, 0.365), (0.25, 0.235), (0.3, 0.17), (0.3, 0.43))
"""What stands before the target leaves no way past it at any angle: one push is needed."""
AT_WALL = tuple(scene_of((0.45, y)) for y in (0.032, 0.568))
"""Alone, 2 mm from a side wall: no finger fits between."""
ELSEWHERE = {"object_friction": 0.35, "arm_friction": 0.45, "standing_radius": 2.0 / 3.0, "arm_acceleration": 10.0}
"""An engine that differs a little from the one that is planned in."""
HARD = "random/1"
SOME = tuple(find_scene(name) for name in ("vieira/basic", "vieira/example-05", "papallas/s02", "papallas/s09"))
CONFIRMED = ("vieira/basic", "vieira/example-05", "papallas/s02", "papallas/s09")


class Counted:
    """What applies actions, counting them by state and path.

    Args:
        apply: What does.
    """

    def __init__(self, apply: Apply) -> None:
        self._apply = apply
        self.asked: list[tuple[bytes, bytes]] = []

    def __call__(self, state: State, action: Action, stop: Stop | None = None) -> Transition:
        self.asked.append((state.poses.tobytes(), action.path.poses.tobytes()))
        return self._apply(state, action, stop)


def planned(scene: Scene, options: dict[str, Any] | None = None, start: State | None = None, **more: Any) -> Plan:
    """A plan in pymunk."""
    with PlanningWorld(WorldSpec(scene)) as world:
        return Sure(SureOptions.parse(options or {}, "sure")).plan(task_in(world, start, **more))


def tree_of(plan: Plan) -> ExploredTree:
    assert plan.tree is not None
    return plan.tree


def pushes_of(plan: Plan) -> list[SearchNode]:
    """All that were tried."""
    return [node for node in tree_of(plan).nodes[1:] if node.action and node.action.kind is ActionKind.PUSH]


def grasps_of(plan: Plan) -> list[SearchNode]:
    return [node for node in tree_of(plan).nodes[1:] if node.action and node.action.kind is ActionKind.GRASP]


def kinds(plan: Plan) -> list[ActionKind]:
    return [action.kind for action in plan.actions]


def assert_told(scene: Scene, plan: Plan) -> None:
    """Every action of the path does no harm, and every node beside it says why it was left."""
    tree = tree_of(plan)
    before = tree.nodes[ROOT].state
    for node in tree.path:
        assert node.motion is not None
        assert node.action is not None
        moved = None if node.action.kind is ActionKind.GRASP or scene.target in node.action.moves else 0.02
        assert not harm(scene, before, Transition(node.state, node.motion), moved)
        before = node.state
    for row, node in enumerate(tree.nodes):
        assert bool(node.closed) is not (row == ROOT or node in tree.path)


def topples_first(made: Transition, action: Action) -> Transition:
    """Every push topples what it means to move."""
    if action.kind is not ActionKind.PUSH:
        return made
    fallen = list(made.state.conditions)
    fallen[1] = Condition.TOPPLED
    return replace(made, state=replace(made.state, conditions=tuple(fallen)))
