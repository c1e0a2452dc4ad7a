"""Any planner will do: one that only clears, one that knows nothing of pushing, one for another arm."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from phframe.core import (
    Action,
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
from phframe.planners.phia import PHIA
from phframe.pushing.options import PushingOptions
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.world import WorldSpec
from tests.pushing.parts import scene_of
from tests.runtime.worlds import BASIC, Clumsy, Meddling, Noting, arm_file, run, shifted

SPEC = WorldSpec(BASIC)


class OnlyClears(PHIA):
    """Leaves the grasp to whoever carries the plan out, as the paper does."""

    def search(self, task: Task) -> Plan:
        plan = super().search(task)
        pushes = [number for number, action in enumerate(plan.actions) if not action.grasps]
        kept = [tuple(part[number] for number in pushes) for part in (plan.actions, plan.expected, plan.decisions)]
        return Plan(Status.CLEARED, "the corridor is empty", *kept)  # type: ignore[arg-type]


class DoesNothing(Planner[Options]):
    """Says the corridor is empty, and no more."""

    def search(self, task: Task) -> Plan:
        return Plan(Status.CLEARED, "it looks empty")


def test_a_plan_that_only_clears_is_followed_by_a_grasp() -> None:
    episode = run(ExecutionWorld(SPEC), OnlyClears(PushingOptions()))
    assert (episode.status, episode.reason) == (Status.RETRIEVED, "")
    last = episode.steps[-1]
    assert last.action.grasps
    assert last.expected is None
    assert not any(action.grasps for action in episode.plans[0].actions)


def test_a_planner_without_corridors_is_followed_by_a_grasp_along_the_usual_one() -> None:
    free = scene_of((0.4, 0.3))
    episode = run(ExecutionWorld(WorldSpec(free)), DoesNothing(Options()))
    assert (episode.status, len(episode.steps)) == (Status.RETRIEVED, 1)


def test_where_that_grasp_is_blocked_the_corridor_is_cleared_and_no_more() -> None:
    blocked = scene_of((0.4, 0.3), (0.4, 0.3605), (0.4, 0.2395))
    episode = run(ExecutionWorld(WorldSpec(blocked)), DoesNothing(Options()))
    assert episode.status is Status.CLEARED
    assert episode.reason.startswith("grasp blocked by o")
    assert episode.steps == ()


def test_a_grasp_found_here_and_refused_by_the_arm_is_not_asked_for_again() -> None:
    world = Clumsy(SPEC, lambda action: action.grasps)
    episode = run(world, OnlyClears(PushingOptions()))
    assert episode.status in (Status.CLEARED, Status.FAILED)
    assert len(world.refused) == len(set(world.refused))


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

    episode = run(ExecutionWorld(SPEC), Diverges(PushingOptions()))
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
            *pushes, grasp = plan.actions
            poses = grasp.path.poses - [0.15, 0.0, 0.0]
            short = replace(grasp, path=replace(grasp.path, poses=poses))
            return replace(plan, actions=(*pushes, short))

    planner = Misses()
    episode = run(ExecutionWorld(WorldSpec(scene_of((0.4, 0.3)))), planner)
    assert [len(task.rejected) for task in planner.tasks] == list(range(len(episode.plans)))
    assert [step.action for step in episode.steps[:-1]] == list(planner.tasks[-1].rejected)
    assert (episode.status, episode.reason) == (Status.REACHED, "the target was not held")
    assert all(step.after.held is None for step in episode.steps)


@pytest.mark.parametrize("planner", [OnlyClears(PushingOptions()), Noting()])
def test_an_interrupt_is_not_swallowed(planner: Planner[PushingOptions]) -> None:
    def interrupt(_: Action) -> bool:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(Clumsy(SPEC, interrupt), planner)
