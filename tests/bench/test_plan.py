"""Which trials a bench has, and what changes them: nothing new may change results unnoticed."""

from __future__ import annotations

from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import pytest

import phframe
from phframe.bench.bench_plan import BenchPlan
from phframe.bench.conflicts import (
    KIND_OF,
    Accept,
    BenchDifference,
    environment_differences,
    problem_differences,
    refused,
    setting_differences,
)
from phframe.bench.environment import Environment
from phframe.bench.selection import select_problems
from phframe.bench.settings import BenchSettings
from phframe.bench.surroundings import _own_files, code_files, surroundings
from phframe.core import InputError, Loop, OptionError, RunSpec, UnknownNameError
from tests.bench.benches import misbehaving, settings

CHANGES_RESULTS: dict[Any, dict[str, Any]] = {
    RunSpec: {
        "scene": "random/1", "planner": "ooa", "backend": "x", "arm": "x", "plan_backend": "x", "plan_arm": "x",
        "topology": "x", "goal": "x", "options": {"arm": {"x": 1}}, "seed": 1, "loop": Loop(1), "noise": {"position": 0.1},
    },
    Loop: {"max_replans": 1, "tolerance": 0.5, "time_limit": 1.0, "simulations": 5},
}  # fmt: skip
"""Of each field that changes what comes of a trial, another value."""
CHANGES_NOTHING: dict[Any, dict[str, Any]] = {RunSpec: {"workers": 4}, Loop: {}}


@pytest.mark.parametrize("cls", [RunSpec, Loop])
def test_every_field_of_a_run_is_classed_as_changing_results_or_not(cls: type[Any]) -> None:
    changing, idle = CHANGES_RESULTS[cls], CHANGES_NOTHING[cls]
    assert {field.name for field in fields(cls)} == {*changing, *idle}, "class the new field above"
    for name, value in {**changing, **idle}.items():
        one = cls()
        other = replace(one, **{name: value})
        keys = [each.key() if cls is RunSpec else RunSpec(loop=each).key() for each in (one, other)]
        assert (keys[0] != keys[1]) is (name in changing), name


def test_every_setting_is_classed_by_what_accepts_that_it_differs() -> None:
    assert {field.name for field in fields(BenchSettings)} == set(KIND_OF), "class the new setting in KIND_OF"


OTHER: dict[str, Any] = {
    "planners": ("ooa",), "backend": "x", "arm": "x", "plan_backend": "x", "plan_arm": "x", "topology": "x", "goal": "x",
    "options": {"arm": {"x": 1}}, "seeds": 2, "loop": Loop(simulations=1), "noise": {"position": 0.1}, "memory_limit": 999,
    "trial_limit": 9.0,
}  # fmt: skip


@pytest.mark.parametrize("name", [field.name for field in fields(BenchSettings) if KIND_OF[field.name]])
def test_a_setting_that_differs_is_a_typed_difference_that_its_flag_accepts(name: str) -> None:
    before, now = settings(), settings(**{name: OTHER[name]})
    found = list(setting_differences(before, now))
    assert {each.kind for each in found} == {KIND_OF[name]}
    assert refused(found, ()) == found
    assert refused(found, [each for each in Accept if each is not KIND_OF[name]]) == found
    assert refused(found, [found[0].kind]) == []
    assert list(setting_differences(before, before)) == []


def test_differences_say_what_is_new_missing_or_changed() -> None:
    found = problem_differences({"a/1": "x", "a/2": "x", "a/3": "x"}, {"a/1": "x", "a/3": "y", "b/1": "x"})
    assert [each.what for each in found] == ["new: b/1", "missing: a/2", "changed: a/3"]
    before = Environment({"numpy": "1", "old": "3"}, "c1", {"phframe": "a"}, cpu="x", cores=2)
    now = Environment({"numpy": "2", "new": "4"}, "c2", {"phframe": "b"}, cpu="x", cores=4)
    assert list(environment_differences(before, now)) == [
        BenchDifference(Accept.VERSIONS, "numpy was 1, is 2"),
        BenchDifference(Accept.VERSIONS, "old was 3, is none"),
        BenchDifference(Accept.VERSIONS, "new was none, is 4"),
        BenchDifference(Accept.CODE, "the source of phframe is another one"),
        BenchDifference(Accept.MACHINE, "cores was 2, is 4"),
    ]
    assert list(environment_differences(before, replace(before, commit="c2"))) == []


def test_every_planner_meets_every_problem_with_every_seed_once() -> None:
    plan = BenchPlan.of(settings("vieira/simple-0[12]", planners=("phia", "ooa[margin=0.02]"), seeds=2))
    trials = list(plan.trials())
    assert len(trials) == len(plan) == 8 == len({trial.key for trial in trials})
    assert [(each.spec.seed, each.problem, each.planner) for each in trials] == [
        (seed, f"vieira/simple-0{number}", planner)
        for seed in (0, 1)
        for number in (1, 2)
        for planner in ("phia", "ooa[margin=0.02]")
    ]
    assert all(RunSpec.from_json(trial.spec.to_json()).key() == trial.key for trial in trials)
    assert set(plan.digests) == {"vieira/simple-01", "vieira/simple-02"}
    assert plan.digests["vieira/simple-01"] != plan.digests["vieira/simple-02"]


def test_settings_are_kept_as_what_they_mean() -> None:
    options = {"planner": {"margin": "0.02"}, "backend": {"step": "0.002"}, "scenes": {"count": "4"}}
    asked = settings("random/1", planners=("ooa", "phia[margin=0.03]"), options=options)
    plan = BenchPlan.of(asked)
    assert plan.settings.planners == ("ooa[margin=0.02]", "phia[margin=0.03]")
    assert plan.settings.options == {"backend": {"step": 0.002}, "scenes": {"count": 4}}
    assert (plan.settings.plan_backend, plan.settings.plan_arm) == ("pymunk", "planar")
    again = BenchPlan.of(plan.settings)
    assert again.settings == plan.settings
    assert [trial.key for trial in again.trials()] == [trial.key for trial in plan.trials()]


@pytest.mark.parametrize(
    ("asked", "names"),
    [
        (["vieira/basic", "vieira/b*", "vieira/basic"], ["vieira/basic"]),
        (["random/8..11"], ["random/8", "random/9", "random/10", "random/11"]),
        (["papallas/s08..10"], ["papallas/s08", "papallas/s09", "papallas/s10"]),
        (["papallas/s?1"], ["papallas/s01"]),
    ],
)
def test_problems_are_named_by_name_wildcard_and_range(asked: list[str], names: list[str]) -> None:
    assert [problem.name for problem in select_problems(asked, {})] == names


def test_a_suite_is_all_its_scenes_and_a_file_is_one() -> None:
    file = Path(__file__).parents[2] / "docs/examples/three-cups.yaml"
    problems = select_problems(["papallas", str(file)], {})
    assert [each.name for each in problems] == [*(f"papallas/s{number:02}" for number in range(1, 11)), str(file)]
    assert (problems[-1].suite, problems[-1].scene.name) == ("files", "three-cups")


@pytest.mark.parametrize("asked", ["viera", "vieira/basik", "vieira/z*", "random/x"])
def test_what_no_suite_has_is_told_with_what_it_has(asked: str) -> None:
    with pytest.raises(UnknownNameError, match="There is: "):
        select_problems([asked], {})


@pytest.mark.parametrize(
    "asked",
    ["random/5..4", "random/0..99999999", "random/0..99999999999999999999", f"random/{'9' * 5000}..{'9' * 5000}"],
    ids=lambda asked: asked[:20],
)
def test_a_range_that_is_none_is_refused(asked: str) -> None:
    with pytest.raises(InputError, match=r"write it as in random/0\.\.99") as told:
        select_problems([asked], {})
    assert len(str(told.value)) < 200


def test_the_same_planner_twice_is_refused_whatever_it_is_called() -> None:
    with pytest.raises(OptionError, match=r"phia\[margin=0\.0\] is the same as one before it, phia\[margin=0\]"):
        BenchPlan.of(settings(planners=("phia[margin=0]", "phia[margin=0.0]")))


@pytest.mark.parametrize(
    "wrong",
    [
        {"seeds": 0},
        {"seeds": 10**20},
        {"memory_limit": 10**20},
        {"planners": ()},
        {"memory_limit": 0},
        {"trial_limit": 0.0},
        {"trial_limit": float("nan")},
    ],
)
def test_settings_out_of_range_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        settings(**wrong)


def test_where_nothing_is_said_a_trial_has_its_planning_time_and_half_of_it_and_a_minute() -> None:
    assert settings(loop=Loop(time_limit=300.0)).kill_after == 510.0
    assert settings(trial_limit=9.0).kill_after == 9.0


def test_code_is_all_that_a_package_holds_but_what_python_keeps_of_it(tmp_path: Path) -> None:
    for name in ("__init__.py", "data/table.csv", "__pycache__/__init__.pyc", "data/__pycache__/x.txt", "old.pyc"):
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).touch()
    assert code_files(tmp_path) == [tmp_path / "__init__.py", tmp_path / "data/table.csv"]


def test_the_code_of_phframe_is_what_may_change_results() -> None:
    root = Path(phframe.__file__).parent
    names = {path.relative_to(root).as_posix() for path in _own_files()}
    assert {"core/task.py", "bench/judge.py", "bench/child.py"} <= names
    assert any(name.startswith("scenes/data/") for name in names)
    idle = ("cli/", "bench/report/", "bench/export/", "bench/merge", "bench/statistics", "bench/summary")
    assert [name for name in names if name.startswith(idle)] == []


def test_the_surroundings_name_versions_code_and_machine() -> None:
    plan = BenchPlan.of(settings(planners=("phia", misbehaving("Decent"))))
    found = surroundings(plan.specs.values())
    assert {"python", "phframe", "pymunk", "ripser"} <= set(found.versions)
    assert {name.rpartition("/")[2] for name in found.code} == {"phframe", "misbehaving.py"}
    assert found.cores > 0
    assert found == surroundings(plan.specs.values()) == Environment.from_json(found.to_json())
    assert found.id == Environment.from_json(found.to_json()).id
