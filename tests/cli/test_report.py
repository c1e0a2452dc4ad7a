"""``phframe report`` from a bench on disk: its files, and one line for bad input."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Sequence
from pathlib import Path

import pytest

from phframe.bench.environment import Environment
from phframe.bench.settings import BenchSettings
from phframe.bench.store import FILE, ResultStore
from phframe.bench.trial_result import TrialResult
from tests.bench.report.synthetic import synthetic
from tests.cli.conftest import Invoke, Run

pytestmark = pytest.mark.long

PLANNERS = ("phia", "ooa")


def bench(directory: str, results: Sequence[TrialResult]) -> Path:
    with ResultStore.create(directory, BenchSettings(("paper",), PLANNERS), {}) as store:
        store.add_environment(Environment({"python": "3.11.0"}, cpu="a processor"))
        for result in results:
            store.add(result)
    return Path(directory)


@pytest.fixture
def results() -> list[TrialResult]:
    return list(synthetic(PLANNERS, {"paper": 5}))


def test_the_page_is_made_anew_beside_the_results(invoke: Invoke, results: list[TrialResult]) -> None:
    bench("runs", results)
    for _ in range(2):
        done = invoke("report", "runs")
        assert done.exit_code == 0, done.stderr
        assert "wrote runs/report.html" in done.stderr
    page = Path("runs/report.html").read_text("utf-8")
    assert "phframe bench paper --planner phia --planner ooa --out runs" in page
    assert sorted(each.name for each in Path("runs").iterdir() if not each.name.startswith(FILE)) == ["report.html"]


def test_figures_markdown_and_json_on_demand(invoke: Invoke, results: list[TrialResult]) -> None:
    bench("runs", results)
    done = invoke("report", "runs", "--out", "a.html", "--figures", "figures", "--markdown", "a.md", "--json")
    assert done.exit_code == 0, done.stderr
    rows = json.loads(done.stdout)["sections"]["summary"][0]["rows"]
    assert [row["planner"] for row in rows] == ["ooa", "phia"]
    assert sum(row["trials"] for row in rows) == len(results)
    assert len(list(Path("figures").iterdir())) == 6
    assert "| planner | trials |" in Path("a.md").read_text("utf-8")
    assert not Path("runs/report.html").exists()


def test_several_benches_make_one_report(invoke: Invoke, results: list[TrialResult]) -> None:
    bench("one", [r for r in results if r.planner == "phia"])
    bench("two", [r for r in results if r.planner == "ooa"])
    done = invoke("report", "one", "two", "--out", "-")
    assert done.exit_code == 0, done.stderr
    assert done.stdout.startswith("<!doctype html>")
    assert "phframe bench replay" in done.stdout or all(r.retrieved for r in results)


def test_nothing_is_overwritten_unasked(invoke: Invoke, results: list[TrialResult]) -> None:
    bench("runs", results)
    Path("a.html").write_text("mine")
    Path("figures").mkdir()
    Path("figures/mine").write_text("mine")
    for options in (("--out", "a.html"), ("--figures", "figures"), ("--markdown", "a.html")):
        done = invoke("report", "runs", *options)
        assert done.exit_code == 2
        assert "--force" in done.stderr
    assert not Path("runs/report.html").exists()
    assert invoke("report", "runs", "--out", "a.html", "--figures", "figures", "--force").exit_code == 0
    assert Path("figures/mine").read_text() == "mine"


def newer(path: Path) -> None:
    with sqlite3.connect(path) as connection:
        connection.execute("PRAGMA user_version = 99")
    connection.close()


def damaged(path: Path) -> None:
    path.write_bytes(b"no database at all" * 100)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["nowhere"], "holds no bench"),
        (["."], "holds no bench"),
        (["empty"], "no trial has a result yet"),
        (["newer"], "format 99"),
        (["damaged"], "cannot use"),
        (["good", "nowhere"], "nowhere holds no bench"),
        (["good", "good"], "named twice"),
        (["good", "--out", "-", "--json"], "standard output"),
        (["good", "--figures", "-"], "name a directory"),
        (["good", "--out", "good/results.sqlite/x.html"], "cannot write"),
        ([], "missing argument"),
    ],
)
def test_bad_input_is_one_line(arguments: list[str], said: str, invoke: Invoke, results: list[TrialResult]) -> None:
    bench("good", results)
    bench("empty", [])
    newer(bench("newer", results) / FILE)
    damaged(bench("damaged", results) / FILE)
    done = invoke("report", *arguments)
    assert done.exit_code == 2
    (line,) = done.stderr.splitlines()
    assert line.startswith("error: ")
    assert said in line.lower() if said == "missing argument" else said in line
    assert not Path("good/report.html").exists()


def test_without_its_libraries_the_line_that_installs_them_is_told(
    run: Run, results: list[TrialResult], tmp_path: Path
) -> None:
    bench("runs", results)
    hook = (
        "import importlib.util as u\nf = u.find_spec\nu.find_spec = lambda n, *a: None if n == 'jinja2' else f(n, *a)\n"
    )
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(hook)
    done = run("report", "runs")
    assert done.returncode == 3, done.stderr
    assert "phframe[report]" in done.stderr
