"""Benches that are brought together lose nothing, hold nothing twice, and are refused where they contradict one another."""

from __future__ import annotations

import pickle
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.bench.conflicts import Accept
from phframe.bench.merge import MergeSummary, Preference, merge_benches
from phframe.bench.merge_conflicts import TIMED, MergeConflictError, ResultConflictError
from phframe.bench.store import FILE, ResultStore, StoreError
from phframe.bench.trial_result import TrialResult
from phframe.core import InputError, Loop
from tests.bench.synthetic import ENVIRONMENT, SETTINGS, hostile_result, synthetic_result, written_store

NUMBERS = st.sets(st.integers(0, 40), max_size=8)
few = settings(max_examples=12)


@pytest.fixture
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("benches")


def of(numbers: set[int]) -> list[TrialResult]:
    return [synthetic_result(number) for number in sorted(numbers)]


def results(directory: Path) -> list[TrialResult]:
    with ResultStore.open(directory) as store:
        return list(store.results())


def held(directory: Path) -> tuple[Any, ...]:
    """All that a bench says, in no order but that of its results."""
    with ResultStore.open(directory) as store:
        asked = store.settings
        sizes = set(asked.suites), set(asked.planners), replace(asked, suites=("all",), planners=("all",))
        return list(store.results()), store.environments(), store.problems(), sizes


def again(result: TrialResult) -> TrialResult:
    """The result of a repetition on another machine at another time."""
    times = {name: 99.0 for name in TIMED if name.endswith("_time")}
    return replace(result, **times, peak_memory=1, started="2027-01-01T00:00:00Z", environment="elsewhere")  # type: ignore[arg-type]


@pytest.mark.slow
@few
@given(NUMBERS, NUMBERS)
def test_disjoint_benches_give_the_same_in_any_order(
    tmp_path_factory: pytest.TempPathFactory, one: set[int], other: set[int]
) -> None:
    folder = tmp_path_factory.mktemp("benches")
    a, b = written_store(folder / "a", of(one)), written_store(folder / "b", of(other - one))
    summary = merge_benches([a, b], folder / "ab")
    assert merge_benches([b, a], folder / "ba") == summary == MergeSummary(len(one | other), 0)
    assert held(folder / "ab") == held(folder / "ba")
    assert sorted(each.key for each in results(folder / "ab")) == [each.key for each in of(one | other)]


@pytest.mark.slow
@few
@given(NUMBERS, NUMBERS)
def test_to_merge_again_what_is_in_changes_nothing(
    tmp_path_factory: pytest.TempPathFactory, one: set[int], other: set[int]
) -> None:
    folder = tmp_path_factory.mktemp("benches")
    a, b = written_store(folder / "a", of(one)), written_store(folder / "b", [again(each) for each in of(other)])
    assert merge_benches([a, b], folder / "ab").shared == len(one & other)
    merge_benches([folder / "ab", a, b, folder / "ab"], folder / "more")
    assert held(folder / "more") == held(folder / "ab")
    assert {each.key: each for each in results(folder / "ab")}.items() >= {each.key: each for each in of(one)}.items()


@pytest.mark.slow
@few
@given(NUMBERS, NUMBERS, NUMBERS)
def test_merging_is_associative(
    tmp_path_factory: pytest.TempPathFactory, one: set[int], two: set[int], three: set[int]
) -> None:
    folder = tmp_path_factory.mktemp("benches")
    a, b, c = (written_store(folder / str(n), of(each)) for n, each in enumerate((one, two, three)))
    merge_benches([a, b], folder / "ab")
    merge_benches([folder / "ab", c], folder / "left")
    merge_benches([a, b, c], folder / "at once")
    assert held(folder / "left") == held(folder / "at once")


def contents(directory: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in directory.iterdir()}


def test_the_benches_given_stay_as_they_are(folder: Path) -> None:
    a, b = written_store(folder / "a", of({1, 2})), written_store(folder / "b", [hostile_result()])
    before = contents(a), contents(b)
    merge_benches([a, b], folder / "ab")
    assert (contents(a), contents(b)) == before
    assert hostile_result() in results(folder / "ab")
    assert sorted(path.name for path in folder.iterdir()) == ["a", "ab", "b"]
    assert [path.name for path in (folder / "ab").iterdir()] == [FILE]


def contradicting(folder: Path) -> tuple[list[Path], TrialResult, TrialResult]:
    here = replace(synthetic_result(3), pushes=2, reason="too far")
    there = replace(again(here), pushes=5)
    return [written_store(folder / "a", [here]), written_store(folder / "b", [there])], here, there


def test_a_trial_that_came_out_differently_is_refused_and_nothing_written(folder: Path) -> None:
    benches, here, _ = contradicting(folder)
    with pytest.raises(ResultConflictError) as refused:
        merge_benches(benches, folder / "ab")
    (difference,) = refused.value.differences
    assert (difference.key, difference.first, difference.second) == (here.key, "2", "5")
    assert f"pushes of {here.planner} on {here.problem} with seed 0 is 2 and 5" in str(refused.value)
    assert "--prefer first or --prefer last" in str(refused.value)
    assert sorted(path.name for path in folder.iterdir()) == ["a", "b"]
    assert pickle.loads(pickle.dumps(refused.value)).differences == refused.value.differences


@pytest.mark.parametrize(("prefer", "taken"), [(Preference.FIRST, 0), (Preference.LAST, 1)])
def test_the_preferred_result_is_taken(folder: Path, prefer: Preference, taken: int) -> None:
    benches, *both = contradicting(folder)
    merge_benches(benches, folder / "ab", prefer=prefer)
    assert results(folder / "ab") == [both[taken]]


def test_of_many_differences_a_few_are_told_and_all_counted(folder: Path) -> None:
    a = written_store(folder / "a", of(set(range(9))))
    b = written_store(folder / "b", [replace(each, pushes=99, replans=99) for each in of(set(range(9)))])
    with pytest.raises(ResultConflictError, match="and 14 more") as refused:
        merge_benches([a, b], folder / "ab")
    assert (len(refused.value.differences), refused.value.count) == (4, 18)


def with_settings(folder: Path, **changed: Any) -> list[Path]:
    return [written_store(folder / "a", []), written_store(folder / "b", [], replace(SETTINGS, **changed))]


@pytest.mark.parametrize(
    "changed",
    [{"backend": "mujoco"}, {"loop": Loop(time_limit=5.0)}, {"memory_limit": 100}, {"noise": {"position": 0.1}}],
)
def test_other_settings_are_refused_and_where_accepted_the_first_ones_count(folder: Path, changed: Any) -> None:
    benches = with_settings(folder, **changed)
    with pytest.raises(MergeConflictError, match=r"differ \(options: .* was .*, is .*--accept options"):
        merge_benches(benches, folder / "ab")
    with pytest.raises(MergeConflictError):
        merge_benches(benches, folder / "ab", accept=[Accept.VERSIONS])
    merge_benches(benches, folder / "ab", accept=[Accept.OPTIONS])
    with ResultStore.open(folder / "ab") as store:
        assert store.settings == SETTINGS


def test_suites_planners_and_seeds_of_all_count(folder: Path) -> None:
    benches = with_settings(folder, suites=("papallas", "vieira"), planners=("random", "phia"), seeds=7)
    merge_benches(benches, folder / "ab")
    with ResultStore.open(folder / "ab") as store:
        expected = replace(SETTINGS, suites=("vieira", "papallas"), planners=("phia", "ooa", "random"), seeds=7)
        assert store.settings == expected


@pytest.mark.parametrize(
    ("kind", "changed", "told"),
    [
        (Accept.VERSIONS, {"versions": {"phframe": "0.2.0", "only-there": "1"}}, "phframe was 0.1.0, is 0.2.0"),
        (Accept.CODE, {"code": {"phframe": "other", "only-there": "1"}}, "the source of phframe is another one"),
        (Accept.MACHINE, {"cpu": "Another"}, "cpu was A processor, is Another"),
    ],
)
def test_other_surroundings_are_told_and_may_be_accepted(folder: Path, kind: Accept, changed: Any, told: str) -> None:
    a, b = written_store(folder / "a", of({1})), written_store(folder / "b", of({2}))
    other = replace(ENVIRONMENT, **changed)
    with ResultStore.open(b, read_only=False) as store:
        store.add_environment(other)
    with pytest.raises(MergeConflictError) as refused:
        merge_benches([a, b], folder / "ab")
    assert [(each.kind, each.what) for each in refused.value.differences] == [(kind, told)]
    assert f"--accept {kind};" in str(refused.value)
    assert pickle.loads(pickle.dumps(refused.value)).differences == refused.value.differences
    merge_benches([a, b], folder / "ab", accept=[kind])
    with ResultStore.open(folder / "ab") as store:
        assert store.environments() == {ENVIRONMENT.id: ENVIRONMENT, other.id: other}
    merge_benches([folder / "ab", b, a], folder / "again")


def test_other_scenes_of_one_name_are_refused(folder: Path) -> None:
    a, b = written_store(folder / "a", of({1})), written_store(folder / "b", of({2}))
    for directory, digest in ((a, "aa"), (b, "bb")):
        with ResultStore.open(directory, read_only=False) as store:
            store.set_plan(store.settings, store.done(), {"vieira/basic": digest, directory.name: digest})
    with pytest.raises(MergeConflictError, match=r"suites: changed: vieira/basic\).*--accept suites"):
        merge_benches([a, b], folder / "ab")
    merge_benches([a, b], folder / "ab", accept=[Accept.SUITES])
    with ResultStore.open(folder / "ab") as store:
        assert store.problems() == {"vieira/basic": "aa", "a": "aa", "b": "bb"}


def test_results_on_two_scenes_of_one_name_are_not_mixed(folder: Path) -> None:
    benches = []
    for name, numbers in (("aa", {1, 5}), ("bb", {1, 2, 9})):
        directory = folder / name
        with ResultStore.create(directory, SETTINGS, {"random/000": name}) as store:
            store.add_environment(ENVIRONMENT)
            assert all(store.add(replace(result, pushes=len(numbers))) for result in of(numbers))
        benches.append(directory)
    assert merge_benches(benches, folder / "ab", accept=[Accept.SUITES]) == MergeSummary(3, 0, 2)
    assert {each.key: each.pushes for each in results(folder / "ab")} == {
        synthetic_result(number).key: pushes for number, pushes in ((1, 2), (5, 2), (9, 3))
    }


def test_what_is_no_bench_and_a_directory_in_use_are_refused(folder: Path) -> None:
    benches: Sequence[Path] = [written_store(folder / "a", of({1})), folder / "nothing"]
    with pytest.raises(StoreError, match="holds no bench"):
        merge_benches(benches, folder / "ab")
    (folder / "ab").mkdir()
    (folder / "ab" / "thesis.tex").write_text("years of work")
    with pytest.raises(InputError, match="not empty"):
        merge_benches([benches[0], benches[0]], folder / "ab")
    assert sorted(path.name for path in folder.iterdir()) == ["a", "ab"]
    (folder / "empty").mkdir()
    merge_benches([benches[0], benches[0]], folder / "empty")
    assert results(folder / "empty") == of({1})


def test_the_fault_of_a_trial_comes_along(folder: Path) -> None:
    a, b = written_store(folder / "a", []), written_store(folder / "b", of({2}))
    with ResultStore.open(a, read_only=False) as store:
        store.add(synthetic_result(1), fault="Traceback: it divided by zero")
    merge_benches([a, b], folder / "ab")
    with ResultStore.open(folder / "ab") as store:
        assert store.fault(synthetic_result(1).key) == "Traceback: it divided by zero"
