"""``phframe bench replay``: a trial is repeated and compared, code of files only where it is given."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from phframe.bench.store import FILE, ResultStore
from tests.bench.benches import misbehaving
from tests.cli.bench_runs import HERE
from tests.cli.conftest import Invoke

pytestmark = pytest.mark.long


@pytest.mark.slow
def test_a_trial_is_repeated_and_compared(invoke: Invoke, finished: Path) -> None:
    same = invoke("bench", "replay", finished, "vieira/simple-02", "ooa", "0", "--no-rerun")
    assert (same.exit_code, same.stdout) == (0, "the same: retrieved, pushes 3\n")
    (folder,) = Path("runs").iterdir()
    assert {path.name for path in folder.iterdir()} == {"episode.json", "summary.json"}
    with ResultStore.open(finished) as store:
        (result,) = store.find("vieira/simple-01", "phia", "0")
        key, pushes = result.key, result.pushes
    lie = Path("lie")
    lie.mkdir()
    (lie / FILE).write_bytes((finished / FILE).read_bytes())
    with ResultStore.open(lie, read_only=False) as store:
        store._connection.execute("UPDATE results SET pushes = 9 WHERE key = ?", (key,))
    other = invoke("bench", "replay", lie, key[:8], "--no-rerun", "--json")
    assert other.exit_code == 1
    assert json.loads(other.stdout)["differences"] == {"pushes": [9, pushes]}


@pytest.mark.slow
def test_a_planner_in_a_file_is_repeated_only_if_it_is_given(invoke: Invoke) -> None:
    name = misbehaving("Raises")
    assert invoke("bench", "vieira/simple-01", "--planner", name, *HERE).exit_code == 1
    words = ("bench", "replay", "here", "vieira/simple-01", name, "0", "--no-rerun")
    refused = invoke(*words)
    assert refused.exit_code == 2
    assert f"give it yourself, as in --planner {name}" in refused.stderr
    same = invoke(*words, "--planner", name)
    assert (
        same.exit_code,
        same.stdout.startswith("the same: error (planner 'Raises' raised RuntimeError: no idea"),
    ) == (0, True)
    assert "Traceback" in same.stderr
    assert "is not the planner of the trial" in invoke(*words, "--planner", "phia").stderr


@pytest.mark.slow
def test_any_part_in_a_file_is_repeated_only_if_it_is_given(invoke: Invoke) -> None:
    Path("goals.py").write_text("from phframe.pushing.retrieve import Retrieve\nclass Mine(Retrieve):\n    pass\n")
    name = "./goals.py:Mine"
    assert invoke("bench", "vieira/simple-01", "--planner", "phia", "--goal", name, *HERE).exit_code == 0
    words = ("bench", "replay", "here", "vieira/simple-01", "phia", "0", "--no-rerun")
    refused = invoke(*words)
    assert refused.exit_code == 2
    assert f"give it yourself, as in --goal {name}" in refused.stderr
    assert invoke(*words, "--goal", name).stdout.startswith("the same: ")
    assert "is not the plan backend of the trial" in invoke(*words, "--plan-backend", "mujoco").stderr
