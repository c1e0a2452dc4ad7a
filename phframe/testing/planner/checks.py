"""What is checked of a planner."""

from __future__ import annotations

import pickle
import random
import time
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO

import numpy as np

from phframe.core import Action, Budget, Plan, Scene, State, Status, Task
from phframe.pushing import PushDecision
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_at_most, expect_equal
from phframe.testing.planner.scenes import cluttered, hopeless, lone_target, reordered
from phframe.testing.subjects import PlannerUnderTest
from phframe.testing.tolerances import OVERTIME

SEEDS = (1, 3)
"""Of the cluttered scenes."""


@check
def plans_are_well_formed(subject: PlannerUnderTest) -> Faults:
    """Plan: a state expected after each action and a decision for each, which follows an earlier one; a reason."""
    for scene in _scenes():
        yield from _expect_well_formed(_plan(subject, scene), scene)


@check
def expected_states_come_true(subject: PlannerUnderTest) -> Faults:
    """Plan.expected: the state expected after each action, which is what ``Task.apply`` makes of the one before."""
    for scene in _scenes():
        plan, task = _plan(subject, scene), subject.make_task(scene)
        state = task.start
        for number, (action, wanted) in enumerate(zip(plan.actions, plan.expected, strict=True), start=1):
            state = task.apply(state, action).state
            yield from expect_equal(state, wanted, f"{scene.name}: the state after action {number}, {action.name!r}")


@check
def retrieved_means_in_the_hand(subject: PlannerUnderTest) -> Faults:
    """Status.RETRIEVED: the target is out of the shelf and in the hand."""
    for scene in _scenes():
        plan = _plan(subject, scene)
        if plan.status is Status.RETRIEVED:
            last = plan.expected[-1] if plan.expected else scene.initial_state()
            yield from expect_equal(last.held, scene.target, f"{scene.name}: what is held at the end")
            x = float(last.positions[scene.target_index, 0])
            yield from expect(x < 0.0, f"{scene.name}: the target before the mouth at the end", f"at x = {x:.3f} m")


@check
def free_targets_are_within_its_power(subject: PlannerUnderTest) -> Faults:
    """Planner: finds the actions that bring the target out; nothing obstructs it here."""
    plan = _plan(subject, lone_target())
    yield from expect(plan.succeeded, "a plan worth carrying out for a lone target", f"{plan.status}: {plan.reason}")
    yield from _expect_well_formed(plan, lone_target())


@check
def same_seeds_give_same_plans(subject: PlannerUnderTest) -> Faults:
    """Planner: takes chance from ``Task.rng`` only, so the same task gives the same plan, bit by bit."""
    for scene in _scenes():
        first, again = _plan(subject, scene), _plan(subject, scene)
        yield from expect_equal(again, first, f"{scene.name}: the same plan")
        costs = [plan.cost.simulated_actions for plan in (first, again)]
        yield from expect_equal(costs[1], costs[0], f"{scene.name}: the same number of simulated actions")


@check
def planners_are_stateless(subject: PlannerUnderTest) -> Faults:
    """Planner: stateless; one object may plan many tasks, and another order of tasks changes nothing."""
    scenes = [*_scenes(), lone_target()]
    first = [_plan(subject, scene) for scene in scenes]
    again = [_plan(subject, scene) for scene in reversed(scenes)]
    for scene, before, after in zip(scenes, first, reversed(again), strict=True):
        yield from expect_equal(after, before, f"{scene.name}: the plan, after other tasks")


@check
def global_generators_are_left_alone(subject: PlannerUnderTest) -> Faults:
    """Planner.search: take chance from ``Task.rng`` only."""
    before = random.getstate(), pickle.dumps(np.random.get_state())  # noqa: NPY002 - to see that nobody uses it
    for scene in _scenes():
        _plan(subject, scene)
    after = random.getstate(), pickle.dumps(np.random.get_state())  # noqa: NPY002
    yield from expect(before[0] == after[0], "Python's global generator as it was", "numbers were drawn from it")
    yield from expect(before[1] == after[1], "NumPy's global generator as it was", "numbers were drawn from it")


@check
def nothing_is_printed(subject: PlannerUnderTest) -> Faults:
    """Planner.search: do not print."""
    text = StringIO()
    with redirect_stdout(text), redirect_stderr(text):
        for scene in (*_scenes(), *(scene for scene, _ in hopeless())):
            _plan(subject, scene)
    yield from expect_equal(text.getvalue(), "", "what is printed")


@check
def what_cannot_be_solved_is_a_result(subject: PlannerUnderTest) -> Faults:
    """Planner.search: what cannot be solved is a plan with a status and a reason, never an exception and never None."""
    for scene, start in hopeless():
        try:
            plan = subject.planner.plan(subject.make_task(scene, start=start, budget=Budget(20.0, 60)))
        except Exception as error:  # noqa: BLE001 - that nothing is raised is what is checked
            yield from expect(False, f"a plan for {scene.name}", f"{type(error).__name__}: {error}")
            continue
        yield from _expect_well_formed(plan, scene)
        retrieved = plan.status is Status.RETRIEVED
        yield from expect(not retrieved or plan.expected, f"an honest result for {scene.name}", str(plan.status))
        if start.conditions[scene.target_index] != "upright":
            yield from expect(not plan.succeeded, f"no success for {scene.name}", f"{plan.status}")


@check
def simulations_are_within_budget(subject: PlannerUnderTest) -> Faults:
    """Budget.simulations: number of simulated actions; the result is a plan with a reason when they are used up."""
    scene = cluttered(SEEDS[0], obstacles=9)
    free = _plan(subject, scene)
    for limit in (0, 1, max(free.cost.simulated_actions - 1, 0)):
        plan = subject.planner.plan(subject.make_task(scene, budget=Budget(60.0, limit)))
        spent = plan.cost.simulated_actions
        yield from expect_at_most(spent, limit, "simulated actions")
        yield from _expect_well_formed(plan, scene)
        if limit == 0:
            yield from expect(
                not plan.succeeded, "no success without a simulated action", f"{plan.status}: {plan.reason}"
            )
    budget = Budget(60.0, free.cost.simulated_actions)
    enough = subject.planner.plan(subject.make_task(scene, seed=11, budget=budget))
    yield from expect_equal(enough, free, "the plan with just enough simulated actions, the same as with no limit")


@check
def time_is_within_budget(subject: PlannerUnderTest) -> Faults:
    """Budget.seconds: wall time; the result is a plan when it is used up."""
    scene = cluttered(SEEDS[0], obstacles=9)
    for seconds in (0.0, 0.005):
        task = subject.make_task(scene, budget=Budget(seconds))
        began = time.process_time()  # of this process alone: others may keep the machine busy
        plan = subject.planner.plan(task)
        spent = time.process_time() - began
        yield from expect_at_most(spent, seconds + OVERTIME, f"seconds spent with a limit of {seconds:g} s")
        yield from _expect_well_formed(plan, scene)
        if seconds == 0.0:
            yield from expect(not plan.succeeded, "no success in no time", f"{plan.status}: {plan.reason}")


@check
def tasks_are_not_changed(subject: PlannerUnderTest) -> Faults:
    """Task: scene, start state and arm are immutable; they are the same after planning as before."""
    for scene in _scenes():
        task = subject.make_task(scene)
        before = _bits(task)
        subject.planner.plan(task)
        yield from expect(_bits(task) == before, f"{scene.name}: scene, start and arm as they were", "they changed")


@check
def options_are_not_changed(subject: PlannerUnderTest) -> Faults:
    """Planner.options: frozen."""
    before = pickle.dumps(subject.planner.options)
    _plan(subject, cluttered(SEEDS[0]))
    yield from expect(pickle.dumps(subject.planner.options) == before, "the options as they were", "they changed")


@check
def rejected_actions_are_not_proposed_again(subject: PlannerUnderTest) -> Faults:
    """Task.rejected: actions that could not be carried out; do not propose them again."""
    for scene in _scenes():
        rejected: tuple[Action, ...] = ()
        for _ in range(3):
            plan = subject.planner.plan(subject.make_task(scene, rejected=rejected))
            again = [action.name for action in plan.actions if action in rejected]
            yield from expect(not again, f"{scene.name}: no action that was rejected", f"again: {', '.join(again)}")
            rejected = (*rejected, *plan.actions[:1])


@check
def plans_begin_where_the_world_is(subject: PlannerUnderTest) -> Faults:
    """Task.start: the world to plan from; it need not be the scene's initial state."""
    for scene in _scenes():
        first = _plan(subject, scene)
        if len(first.actions) < 2:
            continue
        state: State = first.expected[0]
        task = subject.make_task(scene, start=state)
        plan = subject.planner.plan(task)
        for action, wanted in zip(plan.actions, plan.expected, strict=True):
            state = task.apply(state, action).state
            yield from expect_equal(state, wanted, f"{scene.name}: the state after {action.name!r}, from a later start")


@check
def order_of_objects_does_not_matter(subject: PlannerUnderTest) -> Faults:
    """A planner that promises it: the same problem with its objects in another order has the same outcome."""
    for scene in _scenes():
        plans = [_plan(subject, each) for each in (scene, reordered(scene))]
        yield from expect_equal(plans[1].status, plans[0].status, f"{scene.name}: the status, objects reordered")
        yield from expect_equal(len(plans[1].actions), len(plans[0].actions), f"{scene.name}: actions, reordered")


def _scenes() -> tuple[Scene, ...]:
    return tuple(cluttered(seed) for seed in SEEDS)


def _plan(subject: PlannerUnderTest, scene: Scene) -> Plan:
    return subject.planner.plan(subject.make_task(scene, seed=11, budget=Budget(60.0, 200)))


def _expect_well_formed(plan: Plan, scene: Scene) -> Faults:
    if not isinstance(plan, Plan):
        yield from expect(False, f"{scene.name}: a Plan", repr(plan))
        return
    yield from expect(isinstance(plan.status, Status), f"{scene.name}: a Status", repr(plan.status))
    reasoned = bool(plan.reason) or plan.status is Status.RETRIEVED
    yield from expect(reasoned, f"{scene.name}: a reason for the status {plan.status}", "none")
    for action, decision in zip(plan.actions, plan.decisions, strict=True):
        push = PushDecision.of(decision)
        unknown = {*push.members, *push.chosen, *action.moves} - set(scene.ids)
        yield from expect(not unknown, f"{scene.name}: ids of the scene's objects", f"unknown: {sorted(unknown)}")
    cost = plan.cost
    parts = cost.topology + cost.simulation + cost.motion_planning
    yield from expect(
        cost.total >= parts - 1e-3, f"{scene.name}: a total cost of at least {parts:.4f} s", f"{cost.total:.4f} s"
    )


def _bits(task: Task) -> bytes:
    return pickle.dumps((task.scene, task.start, task.arm, task.rejected, task.budget))


PLANNER_CHECKS: tuple[Check[PlannerUnderTest], ...] = (
    plans_are_well_formed,
    expected_states_come_true,
    retrieved_means_in_the_hand,
    free_targets_are_within_its_power,
    same_seeds_give_same_plans,
    planners_are_stateless,
    global_generators_are_left_alone,
    nothing_is_printed,
    what_cannot_be_solved_is_a_result,
    simulations_are_within_budget,
    time_is_within_budget,
    tasks_are_not_changed,
    options_are_not_changed,
    rejected_actions_are_not_proposed_again,
    plans_begin_where_the_world_is,
)
