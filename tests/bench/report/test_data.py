"""Results are sorted into groups in which planners can be compared, and nothing else is mixed."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from phframe.bench.report.data import ALL, BenchSource, ReportData, gather
from phframe.bench.trial_result import TrialResult
from phframe.core import InputError, RunSpec
from tests.bench.report.synthetic import synthetic


def few(**more: object) -> list[TrialResult]:
    wanted = {"planners": ("phia", "ooa"), "suites": {"paper": 3, "dense": 2}, **more}
    return list(synthetic(**wanted))  # type: ignore[arg-type]


def gathered(*sources: list[TrialResult]) -> ReportData:
    return gather([BenchSource(f"runs/{i}", tuple(rows)) for i, rows in enumerate(sources)])


def changed(result: TrialResult, key: str, **fields: object) -> TrialResult:
    return replace(result, key=key, spec=json.dumps({**json.loads(result.spec), **fields}))


def test_suites_are_kept_apart_and_told_together() -> None:
    data = gathered(few())
    assert [(group.suite, {n: len(of) for n, of in group.by_planner.items()}) for group in data.groups] == [
        (ALL, {"ooa": 5, "phia": 5}), ("dense", {"ooa": 2, "phia": 2}), ("paper", {"ooa": 3, "phia": 3}),
    ]  # fmt: skip
    assert len(data.results) == 10
    assert [group.suite for group in gathered(few(suites={"paper": 3})).groups] == ["paper"]


def test_engines_and_arms_are_settings_of_their_own() -> None:
    data = gathered(few(), few(backend="mujoco", arm="baxter"))
    assert [name for name, _ in data.settings] == ["mujoco with baxter, planned in pymunk", "pymunk with planar"]


@pytest.mark.parametrize(
    ("fields", "name"),
    [
        ({"topology": "single-linkage"}, "topology single-linkage"),
        ({"noise": {"position": 0.005}}, "noise.position 0.005"),
        ({"options": {"arm": {"link_width": 0.1}}}, "arm.link_width 0.1"),
        ({"loop": {"max_replans": 3, "time_limit": 60.0}}, "loop.max_replans 3"),
    ],
)
def test_whatever_else_of_a_run_differs_makes_a_setting(fields: dict[str, object], name: str) -> None:
    rows = few()
    other = [changed(row, f"other{i}", **fields) for i, row in enumerate(rows)]
    names = [setting for setting, _ in gathered(rows, other).settings]
    assert len(names) == 2
    assert any(name in each for each in names)


def test_options_of_planners_and_workers_make_no_setting() -> None:
    rows = few()
    other = [changed(row, f"other{i}", workers=4, options={"planner": {"margin": 0.1}}) for i, row in enumerate(rows)]
    assert len(gathered(rows, other).settings) == 1


def test_a_planner_with_two_limits_is_two_planners() -> None:
    data = gathered(few(), few(planners=("phia",), time_limit=5.0))
    assert data.planners == ("ooa", "phia (5 s)", "phia (60 s)")


def test_a_trial_in_two_benches_counts_once_and_is_told() -> None:
    rows = few()
    data = gathered(rows, rows[:4])
    assert len(data.results) == len(rows)
    assert data.repeated == 4
    assert set(data.homes.values()) == {"runs/0"}


def test_no_results_are_refused_with_what_to_do() -> None:
    with pytest.raises(InputError, match=r"runs/0 and runs/1: no trial has a result yet.*Run the bench"):
        gathered([], [])


@pytest.mark.parametrize(
    "spec",
    [
        "",
        "[]",
        "{",
        "{}",
        *(json.dumps({**json.loads(RunSpec().to_json()), name: []}) for name in ("loop", "options", "noise")),
    ],
)
def test_a_run_that_cannot_be_read_is_refused(spec: str) -> None:
    with pytest.raises(InputError, match="damaged"):
        gathered([replace(few()[0], spec=spec)])
