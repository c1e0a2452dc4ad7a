"""``phframe bench merge``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from phframe.bench.store import ResultStore
from tests.bench.synthetic import SETTINGS, synthetic_result, synthetic_results, written_store
from tests.cli.conftest import Invoke


def pushes(directory: str) -> list[int]:
    with ResultStore.open(directory) as store:
        return [result.pushes for result in store.results()]


def test_two_benches_become_one(invoke: Invoke, workplace: Path) -> None:
    written_store(workplace / "a", list(synthetic_results(6)))
    written_store(workplace / "b", list(synthetic_results(9)))
    result = invoke("bench", "merge", "a", "b", "--out", "both")
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr == "wrote both: 9 results; 6 that a later bench brought again are in it once\n"
    assert len(pushes("both")) == 9


def test_which_result_counts_is_asked_for(invoke: Invoke, workplace: Path) -> None:
    written_store(workplace / "a", [replace(synthetic_result(0), pushes=1)])
    written_store(workplace / "b", [replace(synthetic_result(0), pushes=2)])
    refused = invoke("bench", "merge", "a", "b", "--out", "both")
    assert (refused.exit_code, len(refused.stderr.splitlines())) == (2, 1)
    assert "pushes of phia on random/000 with seed 0 is 1 and 2" in refused.stderr
    for which, taken in (("first", 1), ("last", 2)):
        assert invoke("bench", "merge", "a", "b", "--prefer", which, "--out", which).exit_code == 0
        assert pushes(which) == [taken]


def test_a_difference_is_accepted_by_the_flag_that_is_told(invoke: Invoke, workplace: Path) -> None:
    written_store(workplace / "a", [])
    written_store(workplace / "b", [], replace(SETTINGS, backend="mujoco"))
    refused = invoke("bench", "merge", "a", "b", "--out", "both")
    assert refused.exit_code == 2
    assert "options: backend was pymunk, is mujoco" in refused.stderr
    assert "--accept options" in refused.stderr
    assert invoke("bench", "merge", "a", "b", "--out", "both", "--accept", "options").exit_code == 0


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["a", "--out", "both"], "name two or more"),
        (["a", "nothing", "--out", "both"], "nothing holds no bench"),
        (["a", "a", "--out", "a"], "a is not empty"),
        (["a", "a", "--out", "both", "--accept", "option"], "Did you mean 'options'?"),
        (["a", "a", "--out", "both", "--prefer", "lst"], "Did you mean 'last'?"),
        (["a", "a"], "--out"),
    ],
)
def test_bad_input_is_told_in_a_line(invoke: Invoke, workplace: Path, arguments: list[str], told: str) -> None:
    written_store(workplace / "a", [synthetic_result(0)])
    result = invoke("bench", "merge", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert told in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert [path.name for path in workplace.iterdir()] == ["a"]
