"""Whatever distributions do when they are asked what they offer, the listing tells it and the rest works."""

from __future__ import annotations

import json
import subprocess
import time
from pathlib import Path

import pytest

from tests.faults.plugins.conftest import Bench, is_alive, made
from tests.faults.plugins.hostile import AT_ONCE, HANGS, NOT_PLUGINS, Hostile
from tests.trials import TIMES as TIMES_AS_MUCH
from tests.trials import tried

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not hasattr(__import__("os"), "mkfifo"), reason="made for POSIX"),
]
BROKEN = [kind for kind in AT_ONCE if kind.said]
LISTED = [kind for kind in AT_ONCE if not kind.said and kind not in NOT_PLUGINS]
SOLVE = ("solve", "vieira/simple-07", "--planner", "ooa", "--no-rerun", "--json")
TIMES = ("planning_time", "motion_planning_time", "execution_time")


@pytest.fixture(scope="module")
def full(tmp_path_factory: pytest.TempPathFactory) -> Bench:
    """With all kinds installed, but those that hang."""
    return made(tmp_path_factory.mktemp("full"), AT_ONCE, PHFRAME_PLUGINS_SECONDS="120")


@pytest.fixture(scope="module")
def solved(full: Bench) -> tuple[subprocess.CompletedProcess[str], set[str]]:
    """A run of what is built in, and the modules of plugins that ran meanwhile. It comes first: nothing is kept yet."""
    return full.run(*SOLVE), full.ran


@pytest.fixture(scope="module")
def listed(full: Bench, solved: object) -> subprocess.CompletedProcess[str]:
    assert solved
    return full.run("planners", "--json")


def test_what_is_built_in_is_used_without_asking_anybody(
    full: Bench, solved: tuple[subprocess.CompletedProcess[str], set[str]]
) -> None:
    done, ran = solved
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.count("\n") == 1
    assert ran == set()
    alone = json.loads(full.run(*SOLVE, PHFRAME_PLUGINS="").stdout)
    assert without_times(json.loads(done.stdout)) == without_times(alone)


def without_times(summary: dict[str, object]) -> dict[str, object]:
    return {key: value for key, value in summary.items() if key not in TIMES}


def test_standard_output_is_the_listing_and_nothing_else(listed: subprocess.CompletedProcess[str]) -> None:
    assert (listed.returncode, listed.stderr) == (0, "")
    assert listed.stdout.count("\n") == 1
    assert {"phia", "lab-good"} <= {item["name"] for item in json.loads(listed.stdout)["planners"]}


@pytest.mark.parametrize("kind", BROKEN, ids=lambda kind: kind.name)
def test_a_broken_distribution_is_told_in_a_line(listed: subprocess.CompletedProcess[str], kind: Hostile) -> None:
    broken = {item["distribution"]: item["error"] for item in json.loads(listed.stdout)["broken"]}
    error = broken[kind.known_as or kind.name]
    assert kind.said is not None
    assert kind.said in error
    assert "\n" not in error
    assert len(error) < 800


@pytest.mark.parametrize("kind", LISTED, ids=lambda kind: kind.name)
def test_what_does_no_harm_in_the_end_is_listed(listed: subprocess.CompletedProcess[str], kind: Hostile) -> None:
    planners = {item["name"]: item for item in json.loads(listed.stdout)["planners"]}
    assert planners[kind.name]["distribution"] == kind.name


@pytest.mark.parametrize("kind", NOT_PLUGINS, ids=lambda kind: kind.name)
def test_what_does_not_say_that_it_has_plugins_is_left_alone(
    full: Bench, listed: subprocess.CompletedProcess[str], kind: Hostile
) -> None:
    assert kind.module not in listed.stdout + "".join(full.ran)
    assert kind.name not in listed.stdout


LISTINGS = ("backends", "arms", "topology", "goals", "scenes")


@pytest.mark.parametrize("name", LISTINGS[: TIMES_AS_MUCH - 1])
def test_so_it_is_in_every_listing(name: str, tmp_path: Path) -> None:
    bench = made(tmp_path, AT_ONCE, PHFRAME_PLUGINS_SECONDS="120")
    done = bench.run(name, "--json")
    tried("processes: a hostile distribution that is asked", sum(len(bench.pids(kind.module)) for kind in AT_ONCE))
    assert (done.returncode, done.stderr, done.stdout.count("\n")) == (0, "", 1)
    broken = {item["distribution"] for item in json.loads(done.stdout)["broken"]}
    assert broken == {kind.known_as or kind.name for kind in BROKEN}


def test_no_process_of_theirs_is_left(full: Bench, listed: subprocess.CompletedProcess[str]) -> None:
    assert listed.returncode == 0
    tried("processes: a hostile distribution that is asked", sum(len(full.pids(kind.module)) for kind in AT_ONCE))
    assert [pid for kind in AT_ONCE for pid in full.pids(kind.module) if is_alive(pid)] == []


def test_the_help_tells_nothing_of_it(full: Bench, listed: subprocess.CompletedProcess[str]) -> None:
    assert listed.returncode == 0
    full.forget()
    done = full.run("--help")
    assert (done.returncode, done.stderr) == (0, "")
    assert "solve" in done.stdout
    # What they answered is kept; of those that went wrong until a folder on the path changes, as it may by other tests.
    assert full.ran.isdisjoint(kind.module for kind in LISTED)


def test_strict_makes_it_one_line(full: Bench, listed: subprocess.CompletedProcess[str]) -> None:
    assert listed.returncode == 0
    done = full.run("planners", PHFRAME_PLUGINS_STRICT="1")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: plugin ")
    assert done.stderr.count("\n") == 1


def test_those_that_hang_are_ended(tmp_path_factory: pytest.TempPathFactory) -> None:
    bench = made(tmp_path_factory.mktemp("hanging"), HANGS, PHFRAME_PLUGINS_SECONDS="3")
    listed = bench.run("planners", "--json")
    broken = {item["distribution"]: item["error"] for item in json.loads(listed.stdout)["broken"]}
    assert (listed.returncode, listed.stderr) == (0, "")
    assert sorted(broken) == sorted(kind.name for kind in HANGS)
    assert all("gave no answer within 3 s" in error for error in broken.values())
    assert [pid for kind in HANGS for pid in bench.pids(kind.module) if is_alive(pid)] == []


@pytest.mark.parametrize("number", [2, 15, 9], ids=["SIGINT", "SIGTERM", "SIGKILL"])
def test_whoever_is_being_asked_ends_with_the_command(bench: Bench, number: int) -> None:
    bench.install(HANGS[0])
    limit = "6" if number == 9 else "10000"  # what is killed can end nobody: the one asked ends itself
    with bench.popen("planners", PHFRAME_PLUGINS_SECONDS=limit) as process:
        until(lambda: bench.pids(HANGS[0].module))
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
    assert process.returncode == (130 if number != 9 else -9)
    assert (out, err) == ("", "" if number == 9 else "interrupted\n")
    until(lambda: not any(is_alive(pid) for pid in bench.pids(HANGS[0].module)))


def until(happened: object) -> None:
    """Wait for what must happen, however slow the machine."""
    assert callable(happened)
    for _ in range(6000):
        if happened():
            return
        time.sleep(0.01)
    raise AssertionError("it never happened")
