"""Every check of planners finds a planner that breaks its promise."""

from __future__ import annotations

import random
import time
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from phframe.core import BudgetExceededError, Plan, SearchNode, State, Status, Task
from phframe.planners.phia import PHIA, PHIAOptions
from phframe.pushing import PushDecision
from phframe.testing import (
    PLANNER_CHECKS,
    Check,
    ConformanceError,
    PlannerUnderTest,
    check_planner,
    order_of_objects_does_not_matter,
    simulated_tasks,
)
from phframe.testing.subjects import MakeTask
from phframe.testing.tolerances import OVERTIME


def with_nodes(plan: Plan, change: Callable[[SearchNode], SearchNode]) -> Plan:
    """The plan with every node of its tree but the root changed."""
    if plan.tree is None:
        return plan
    root, *others = plan.tree.nodes
    return replace(plan, tree=replace(plan.tree, nodes=(root, *map(change, others))))


class DecidesAboutStrangers(PHIA):
    def search(self, task: Task) -> Plan:
        return with_nodes(super().search(task), lambda node: replace(node, decision=PushDecision(chosen=("nobody",))))


class Optimist(PHIA):
    """Expects what it wishes."""

    def search(self, task: Task) -> Plan:
        plan = super().search(task)
        return with_nodes(plan, lambda node: replace(node, state=task.start))


class Defeatist(PHIA):
    def search(self, task: Task) -> Plan:
        return Plan(Status.FAILED, "it will not work anyhow")


class Chancy(PHIA):
    def search(self, task: Task) -> Plan:
        chance = np.random.default_rng().random()
        return replace(super().search(task), reason=f"chance says {chance}")


class Learns(PHIA):
    plans = 0

    def search(self, task: Task) -> Plan:
        self.plans += 1
        return replace(super().search(task), reason=f"plan {self.plans}")


class GlobalChance(PHIA):
    def search(self, task: Task) -> Plan:
        random.random()
        np.random.random()  # noqa: NPY002 - what the check has to find
        return super().search(task)


class Talks(PHIA):
    def search(self, task: Task) -> Plan:
        print("planning ...")
        return super().search(task)


class Raises(PHIA):
    def search(self, task: Task) -> Plan:
        plan = super().search(task)
        if not plan.succeeded:
            raise ValueError(plan.reason)
        return plan


class KeepsNoAccounts(PHIA):
    """Goes behind the back of the budget."""

    def search(self, task: Task) -> Plan:
        unlimited = Task(
            scene=task.scene,
            start=task.start,
            goal=task.goal,
            arm=task.arm,
            topology=task._topology,
            apply=task._apply,
            rng=task.rng,
            rejected=task.rejected,
        )
        return super().search(unlimited)


class Dawdles(PHIA):
    rested = False

    def search(self, task: Task) -> Plan:
        try:
            return super().search(task)
        except BudgetExceededError:
            end = time.process_time() + (0.0 if self.rested else OVERTIME + 0.1)
            while time.process_time() < end:
                pass
            self.rested = True
            raise


class Rearranges(PHIA):
    def search(self, task: Task) -> Plan:
        poses = task.start.poses.copy()
        poses[1:, 0] = 0.05
        task.start = State(poses, task.start.conditions)
        return super().search(task)


class ChangesItsMind(PHIA):
    def search(self, task: Task) -> Plan:
        object.__setattr__(self, "options", PHIAOptions(max_actions=self.options.max_actions + 1))
        return super().search(task)


class Stubborn(PHIA):
    def search(self, task: Task) -> Plan:
        task.rejected = ()
        return super().search(task)


class FromTheBeginning(PHIA):
    def search(self, task: Task) -> Plan:
        task.start = task.scene.initial_state()
        return super().search(task)


class FirstComesFirst(PHIA):
    """Depends on which object is listed first."""

    def search(self, task: Task) -> Plan:
        plan = super().search(task)
        return replace(plan, status=Status.CLEARED) if task.scene.target_index == 0 else plan


BROKEN: dict[str, type[PHIA]] = {
    "plans_are_well_formed": DecidesAboutStrangers,
    "expected_states_come_true": Optimist,
    "retrieved_means_in_the_hand": Optimist,
    "free_targets_are_within_its_power": Defeatist,
    "same_seeds_give_same_plans": Chancy,
    "planners_are_stateless": Learns,
    "global_generators_are_left_alone": GlobalChance,
    "nothing_is_printed": Talks,
    "what_cannot_be_solved_is_a_result": Raises,
    "simulations_are_within_budget": KeepsNoAccounts,
    "time_is_within_budget": Dawdles,
    "tasks_are_not_changed": Rearranges,
    "options_are_not_changed": ChangesItsMind,
    "rejected_actions_are_not_proposed_again": Stubborn,
    "plans_begin_where_the_world_is": FromTheBeginning,
    "order_of_objects_does_not_matter": FirstComesFirst,
}


@cache
def tasks() -> MakeTask:
    return simulated_tasks()


@pytest.mark.parametrize("check", [*PLANNER_CHECKS, order_of_objects_does_not_matter], ids=lambda check: check.name)
def test_every_check_can_fail(check: Check[PlannerUnderTest]) -> None:
    planner = BROKEN[check.name](PHIAOptions())
    with pytest.raises(ConformanceError) as caught:
        check(PlannerUnderTest(planner, tasks()))
    assert caught.value.failures[0].check == check.name
    assert "no exception" not in str(caught.value)


def test_returning_none_is_found() -> None:
    class Silent(PHIA):
        def search(self, task: Task) -> Plan:
            return None  # type: ignore[return-value]

    with pytest.raises(ConformanceError, match="plans_are_well_formed"):
        check_planner(Silent(PHIAOptions()), tasks())
