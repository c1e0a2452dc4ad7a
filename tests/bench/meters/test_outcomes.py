"""Tallies count what they say they count."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from statistics import median

import numpy as np
import pytest

from phframe.bench.meters import __main__ as bench
from phframe.bench.meters.outcomes import Outcome, deviations, run_suite, tally, was_cleared
from phframe.core import Condition, Episode, Plan, State, Status
from phframe.runtime.solve import solve

SCENES = ("vieira/simple-10", "papallas/s06", "vieira/basic")
OUTCOMES = run_suite("phia", SCENES, lambda scene: None)
SHORT = solve("vieira/basic", options={"planner": {"max_actions": 2}})
"""Fails after two pushes, with obstacles left in the corridor."""


def test_every_scene_is_solved_once_and_announced() -> None:
    told: list[str] = []
    outcomes = run_suite("ooa", SCENES[:2], told.append)
    assert [(each.suite, each.scene) for each in outcomes] == [("vieira", SCENES[0]), ("papallas", SCENES[1])]
    assert told == [f"ooa {name}" for name in SCENES[:2]]
    assert [each.episode.spec.planner for each in outcomes] == ["ooa", "ooa"]
    assert outcomes[0].episode == solve(SCENES[0], planner="ooa", seed=0)


def test_a_tally_of_what_went_well() -> None:
    figures = tally("phia", "some", OUTCOMES)
    done = [each.episode for each in OUTCOMES]
    assert (figures.planner, figures.suite, figures.scenes) == ("phia", "some", 3)
    assert (figures.cleared, figures.reached, figures.retrieved, figures.clean) == (3, 3, 3, 3)
    assert figures.actions == pytest.approx(sum(episode.pushes for episode in done) / 3)
    assert figures.planning_time == median(episode.cost.total for episode in done)
    assert figures.execution_time == median(episode.execution_time for episode in done)


def test_each_status_counts_where_it_should() -> None:
    retrieved = OUTCOMES[0].episode
    dirty = _with_last(retrieved, Condition.SPILLED)
    several = [retrieved, dirty, *(replace(retrieved, status=each) for each in (Status.REACHED, Status.CLEARED)), SHORT]
    figures = tally("phia", "mixed", [Outcome("x", "x/y", episode) for episode in several])
    assert (figures.scenes, figures.cleared, figures.reached, figures.retrieved, figures.clean) == (5, 4, 3, 2, 1)
    assert figures.actions == retrieved.pushes


def test_a_suite_in_which_nothing_was_retrieved_has_figures_too() -> None:
    figures = tally("phia", "none", [Outcome("x", "x/y", SHORT)])
    assert (figures.retrieved, figures.actions, figures.execution_time) == (0, 0, 0.0)
    assert np.isfinite(figures.planning_time)


def test_a_failed_plan_that_leaves_obstacles_has_not_cleared() -> None:
    assert SHORT.status is Status.FAILED
    assert not was_cleared(SHORT)
    assert not was_cleared(replace(SHORT, plans=(Plan(Status.FAILED, "nothing was tried"),)))


def test_a_failed_plan_that_leaves_an_empty_corridor_has_cleared() -> None:
    plan = OUTCOMES[2].episode.plans[0]
    emptied = _without_grasp(OUTCOMES[2].episode, plan, plan.expected[:-1])
    failed = replace(OUTCOMES[2].episode, status=Status.FAILED, reason="grasp blocked", plans=(emptied,), steps=())
    assert was_cleared(failed)
    lost = _without_grasp(failed, plan, (*emptied.expected[:-1], _spilled(failed, emptied)))
    assert not was_cleared(replace(failed, plans=(lost,)))


def test_deviations_are_those_of_all_plans() -> None:
    counted = Counter(c for o in OUTCOMES for plan in o.episode.plans for d in plan.decisions for c in d.deviations)
    assert counted
    assert deviations(OUTCOMES) == counted
    twice = replace(OUTCOMES[2].episode, plans=OUTCOMES[2].episode.plans * 2)
    assert deviations([Outcome("x", "x/y", twice)]).total() == 2 * deviations([OUTCOMES[2]]).total()


def _with_last(episode: Episode, condition: Condition) -> Episode:
    last = episode.steps[-1]
    row = next(number for number in range(len(episode.scene.ids)) if number != episode.scene.target_index)
    conditions = list(last.after.conditions)
    conditions[row] = condition
    after = replace(last.after, conditions=tuple(conditions))
    return replace(episode, steps=(*episode.steps[:-1], replace(last, after=after)))


def _without_grasp(episode: Episode, plan: Plan, expected: Sequence[State]) -> Plan:
    """The pushes of a plan, of which something is expected."""
    steps = zip(plan.actions[:-1], expected, plan.decisions[:-1], strict=True)
    return Plan.of(Status.FAILED, "grasp blocked", episode.scene.initial_state(), steps)


def _spilled(episode: Episode, plan: Plan) -> State:
    conditions = list(plan.expected[-1].conditions)
    conditions[episode.scene.target_index] = Condition.SPILLED
    return replace(plan.expected[-1], conditions=tuple(conditions))


@pytest.mark.needs_mujoco
def test_a_suite_can_be_carried_out_in_space() -> None:
    pytest.importorskip("mujoco")
    (outcome,) = run_suite("phia", ["vieira/simple-10"], lambda scene: None, backend="mujoco")
    assert outcome.episode.spec.backend == "mujoco"
    assert tally("phia", "vieira", [outcome]).motion_planning_time > 0.0


def test_what_cannot_be_measured_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        bench.main(["suites", "--backend", "pymonk"])
    message = capsys.readouterr().err.splitlines()[-1]
    assert "pymonk" in message
    assert "pymunk" in message
