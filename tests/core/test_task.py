"""Tasks keep to their budget and keep accounts; planners turn what is spent into a result."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pytest

from phframe.core import (
    Action,
    ArmShape,
    Assessment,
    Attempt,
    Budget,
    BudgetExceededError,
    Contacts,
    Cylinder,
    ExploredTree,
    Goal,
    GripperPath,
    Motion,
    Options,
    Particle,
    Phase,
    PhaseRule,
    Plan,
    Planner,
    Scene,
    SceneObject,
    SearchNode,
    Shelf,
    SimulationDivergedError,
    State,
    Status,
    Stop,
    Task,
    Transition,
)
from phframe.core.particle import Apply
from phframe.topology.single_linkage import SingleLinkage

SCENE = Scene("one", Shelf(0.6, 0.6), (SceneObject("t", Cylinder(0.03), (0.3, 0.3)),), "t")
START = SCENE.initial_state()
PATH = GripperPath(np.zeros((2, 3)), (Phase.INSERT,), {Phase.INSERT: PhaseRule(0.2, 0.0, Contacts.OBJECTS)})
ACTION = Action("in", PATH)


class Patience(Goal[Options]):
    """Nothing is to be done."""

    def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        return Assessment(Status.ACHIEVED)


def stays(state: State, _action: Action, _stop: Stop | None = None) -> Transition:
    return Transition(state, Motion(1.0, followed=1.0))


def task(**more: Any) -> Task:
    parts: dict[str, Any] = {
        "scene": SCENE,
        "start": START,
        "goal": Patience(Options()),
        "arm": ArmShape((), 0.12, 0.018, 0.08),
        "topology": SingleLinkage(Options()),
        "apply": stays,
        "rng": np.random.default_rng(0),
    }
    return Task(**{**parts, **more})


class Busy(Planner[Options]):
    """Simulates for ever, and offers a plan after ten actions."""

    def search(self, task: Task) -> Plan:
        for done in range(10**6):
            task.apply(task.start, ACTION)
            if done == 9:
                task.offer(Plan(Status.CLEARED, "cleared after ten"))
        raise AssertionError("the budget never ran out")


def test_simulations_end_exactly_at_the_limit() -> None:
    limited = task(budget=Budget(simulations=3))
    for _ in range(3):
        limited.apply(START, ACTION)
    with pytest.raises(BudgetExceededError, match="the budget of 3 simulated actions is used up"):
        limited.apply(START, ACTION)
    assert limited.cost.simulated_actions == 3


def test_many_that_would_overrun_are_not_begun_without_workers_either() -> None:
    limited = task(budget=Budget(simulations=3))
    assert len(limited.apply_many([(START, ACTION)] * 2)) == 2
    with pytest.raises(BudgetExceededError):
        limited.apply_many([(START, ACTION)] * 2)
    assert limited.cost.simulated_actions == 2


def test_workers_that_would_overrun_are_not_started() -> None:
    asked = []

    def many(pairs: Sequence[tuple[State, Action]], _stop: Stop | None) -> Iterable[Transition]:
        asked.append(len(pairs))
        return [stays(*pair) for pair in pairs]

    limited = task(budget=Budget(simulations=3), apply_many=many)
    assert len(limited.apply_many([(START, ACTION)] * 2)) == 2
    with pytest.raises(BudgetExceededError):
        limited.apply_many([(START, ACTION)] * 2)
    assert asked == [2]
    assert limited.cost.simulated_actions == 2


def test_time_ends_before_the_next_simulation() -> None:
    limited = task(budget=Budget(seconds=0.01))
    time.sleep(0.02)
    with pytest.raises(BudgetExceededError, match=r"the time limit of 0\.01 s is used up"):
        limited.apply(START, ACTION)
    assert limited.cost.simulated_actions == 0


def test_costs_are_charged_by_kind() -> None:
    def slowly(state: State, action: Action, _stop: Stop | None) -> Transition:
        time.sleep(0.01)
        return stays(state, action)

    charged = task(apply=slowly)
    charged.apply(START, ACTION)
    charged.diagram(np.zeros((3, 2)))
    charged.components(np.zeros((3, 2)), 0.1)
    cost = charged.cost
    assert cost.simulation >= 0.01
    assert cost.topology > 0.0
    assert cost.total >= cost.simulation + cost.topology
    assert cost.simulated_actions == 1


def test_a_failed_simulation_is_charged_too() -> None:
    def diverges(_state: State, _action: Action, _stop: Stop | None) -> Transition:
        raise SimulationDivergedError("an object moves at 1e9 m/s")

    charged = task(apply=diverges)
    with pytest.raises(SimulationDivergedError):
        charged.apply(START, ACTION)
    assert charged.cost.simulated_actions == 1


@pytest.mark.parametrize(
    ("limit", "status", "reason"),
    [(5, Status.TIMEOUT, "the budget of 5 simulated actions is used up"), (15, Status.CLEARED, "cleared after ten")],
    ids=["nothing offered", "a plan offered"],
)
def test_a_spent_budget_is_a_result(limit: int, status: Status, reason: str) -> None:
    plan = Busy(Options()).plan(task(budget=Budget(simulations=limit)))
    assert (plan.status, plan.reason) == (status, reason)
    assert plan.cost.simulated_actions == limit


def test_a_diverged_simulation_is_a_result() -> None:
    def diverges(_state: State, _action: Action, _stop: Stop | None) -> Transition:
        raise SimulationDivergedError("an object moves at 1e9 m/s")

    plan = Busy(Options()).plan(task(apply=diverges))
    assert (plan.status, plan.reason, plan.succeeded) == (Status.FAILED, "an object moves at 1e9 m/s", False)


def test_the_topology_engine_is_asked() -> None:
    points = np.array([[0.0, 0.0], [0.1, 0.0], [0.5, 0.0]])
    assert task().components(points, 0.2).tolist() == [0, 0, 1]
    np.testing.assert_allclose(task().diagram(points).finite_deaths, [0.1, 0.4], rtol=1e-6)


def moves(by: float) -> Apply:
    """An engine in which every action moves the target deeper by so much (m)."""

    def apply(state: State, _action: Action, _stop: Stop | None = None) -> Transition:
        poses = state.poses.copy()
        poses[0, 0] += by
        return Transition(State(poses, state.conditions), Motion(1.0))

    return apply


def test_what_is_confirmed_comes_from_the_engine_that_executes() -> None:
    both = task(apply=moves(0.01), confirm=moves(0.02))
    assert both.confirms
    assert both.confirm(START, ACTION) == moves(0.02)(START, ACTION, None)
    assert both.apply(START, ACTION) == moves(0.01)(START, ACTION, None)


def test_without_another_engine_the_planning_world_confirms() -> None:
    alone = task(apply=moves(0.01))
    assert not alone.confirms
    assert alone.confirm(START, ACTION) == alone.apply(START, ACTION)


def test_what_is_confirmed_or_rehearsed_counts_as_simulated_and_keeps_to_the_budget() -> None:
    def sample(number: int) -> list[Particle]:
        return [Particle(START, moves(0.01 * each)) for each in range(number)]

    limited = task(budget=Budget(simulations=3), confirm=slow(moves(0.02)), sample=sample)
    [first, second] = limited.particles(2)
    assert limited.cost.simulated_actions == 0
    assert limited.confirm(START, ACTION).state.positions[0, 0] == pytest.approx(0.32)
    assert limited.cost.simulation >= 0.01
    assert first.apply(START, ACTION, None).state == START
    assert second.apply(START, ACTION, None).state.positions[0, 0] == pytest.approx(0.31)
    assert (limited.cost.simulated_actions, limited.simulations_left) == (3, 0)
    for again in (limited.confirm, lambda state, action: first.apply(state, action, None)):
        with pytest.raises(BudgetExceededError, match="the budget of 3 simulated actions is used up"):
            again(START, ACTION)
    assert limited.cost.simulated_actions == 3


def slow(apply: Apply) -> Apply:
    """The same, but a hundredth of a second later."""

    def later(state: State, action: Action, stop: Stop | None) -> Transition:
        time.sleep(0.01)
        return apply(state, action, stop)

    return later


def test_where_the_world_is_certain_there_are_no_particles() -> None:
    assert task().particles(8) == ()
    assert task(sample=lambda number: []).particles(8) == ()


def test_the_first_plan_knows_of_none_before() -> None:
    assert task().earlier is None
    before = ExploredTree((SearchNode(START),))
    assert task(earlier=before).earlier is before
