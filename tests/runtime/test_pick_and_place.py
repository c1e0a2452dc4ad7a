"""A plan of several kinds of actions: take blue out of the way, put it down elsewhere, take red."""

from __future__ import annotations

import math

import numpy as np
import pytest

from phframe.core import (
    ROOT,
    Action,
    ActionKind,
    Attempt,
    Contacts,
    Cylinder,
    GripperPath,
    Loop,
    Options,
    Phase,
    PhaseRule,
    Plan,
    Planner,
    Scene,
    SceneObject,
    SearchTree,
    Shelf,
    Status,
    Task,
)
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.world import WorldSpec
from tests.runtime.worlds import run

RED, BLUE = (0.45, 0.3), (0.25, 0.3)
ELSEWHERE = (0.3, 0.15)
SCENE = Scene(
    "blue before red",
    Shelf(0.6, 0.6),
    (SceneObject("red", Cylinder(0.03), RED), SceneObject("blue", Cylinder(0.03), BLUE)),
    "red",
)
OPEN, OUT, WITHIN = 0.075, -0.13, 0.1
"""Opening of the fingers (m), and where the fingertip is outside the shelf, and as it carries blue across (m)."""


def grasp(name: str, at: tuple[float, float], drawn_to: float = OUT) -> Action:
    """Straight in, close, straight back."""
    legs = (Phase.REACH, Phase.GRASP, Phase.WITHDRAW)
    (x, y), openings = at, (OPEN, 0.0, 0.0)
    rules = {leg: PhaseRule(0.25, each, Contacts.MANIPULAND) for leg, each in zip(legs, openings, strict=True)}
    poses = np.array([[OUT - 0.1, y, 0.0], [x + 0.02, y, 0.0], [x + 0.02, y, 0.0], [drawn_to, y, 0.0]])
    return Action(f"grasp {name}", GripperPath(poses, legs, rules, name), (name,), ActionKind.GRASP)


def place(name: str, begin: tuple[float, float], at: tuple[float, float]) -> Action:
    """Across, in, open, straight out."""
    legs = (Phase.PLACE, Phase.PLACE, Phase.RELEASE, Phase.RETREAT)
    rules = {leg: PhaseRule(0.2, 0.0, Contacts.MANIPULAND) for leg in legs}
    rules |= {leg: PhaseRule(0.2, OPEN, Contacts.MANIPULAND) for leg in (Phase.RELEASE, Phase.RETREAT)}
    y, tip = at[1], at[0] + 0.02
    poses = np.array([[WITHIN, begin[1], 0.0], [WITHIN, y, 0.0], [tip, y, 0.0], [tip, y, 0.0], [OUT, y, 0.0]])
    return Action(f"place {name}", GripperPath(poses, legs, rules, name), (name,), ActionKind.PLACE)


class PickAndPlace(Planner[Options]):
    """Knows what to do in this scene."""

    def search(self, task: Task) -> Plan:
        tree, node = SearchTree(task.start), ROOT
        actions = [grasp("blue", BLUE, WITHIN), place("blue", BLUE, ELSEWHERE), grasp("red", RED)]
        placed = math.dist(task.start.positions[SCENE.index("blue")], ELSEWHERE) < 0.05
        done = 2 if placed else 1 if task.start.held == "blue" else 0
        for action in actions[done:]:
            made = task.apply(tree[node].state, action)
            node = tree.child(node, action, made)
        outcome = task.goal.assess(task.scene, made.state, Attempt(action, made.motion))
        return tree.plan(node, outcome.status, outcome.reason)


ENGINES = [
    "pymunk",
    pytest.param("mujoco", marks=[pytest.mark.needs_mujoco, pytest.mark.slow]),
    pytest.param("pybullet", marks=[pytest.mark.needs_pybullet, pytest.mark.slow]),
]


@pytest.mark.parametrize("backend", ENGINES)
def test_every_action_is_carried_out_in_order(backend: str) -> None:
    pytest.importorskip(backend)
    spec = WorldSpec(SCENE, backend)
    episode = run(ExecutionWorld(spec), PickAndPlace(Options()), planning=spec)
    assert [step.action.name for step in episode.steps] == ["grasp blue", "place blue", "grasp red"]
    assert [step.after.held for step in episode.steps] == ["blue", None, "red"]
    assert (episode.status, episode.reason, episode.replans, episode.clean) == (Status.RETRIEVED, "", 0, True)
    assert (episode.pushes, episode.count(ActionKind.GRASP), episode.count(ActionKind.PLACE)) == (0, 2, 1)
    stands = episode.final_state.positions[SCENE.index("blue")]
    assert math.dist(stands, ELSEWHERE) < 0.02, "blue stands where it was put down"


@pytest.mark.slow
@pytest.mark.needs_mujoco
def test_plans_of_another_engine_go_on_with_what_is_in_the_hand() -> None:
    pytest.importorskip("mujoco")
    world = ExecutionWorld(WorldSpec(SCENE, "mujoco"))
    episode = run(world, PickAndPlace(Options()), planning=WorldSpec(SCENE), loop=Loop(tolerance=1e-6))
    assert [step.action.name for step in episode.steps][:3] == ["grasp blue", "place blue", "grasp red"]
    assert episode.replans > 0
    assert episode.plans[1].tree is not None
    assert episode.plans[1].tree.nodes[0].state.held == "blue"
    assert episode.status is Status.RETRIEVED
