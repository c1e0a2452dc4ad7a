"""``phframe bench`` that is interrupted, killed or out of room: nothing lives on, what is done stays, and it goes on."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from contextlib import suppress
from functools import partial
from pathlib import Path
from random import Random

import pytest

from phframe.bench.store import FILE
from phframe.bench.trial_result import TrialEnd
from tests.bench.benches import lives, misbehaving, noted
from tests.cli.bench_runs import HERE, SMALL, done, rows
from tests.cli.conftest import Run, Spawn, until

pytestmark = pytest.mark.long

LIMITED = """
import resource
resource.setrlimit(resource.RLIMIT_FSIZE, (88 * 1024, 88 * 1024))
from phframe.cli.main import main
main()
"""
"""The command with no room for larger files than that."""


@pytest.mark.slow
def test_where_the_disk_is_full_what_was_stored_stays_and_the_rest_is_run_later(run: Run, finished: Path) -> None:
    limited = (sys.executable, "-c", LIMITED, *SMALL, *HERE)
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])}
    full = subprocess.run(limited, capture_output=True, text=True, check=False, timeout=300, env=environment)
    assert full.returncode == 2
    assert full.stderr.splitlines()[-1].startswith(f"error: cannot use here/{FILE}: disk I/O error")
    before = rows("here")
    assert 0 < len(before) < 6
    assert run(*SMALL, *HERE).returncode == 0
    assert [row for row in before if row in rows("here")] == before
    assert rows("here") == rows(finished)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="processes are looked up in /proc")
def test_after_kill_9_no_child_lives_on_and_it_goes_on_where_it_was(spawn: Spawn, run: Run) -> None:
    hanging = f"{misbehaving('ForksAndHangs')}[mark=ids]"
    words = ("bench", "vieira/simple-01", "--planner", "phia", "--planner", hanging, "--workers", "2", *HERE)
    process = spawn(*words)
    until(lambda: len(noted(Path("ids"))) == 3 and done("here") == 1, process)
    assert all(lives(each) for each in noted(Path("ids")))
    process.kill()
    process.communicate()
    until(lambda: not [each for each in noted(Path("ids")) if lives(each)])
    again = run(*words, "--filter", "phia")
    assert "0 of 2 trials to run" in again.stderr


@pytest.mark.slow
@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM], ids=lambda by: by.name)
def test_an_interruption_ends_what_runs_keeps_what_is_done_and_says_how_to_go_on(
    spawn: Spawn, by: signal.Signals
) -> None:
    hanging = f"{misbehaving('ForksAndHangs')}[mark=ids]"
    process = spawn("bench", "vieira/simple-01", "--planner", "phia", "--planner", hanging, "--workers", "2", *HERE)
    until(lambda: len(noted(Path("ids"))) == 3 and done("here") == 1, process)
    process.send_signal(by)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (130, "")
    assert err.splitlines()[-1] == "interrupted; what was done is kept: go on with the same command and --out here"
    until(lambda: not [each for each in noted(Path("ids")) if lives(each)])
    assert done("here") == 1


def has(results: int) -> bool:
    """Whether there are so many results."""
    return done("here") >= results


@pytest.mark.slow
def test_killed_again_and_again_it_ends_as_if_undisturbed(spawn: Spawn, run: Run, finished: Path) -> None:
    random = Random(4)
    for _ in range(5):
        process = spawn(*SMALL, "--workers", "2", *HERE)
        until(partial(has, min(6, done("here") + random.randrange(2))), process)
        with suppress(subprocess.TimeoutExpired):
            process.wait(random.random())
        process.kill()
        process.communicate()
    assert run(*SMALL, *HERE).returncode == 0
    assert rows("here") == rows(finished)
    assert {row["end"] for row in rows("here")} == {TrialEnd.FINISHED}
