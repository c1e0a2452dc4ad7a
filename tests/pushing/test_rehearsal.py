"""Plans rehearsed in samples of the world: counted as they come off, the surest kept, found plans never lost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

from phframe.core import (
    ROOT,
    Action,
    ActionKind,
    Budget,
    Certainty,
    Condition,
    Motion,
    Particle,
    Plan,
    State,
    Status,
    Stop,
    Transition,
)
from phframe.core.particle import Apply
from phframe.planners.sure import Sure, SureOptions
from phframe.pushing import Rehearsals, first_fault
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import scene_of
from tests.pushing.worlds import bench, task_in

SCENE = scene_of((0.45, 0.3), (0.25, 0.3), (0.25, 0.365), (0.25, 0.235), (0.3, 0.17), (0.3, 0.43))
"""One push and a grasp."""


def topples(apply: Apply, when: Action | None = None) -> Apply:
    """A world in which o0 topples: whenever something is pushed, or only in one action."""

    def fragile(state: State, action: Action, stop: Stop | None) -> Transition:
        made = apply(state, action, stop)
        if action.kind is not ActionKind.PUSH or (when is not None and not action.resembles(when)):
            return made
        fallen = (made.state.conditions[0], Condition.TOPPLED, *made.state.conditions[2:])
        return replace(made, state=replace(made.state, conditions=fallen))

    return fragile


def slips(_apply: Apply) -> Apply:
    """A world in which the target is never held."""
    return lambda state, action, stop: (
        Transition(state, Motion(1.0)) if action.kind is ActionKind.GRASP else _apply(state, action, stop)
    )


def particles(*applies: Apply) -> list[Particle]:
    return [Particle(SCENE.initial_state(), apply) for apply in applies]


def planned(world: PlanningWorld, samples: Sequence[Particle], budget: Budget = Budget(), **options: object) -> Plan:  # noqa: B008
    task = task_in(world, sample=lambda number: samples[:number], budget=budget)
    return Sure(SureOptions.parse(options, "sure")).plan(task)


def test_the_first_action_that_goes_wrong_in_a_sample_is_found() -> None:
    with bench(SCENE) as made, PlanningWorld(WorldSpec(SCENE)) as world:
        plan = Sure(SureOptions()).plan(task_in(world))
        assert [action.kind for action in plan.actions] == [ActionKind.PUSH, ActionKind.GRASP]
        worlds = particles(world.apply, topples(world.apply), world.apply, slips(world.apply))
        assert [first_fault(made.search, plan.actions, each) for each in worlds] == [None, 0, None, 1]


def test_a_sample_in_which_things_stand_elsewhere_is_begun_from_there() -> None:
    with bench(SCENE) as made, PlanningWorld(WorldSpec(SCENE)) as world:
        plan = Sure(SureOptions()).plan(task_in(world))
        poses = SCENE.initial_state().poses.copy()
        poses[0, :2] = [0.45, 0.12]
        aside = Particle(replace(SCENE.initial_state(), poses=poses), world.apply)
        assert first_fault(made.search, plan.actions, aside) is not None


def test_all_are_certain_where_there_are_no_samples() -> None:
    with bench(SCENE) as made:
        rehearsals = Rehearsals(made.task, made.search, particles=8, certain=1.0, most=10)
        assert rehearsals.surest() is None
        assert rehearsals.rehearse(ROOT, 0.01)
        best = rehearsals.surest()
        assert best is not None
        assert best.certainty == Certainty(0.01, 0, 0)


def test_a_plan_says_in_how_many_samples_it_was_clean() -> None:
    with PlanningWorld(WorldSpec(SCENE)) as world:
        for number in (0, 1, 3):
            plan = planned(world, particles(*[world.apply] * 8), particles=number)
            assert plan.certainty is not None
            assert (plan.certainty.samples, plan.certainty.clean) == (number, number)


def test_a_plan_that_is_not_sure_gives_way_to_one_that_is() -> None:
    with PlanningWorld(WorldSpec(SCENE)) as world:
        believed = planned(world, [])
        fragile = particles(*[topples(world.apply, believed.actions[0])] * 4)
        plan = planned(world, fragile)
        assert plan.status is Status.RETRIEVED
        assert not plan.actions[0].resembles(believed.actions[0])
        assert plan.certainty is not None
        assert (plan.certainty.samples, plan.certainty.clean) == (4, 4)
        assert plan.tree is not None
        assert "comes off in 0 of 4 samples of the world" in {node.closed for node in plan.tree.nodes}
        (unsure,) = (row for row, node in enumerate(plan.tree.nodes) if node.closed.startswith("comes off in 0"))
        assert plan.tree.nodes[unsure].action == believed.actions[0]
        after = {node.parent for node in plan.tree.nodes[unsure + 2 :]}
        assert unsure not in after, "nothing else is built on a push that is not sure"
        assert [bool(node.closed) for node in plan.tree.path] == [False] * len(plan.actions)


@pytest.mark.parametrize(("most", "clean"), [(1, 1), (20, 2)])
def test_where_none_is_sure_the_surest_of_as_many_as_are_rehearsed_is_kept(most: int, clean: int) -> None:
    with PlanningWorld(WorldSpec(SCENE)) as world:
        believed = planned(world, [])
        worlds = [topples(world.apply), topples(world.apply, believed.actions[0]), world.apply, topples(world.apply)]
        plan = planned(world, particles(*worlds), rehearsals=most)
        assert plan.status is Status.RETRIEVED
        assert plan.tree is not None
        assert plan.certainty is not None
        told = [node.closed for node in plan.tree.nodes if node.closed.startswith("comes off in ")]
        assert (plan.certainty.samples, plan.certainty.clean) == (4, clean)
        assert "comes off in 1 of 4 samples of the world" in told or most == 1
        assert all(int(each.split()[3]) <= clean for each in told)
        assert len(told) <= most - 1
        assert not any(node.closed for node in plan.tree.path)


def test_a_plan_that_was_found_is_not_lost_when_the_budget_ends_its_rehearsal() -> None:
    with PlanningWorld(WorldSpec(SCENE)) as world:
        needed = planned(world, []).cost.simulated_actions
        whole = planned(world, particles(*[world.apply] * 4))
        for limit in range(needed, whole.cost.simulated_actions + 1):
            plan = planned(world, particles(*[world.apply] * 4), Budget(simulations=limit))
            assert plan.status is Status.RETRIEVED
            assert plan.actions == whole.actions
            done = limit == whole.cost.simulated_actions
            assert (plan.certainty == whole.certainty) is done
        assert planned(world, [], Budget(simulations=needed - 1)).status is Status.TIMEOUT


def test_the_samples_are_drawn_once_for_all_plans() -> None:
    drawn = []

    def sample(number: int) -> list[Particle]:
        drawn.append(number)
        return particles(*[topples(world.apply)] * number)

    with PlanningWorld(WorldSpec(SCENE)) as world:
        task = task_in(world, sample=sample)
        Sure(SureOptions(rehearsals=3, particles=2)).plan(task)
        assert drawn == [2]
