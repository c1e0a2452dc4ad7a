"""``phframe bench``: it runs, goes on where it was, and refuses what is another bench or none."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from phframe.bench.bench_plan import BenchPlan
from phframe.bench.directory_lock import LOCK
from phframe.bench.environment import Environment
from phframe.bench.session import BenchSession
from phframe.bench.store import FILE, ResultStore
from phframe.cli.main import app
from phframe.core import RunSpec
from tests.bench.benches import a_result, misbehaving, settings
from tests.cli.bench_runs import HERE, SMALL, rows
from tests.cli.conftest import Invoke, Run

pytestmark = pytest.mark.long


@pytest.mark.slow
def test_it_runs_and_goes_on_and_does_nothing_twice(invoke: Invoke, finished: Path) -> None:
    first = invoke(*SMALL, *HERE, "--filter", "phia", "--json")
    assert (first.exit_code, first.stderr) == (0, "results in here: 3 of 6 trials to run\n")
    (line,) = json.loads(first.stdout)["summary"]
    assert (line["planner"], line["suite"], line["trials"], line["retrieved"], line["failures"]) == (
        "phia",
        "vieira",
        3,
        3,
        0,
    )
    rest = invoke(*SMALL, *HERE)
    assert rest.stderr == "results in here: 3 of 6 trials to run\n"
    assert [row.split()[:4] for row in rest.stdout.splitlines()[1:]] == [
        ["ooa", "vieira", "3", "3"], ["phia", "vieira", "3", "3"],
    ]  # fmt: skip
    assert rows("here") == rows(finished)
    assert "0 of 6 trials to run" in invoke(*SMALL, *HERE).stderr
    assert sorted(path.name for path in Path("here").iterdir()) == ["lock", FILE]


@pytest.mark.slow
def test_without_a_directory_a_new_one_is_made(invoke: Invoke) -> None:
    result = invoke("bench", "run", "vieira/simple-01", "--quiet")
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "")
    (folder,) = Path("runs").iterdir()
    assert folder.name.endswith("-bench-vieira-simple-01")
    assert len(rows(folder)) == 1


@pytest.mark.slow
@pytest.mark.parametrize("words", [("--time-limit", "1e10"), ("--trial-limit", "1e300"), ("--time-limit", "1.7e308")])
def test_a_limit_may_be_longer_than_a_system_can_wait(invoke: Invoke, words: tuple[str, str]) -> None:
    result = invoke("bench", "vieira/simple-01", *words, *HERE)
    assert (result.exit_code, len(rows("here"))) == (0, 1), result.stderr


@pytest.mark.slow
def test_failed_trials_make_the_exit_code_1_and_can_be_run_again(invoke: Invoke) -> None:
    words = ("bench", "vieira/simple-01", "--planner", misbehaving("Exits"), "--planner", "phia", *HERE)
    assert invoke(*words).exit_code == 1
    assert "0 of 2 trials" in invoke(*words).stderr
    assert "1 of 2 trials" in invoke(*words, "--retry-failed").stderr
    assert "0 of 2 trials" in invoke(*words, "--retry-failed", "--filter", "memory").stderr
    assert "1 of 2 trials" in invoke(*words, "--retry-failed", "--filter", "exit code 3").stderr


def test_the_list_says_what_is_done_and_runs_nothing(invoke: Invoke, finished: Path, workplace: Path) -> None:
    plain = invoke(*SMALL, "--list", "--json")
    assert [each["done"] for each in json.loads(plain.stdout)["trials"]] == [False] * 6
    assert list(workplace.iterdir()) == []
    listed = invoke(*SMALL, "--list", "--out", finished, "--filter", "*simple-0?", "--planner", "phia[margin=0.02]")
    lines = [line.split() for line in listed.stdout.splitlines()]
    assert lines[0][:2] == ["trial", "problem"]
    assert [line[4:] for line in lines[1:4]] == [["finished", "retrieved"], ["finished", "retrieved"], ["to", "do"]]


@pytest.mark.parametrize(
    ("words", "said", "flags"),
    [
        (["vieira/simple-0[12]", "--planner", "phia", "--planner", "ooa"], "missing: vieira/simple-03", "suites"),
        (["vieira/simple-0[123]", "--planner", "phia"], "missing: ooa", "planners"),
        ([*SMALL[1:], "--option", "backend.step=0.002"], "backend.step was none, is 0.002", "options"),
        ([*SMALL[1:], "--time-limit", "9"], "time_limit was 300.0, is 9.0", "options"),
        ([*SMALL[1:], "--seeds", "2"], "seeds was 1, is 2", "options"),
    ],
)
def test_another_bench_is_refused_with_the_flag_that_accepts_it(
    invoke: Invoke, finished: Path, words: list[str], said: str, flags: str
) -> None:
    before = rows(finished)
    result = invoke("bench", *words, "--out", finished)
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert f"{said}" in result.stderr
    assert f"--accept {flags};" in result.stderr
    assert rows(finished) == before


def test_other_versions_and_code_are_refused_until_they_are_accepted(
    invoke: Invoke, finished: Path, tmp_path: Path
) -> None:
    copy = tmp_path / "copy"
    copy.mkdir()
    (copy / FILE).write_bytes((finished / FILE).read_bytes())
    with ResultStore.open(copy, read_only=False) as store:
        ((number, here),) = store.environments().items()
        content = here.to_json().replace(f'"pymunk": "{here.versions["pymunk"]}"', '"pymunk": "0.1"')
        content = content.replace(here.code["phframe"], "0" * 16)
        store._connection.execute("UPDATE environments SET id = 'old', content = ? WHERE id = ?", (content, number))
    refused = invoke(*SMALL, "--out", copy)
    assert refused.exit_code == 2
    assert "versions: pymunk was 0.1, is 7" in refused.stderr
    assert "code: the source of phframe is another one" in refused.stderr
    assert "--accept versions --accept code;" in refused.stderr
    assert invoke(*SMALL, "--out", copy, "--accept", "versions").exit_code == 2
    assert invoke(*SMALL, "--out", copy, "--accept", "versions", "--accept", "code").exit_code == 0
    assert invoke(*SMALL, "--out", copy).exit_code == 0


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["viera"], "Did you mean 'vieira'?"),
        (["vieira/basik"], "Did you mean 'vieira/basic'?"),
        (["vieira/z*"], "There is: vieira/basic"),
        (["random/9..1"], "random/0..99"),
        (["absent.yaml"], "absent.yaml: no such file"),
        (["vieira", "--planner", "phiaa"], "Did you mean 'phia'?"),
        (["vieira", "--planner", "phia[margn=1]"], "Did you mean 'margin'?"),
        (["vieira", "--planner", "phia[margin]"], "write name[key=value"),
        (["vieira", "--planner", "phia", "--planner", "phia"], "keep one"),
        (["vieira", "--planner", "./absent.py:Mine"], "absent.py"),
        (["vieira", "--option", "backnd.step=1"], "Did you mean 'backend'?"),
        (["vieira", "--backend", "pymonk"], "Did you mean 'pymunk'?"),
        (["vieira", "--workers", "0"], "greater than or equal to 1"),
        (["vieira", "--seeds", "0"], "greater than or equal to 1"),
        (["vieira", "--memory-limit", "1"], "greater than or equal to 256"),
        (["vieira", "--workers", "9" * 20], "4096"),
        (["vieira", "--seeds", "9" * 20], "1000000"),
        (["vieira", "--memory-limit", "9" * 20], "1073741824"),
        (["random/0.." + "9" * 20], "write it as in random/0..99"),
        (["random/" + "9" * 5000], "random"),
        (["vieira", "--trial-limit", "inf"], "not a finite number"),
        (["vieira", "--accept", "version"], "Did you mean 'versions'?"),
        (["--planner", "phia"], "missing argument 'SUITE...'"),
        (["replay", "absent", "k"], "holds no bench"),
        (["replay", "absent", "a", "b"], "three words"),
    ],
    ids=lambda value: " ".join(value)[:60] if isinstance(value, list) else "",
)
def test_bad_input_is_one_clear_line_before_anything_runs(
    invoke: Invoke, workplace: Path, words: list[str], said: str
) -> None:
    result = invoke("bench", *words)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert said in result.stderr
    assert list(workplace.iterdir()) == []


def test_a_directory_of_something_else_is_refused(invoke: Invoke) -> None:
    Path("mine").mkdir()
    Path("mine/thesis.tex").write_text("years of work")
    result = invoke("bench", "vieira", "--out", "mine")
    assert result.exit_code == 2
    assert "--out mine is not empty" in result.stderr
    assert [each.name for each in Path("mine").iterdir()] == ["thesis.tex"]


def left_lock(folder: Path) -> None:
    (folder / LOCK).touch()


def left_empty_file(folder: Path) -> None:
    left_lock(folder)
    (folder / FILE).touch()


def left_empty_database(folder: Path) -> None:
    """As it is before its tables are made: the process that made it was killed."""
    left_lock(folder)
    code = (
        f"import os, sqlite3; sqlite3.connect({str(folder / FILE)!r}).execute('PRAGMA journal_mode = WAL'); os._exit(9)"
    )
    subprocess.run([sys.executable, "-c", code], check=False)
    assert (folder / FILE).stat().st_size > 0


def test_a_filter_that_nothing_matches_is_told(invoke: Invoke, finished: Path) -> None:
    for where in ((), ("--out", finished)):
        listed = invoke(*SMALL, *where, "--list", "--filter", "zebra")
        assert (listed.exit_code, listed.stdout, listed.stderr) == (0, "", "no trial matches --filter 'zebra'\n")
        assert json.loads(invoke(*SMALL, *where, "--list", "--json", "--filter", "zebra").stdout)["trials"] == []
    result = invoke(*SMALL, "--out", finished, "--filter", "zebra")
    assert "no trial matches --filter 'zebra'" in result.stderr.splitlines()
    assert "no trial matches" not in invoke(*SMALL, "--out", finished, "--filter", "phia").stderr


@pytest.mark.parametrize("left", [left_lock, left_empty_file, left_empty_database])
def test_where_the_start_was_cut_short_the_same_command_goes_on(invoke: Invoke, left: Callable[[Path], None]) -> None:
    Path("here").mkdir()
    left(Path("here"))
    listed = invoke(*SMALL, *HERE, "--list", "--json")
    assert listed.exit_code == 0, listed.stderr
    assert len(json.loads(listed.stdout)["trials"]) == 6
    result = invoke(*SMALL, *HERE, "--filter", "no such trial")
    assert (result.exit_code, result.stderr.splitlines()[1]) == (0, "results in here: 0 of 6 trials to run")
    assert ResultStore.is_in("here")


@pytest.mark.parametrize("content", [b"rubbish", b"SQLite format 3\0" + b"rubbish" * 2000])
def test_a_damaged_file_of_results_is_refused_and_stays(invoke: Invoke, content: bytes) -> None:
    Path("here").mkdir()
    Path("here", FILE).write_bytes(content)
    result = invoke(*SMALL, *HERE)
    assert result.exit_code == 2
    assert result.stderr.startswith(f"error: cannot use here/{FILE}: file is not a database")
    assert result.stderr.count("\n") == 1
    assert Path("here", FILE).read_bytes() == content


FIGURE = "UPDATE results SET prediction_error = 'abc'"
COUNTS = "UPDATE results SET deviations = '[1]'"
SPEC = """UPDATE results SET spec = '{"format": 1, "loop": []}'"""
PLACE = """UPDATE environments SET content = '{"versions": 3}'"""
SETTINGS = """UPDATE bench SET settings = '{"format": 1, "suites": ["s"], "planners": [1]}'"""
REPORT, REPLAY, EXPORT = ("report", "here"), ("bench", "replay", "here", "k"), ("bench", "export", "here", "--format")


@pytest.mark.parametrize(
    ("words", "damage"),
    [
        *((REPORT, damage) for damage in (FIGURE, COUNTS, SPEC, PLACE, SETTINGS)),
        *((REPLAY, damage) for damage in (FIGURE, COUNTS, SPEC, SETTINGS)),
        *(((*EXPORT, "json"), damage) for damage in (FIGURE, COUNTS, PLACE, SETTINGS)),
        *(((*EXPORT, "csv"), damage) for damage in (FIGURE, COUNTS, SETTINGS)),
        *((("bench", "vieira/simple-01", "--out", "here", "--list"), damage) for damage in (FIGURE, COUNTS, SETTINGS)),
    ],
)
def test_damage_in_a_whole_database_is_one_line(invoke: Invoke, words: Sequence[str], damage: str) -> None:
    plan = BenchPlan.of(settings())
    with ResultStore.create("here", plan.settings, plan.digests) as store:
        store.add_environment(Environment())
        store.add(a_result(plan[0].key if "--list" in words else "k", spec=RunSpec().to_json()))
        store._connection.execute(damage)
    result = invoke(*words)
    assert (result.exit_code, result.stderr[:7], result.stderr.count("\n")) == (2, "error: ", 1), result.stderr
    assert "damaged" in result.stderr


@pytest.mark.slow
def test_where_no_process_can_be_started_that_is_one_line(run: Run, tmp_path: Path) -> None:
    long = tmp_path / ("x" * 100)
    long.mkdir()
    result = run(*SMALL, *HERE, "--quiet", TMPDIR=str(long))
    assert result.returncode == 2
    assert result.stderr == (
        "error: cannot start the process of a trial: AF_UNIX path too long. Set TMPDIR to a directory with a shorter path.\n"
    )


@pytest.mark.slow
def test_two_benches_are_not_at_work_in_one_directory(invoke: Invoke, finished: Path) -> None:
    plan = BenchPlan.of(settings("vieira/simple-0[123]", planners=("phia", "ooa")))
    with BenchSession(finished, plan):
        result = invoke(*SMALL, "--out", finished)
    assert result.exit_code == 2
    assert "another phframe bench is at work in" in result.stderr


def test_the_shell_is_offered_commands_suites_and_options() -> None:
    offered = {line.split(",")[-1] for line in completed("bench ")}
    assert {"replay", "run", "vieira", "vieira/basic"} <= offered
    assert "--planner" in completed("bench --pl")
    assert "--planner" in completed("bench vieira --pl")
    assert "ooa" in completed("bench vieira --planner o")
    assert completed("bench vieira --accept ver") == ["versions"]


def completed(words: str) -> list[str]:
    """What bash is offered after these words."""
    import typer
    from typer._completion_classes import BashComplete

    command = typer.main.get_command(app)
    *before, last = words.split(" ")
    completion = BashComplete(command, {}, "phframe", "_PHFRAME_COMPLETE")
    return [item.value for item in completion.get_completions(before, last)]


@pytest.mark.slow
def test_a_trial_whose_scene_has_changed_is_run_again(invoke: Invoke) -> None:
    content = (Path(__file__).parents[2] / "docs/examples/three-cups.yaml").read_text()
    Path("mine.yaml").write_text(content)
    words = ("bench", "mine.yaml", *HERE)
    assert "1 of 1 trials to run" in invoke(*words, "--quiet", "--list").stderr + invoke(*words).stderr
    Path("mine.yaml").write_text(content.replace("name: three-cups", "name: other-cups"))
    assert "--accept suites" in invoke(*words).stderr
    again = invoke(*words, "--accept", "suites", "--json")
    assert again.stderr.splitlines() == [
        "results in here: 1 of 1 trials to run",
        "results kept but left out, of other settings or of scenes that have changed: 1",
    ]
    assert [line["trials"] for line in json.loads(again.stdout)["summary"]] == [1]
    assert "0 of 1 trials to run" in invoke(*words).stderr


@pytest.mark.slow
def test_after_a_merge_only_trials_of_the_bench_are_counted(invoke: Invoke, finished: Path) -> None:
    failing = (*SMALL, "--option", "backend.step=0.002", "--trial-limit", "0.001")
    assert invoke(*failing, "--filter", "*simple-01", "--out", "other", "--quiet").exit_code == 1
    assert invoke("bench", "merge", finished, "other", "--out", "here", "--accept", "options").exit_code == 0
    assert len(rows("here")) == 8
    result = invoke(*SMALL, *HERE, "--json")
    assert (result.exit_code, [line["trials"] for line in json.loads(result.stdout)["summary"]]) == (0, [3, 3])
    assert "of other settings or of scenes that have changed: 2" in result.stderr
    assert "left out" not in invoke(*SMALL, *HERE).stderr
    with ResultStore.open("here") as store:
        assert len(store.done()) == 8
