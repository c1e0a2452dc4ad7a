"""Asking takes nothing from a budget, and a hint is found in every decision that holds one."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import TypeAdapter

from phframe.bench.meters.tasks import retrieval_task
from phframe.core import Budget, BudgetExceededError, Decision, Hint, Question, Task
from phframe.core import task as task_module
from phframe.core.decision import AnyDecision, UnknownDecision
from phframe.pushing import StraightPushDecision
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec

SCENE = find_scene("vieira/simple-01")
QUESTION = Question(SCENE, SCENE.initial_state(), "object_1", np.zeros((4, 2)))
ADAPTER: TypeAdapter[Decision] = TypeAdapter(AnyDecision)


@dataclass
class Clock:
    """Stands still unless it is moved."""

    now: float = 0.0


class Thinker:
    """Takes its time.

    Args:
        clock: By which it thinks for a thousand seconds.
    """

    def __init__(self, clock: Clock) -> None:
        self._clock = clock

    def advise(self, question: Question) -> Hint | None:
        self._clock.now += 1000.0
        return Hint(question.blocker, (0.1, 0.2))


def task_of(world: PlanningWorld, clock: Clock) -> Task:
    goal, topology = create(Kind.GOAL, "retrieve"), create(Kind.TOPOLOGY, "ripser")
    rng, start = np.random.default_rng(0), SCENE.initial_state()
    return world.task(start, topology, rng, goal=goal, budget=Budget(10.0), advisor=Thinker(clock))


def test_while_somebody_is_asked_the_clock_stands_still(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setattr(task_module, "time", SimpleNamespace(perf_counter=lambda: clock.now))
    with PlanningWorld(WorldSpec(SCENE)) as world:
        task = task_of(world, clock)
        grasp = create(Kind.PLANNER, "grtc-straight").plan(retrieval_task(world)).actions[-1]
        assert task.ask(QUESTION) == Hint("object_1", (0.1, 0.2))
        assert task.elapsed == 0.0
        task.apply(task.start, grasp)
        clock.now += 11.0
        with pytest.raises(BudgetExceededError):
            task.apply(task.start, grasp)


def test_where_nobody_is_there_is_no_hint() -> None:
    with PlanningWorld(WorldSpec(SCENE)) as world:
        assert retrieval_task(world).ask(QUESTION) is None


def test_a_hint_is_found_whatever_the_type_of_decision() -> None:
    hint = Hint("object_1", (0.25, 0.5))
    decision = StraightPushDecision("told", chosen=("object_1",), place=hint.to, hint=hint)
    written = ADAPTER.dump_python(decision)
    back = ADAPTER.validate_python(written)
    assert back == decision
    assert back.hint == hint
    unknown = ADAPTER.validate_python({**written, "kind": "of a plugin that is gone"})
    assert isinstance(unknown, UnknownDecision)
    assert unknown.hint == hint
    assert ADAPTER.validate_python({"kind": "gone", "hint": {"object": 3}}).hint is None
    assert ADAPTER.validate_python({"kind": "gone"}).hint is None
    assert Decision("a thought").hint is None
