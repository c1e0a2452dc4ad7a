"""Any planner will do: one that only clears, one that knows nothing of pushing, one for another arm."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from phframe.core import (
    Action,
    ActionKind,
    Episode,
    Loop,
    Motion,
    Options,
    Plan,
    Planner,
    SimulationDivergedError,
    Status,
    Task,
    Trajectory,
    Watch,
)
from phframe.planners.phia import PHIA, PHIAOptions
from phframe.runtime.episode import MOST_ALIKE
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.observer import Observer
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import scene_of
from tests.runtime.worlds import BASIC, Clumsy, Meddling, Noting, arm_file, run, shifted

SPEC = WorldSpec(BASIC)


class OnlyClears(PHIA):
    """Promises an empty corridor, and no grasp."""

    def search(self, task: Task) -> Plan:
        plan = super().search(task)
        assert plan.tree is not None
        path = [node for node in plan.tree.path if node.action and node.action.kind is ActionKind.PUSH]
        steps = [(node.action, node.state) for node in path if node.action is not None]
        return Plan.of(Status.CLEARED, "the corridor is empty", task.start, steps)


class DoesNothing(Planner[Options]):
    """Says the corridor is empty, and no more."""

    def search(self, task: Task) -> Plan:
        return Plan(Status.CLEARED, "it looks empty")


def test_a_plan_that_only_clears_is_carried_out_and_no_more() -> None:
    episode = run(ExecutionWorld(SPEC), OnlyClears(PHIAOptions()))
    assert (episode.status, episode.replans) == (Status.CLEARED, 0)
    assert episode.reason == "the corridor is empty, and the target was not grasped"
    assert [step.action for step in episode.steps] == list(episode.plans[0].actions)


def test_a_plan_without_actions_ends_as_the_goal_judges_it_whatever_it_claims() -> None:
    free, blocked = scene_of((0.4, 0.3)), scene_of((0.4, 0.3), (0.2, 0.3))
    for scene, status in ((free, Status.CLEARED), (blocked, Status.FAILED)):
        episode = run(ExecutionWorld(WorldSpec(scene)), DoesNothing(Options()))
        assert (episode.status, episode.steps, len(episode.plans)) == (status, (), 1)


def test_another_arm_than_the_one_planned_with_starts_parked(tmp_path: Path) -> None:
    planner = Noting()
    name = next(n for n in BASIC.ids if n != BASIC.target and n not in run(ExecutionWorld(SPEC)).steps[0].action.moves)
    execution = Meddling(WorldSpec(BASIC, arm=arm_file(tmp_path)), {1: shifted(name, (0.0, 0.02))})
    episode = run(execution, planner, planning=SPEC)
    assert episode.status is Status.RETRIEVED
    assert [task.start.arm for task in planner.tasks] == [None, None]
    same = Noting()
    run(Meddling(SPEC, {1: shifted(name, (0.0, 0.02))}), same)
    assert same.tasks[1].start.arm is not None


def test_a_simulation_that_diverges_while_planning_is_a_result() -> None:
    class Diverges(PHIA):
        def search(self, task: Task) -> Plan:
            raise SimulationDivergedError("the simulation diverged: 'o1' moves at 1e+09 m/s")

    episode = run(ExecutionWorld(SPEC), Diverges(PHIAOptions()))
    assert (episode.status, episode.steps) == (Status.FAILED, ())
    assert "diverged" in episode.reason


def test_a_simulation_that_diverges_while_executing_is_a_result_with_what_was_done() -> None:
    class Breaks(ExecutionWorld):
        done = 0

        def execute(self, trajectory: Trajectory, watch: Watch | None = None) -> Motion:
            self.done += 1
            if self.done == 2:
                raise SimulationDivergedError("the simulation diverged: 'o1' moves at 1e+09 m/s")
            return super().execute(trajectory, watch)

    episode = run(Breaks(SPEC))
    assert (episode.status, len(episode.steps)) == (Status.FAILED, 1)
    assert "diverged" in episode.reason


def test_a_grasp_that_misses_is_reached_or_tried_again() -> None:
    """The target is moved away under the closing fingers' nose, farther than a plan can know."""

    class Misses(Noting):
        def search(self, task: Task) -> Plan:
            plan = super().search(task)
            assert plan.tree is not None
            *nodes, last = plan.tree.nodes
            assert last.action is not None
            short = replace(last.action, path=last.action.path.shifted([-0.15, 0.0, 0.0]))
            return replace(plan, tree=replace(plan.tree, nodes=(*nodes, replace(last, action=short))))

    planner = Misses()
    episode = run(ExecutionWorld(WorldSpec(scene_of((0.4, 0.3)))), planner, loop=Loop(max_replans=5))
    assert [len(task.rejected) for task in planner.tasks] == [0, 1, 1, 1, 1, 1]
    assert [step.action for step in episode.steps] == [each.action for each in planner.tasks[-1].rejected]
    assert (episode.status, episode.replans) == (Status.REACHED, 5)
    assert episode.reason.startswith("the target was not held; the planner proposes the same again: ")
    assert all(step.after.held is None for step in episode.steps)
    once = run(ExecutionWorld(WorldSpec(scene_of((0.4, 0.3)))), Misses(), loop=Loop(max_replans=0))
    assert (len(once.plans), once.replans, once.status) == (1, 0, Status.REACHED)


def test_grasps_from_all_sides_that_come_to_the_same_are_not_tried_for_ever() -> None:
    """Each stops short of the target, and each a little elsewhere, so that none is the same again."""

    class MissesElsewhere(Noting):
        def search(self, task: Task) -> Plan:
            plan = super().search(replaced(task))
            assert plan.tree is not None
            *nodes, last = plan.tree.nodes
            assert last.action is not None
            short = replace(last.action, path=last.action.path.shifted([-0.15 - 0.02 * len(self.tasks), 0.0, 0.0]))
            return replace(plan, tree=replace(plan.tree, nodes=(*nodes, replace(last, action=short))))

    def replaced(task: Task) -> Task:
        task.rejected = ()
        return task

    episode = run(ExecutionWorld(WorldSpec(scene_of((0.4, 0.3)))), MissesElsewhere(), loop=Loop(max_replans=30))
    assert (episode.status, len(episode.steps), len(episode.rejections)) == (Status.REACHED, MOST_ALIKE, MOST_ALIKE)
    assert (
        episode.reason == f"{MOST_ALIKE} grasps in a row came to the same and changed nothing: the target was not held"
    )


@pytest.mark.parametrize("planner", [OnlyClears(PHIAOptions()), Noting()])
def test_an_interrupt_is_not_swallowed(planner: Planner[PHIAOptions]) -> None:
    def interrupt(_: Action) -> bool:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(Clumsy(SPEC, interrupt), planner)


def test_an_interrupted_episode_tells_what_was_tried_and_rejected() -> None:
    class Kept(Observer):
        partial: Episode | None = None

        def interrupted(self, episode: Episode) -> None:
            self.partial = episode

    class Interrupted(PHIA):
        asked = 0

        def search(self, task: Task) -> Plan:
            self.asked += 1
            if self.asked > 1:
                raise KeyboardInterrupt
            return super().search(task)

    kept = Kept()
    with pytest.raises(KeyboardInterrupt):
        run(Clumsy(WorldSpec(BASIC), lambda _: True), Interrupted(PHIAOptions()), observers=[kept])
    assert kept.partial is not None
    assert (len(kept.partial.plans), len(kept.partial.rejections)) == (1, 1)
    assert kept.partial.rejections[0].reason.endswith("joint 4 at its limit")
