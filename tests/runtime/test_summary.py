"""The summary has exactly the agreed keys, and says what the episode says."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from phframe.core import Condition, Episode, Status
from phframe.runtime.solve import solve
from phframe.runtime.summary import summarize
from tests.runtime.worlds import BASIC

KEYS = [
    *(
        "format",
        "scene",
        "planner",
        "variant",
        "backend",
        "arm",
        "plan_backend",
        "plan_arm",
        "topology",
        "goal",
        "seed",
    ),
    "noise",
    *("status", "reason", "actions", "planning_time", "motion_planning_time", "execution_time", "simulated_actions"),
    *("replans", "toppled", "spilled", "target_moved", "tracking_error", "prediction_error", "wall_contact", "clean"),
    *("recording", "versions"),
]
EPISODE = solve(BASIC, seed=2)


def with_condition(name: str, condition: Condition) -> Episode:
    """The episode, had an object come to something in the last step."""
    last = EPISODE.steps[-1]
    conditions = list(last.after.conditions)
    conditions[BASIC.index(name)] = condition
    after = replace(last.after, conditions=tuple(conditions))
    return replace(EPISODE, steps=(*EPISODE.steps[:-1], replace(last, after=after)))


def test_the_keys_are_the_agreed_ones_and_the_values_are_plain() -> None:
    summary = summarize(EPISODE, Path("a") / "b.rrd")
    assert list(summary) == KEYS
    assert json.loads(json.dumps(summary, allow_nan=False)) == summary
    assert {type(value) for value in summary.values()} <= {int, str, float, bool, list, dict}
    assert summarize(EPISODE)["recording"] is None
    assert summary["recording"] == str(Path("a") / "b.rrd")


def test_the_values_are_the_episodes() -> None:
    summary = summarize(EPISODE)
    assert (summary["format"], summary["scene"], summary["seed"]) == (1, "vieira/basic", 2)
    assert (summary["status"], summary["reason"], summary["clean"]) == ("retrieved", "", True)
    assert summary["actions"] == len(EPISODE.steps) - 1, "the grasp is not counted"
    assert summary["replans"] == 0
    assert summary["planning_time"] == sum(plan.cost.total for plan in EPISODE.plans)
    assert summary["execution_time"] == pytest.approx(sum(step.motion.duration for step in EPISODE.steps))
    assert summary["simulated_actions"] == EPISODE.plans[0].cost.simulated_actions
    row, last = BASIC.target_index, EPISODE.steps[-1].before
    moved = float(((last.poses[row, :3] - BASIC.initial_state().poses[row, :3]) ** 2).sum() ** 0.5)
    assert summary["target_moved"] == pytest.approx(moved)
    assert summary["target_moved"] < 0.05 < EPISODE.final_state.displacement(BASIC.initial_state())[row]


def test_what_toppled_and_spilled_is_named_and_not_clean() -> None:
    toppled = summarize(with_condition("object_3", Condition.TOPPLED))
    assert (toppled["toppled"], toppled["spilled"], toppled["clean"]) == (["object_3"], [], False)
    spilled = summarize(with_condition("object_3", Condition.SPILLED))
    assert (spilled["toppled"], spilled["spilled"], spilled["clean"]) == ([], ["object_3"], False)


def test_a_failure_has_its_reason_and_a_float_for_every_figure() -> None:
    failed = solve("vieira/basic", options={"planner": {"max_actions": 1}})
    summary = summarize(failed)
    assert (summary["status"], summary["actions"], summary["clean"]) == ("failed", 0, False)
    assert summary["reason"] == "the corridor is not empty after 1 actions"
    assert isinstance(summary["execution_time"], float)
    assert isinstance(summary["target_moved"], float)
    assert summary["status"] in {str(status) for status in Status}
