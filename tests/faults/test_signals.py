"""Signals, at every step: what there is of the episode is kept, and the message says where. Nothing is waited for by the clock."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from phframe.core import Episode, Status
from phframe.runtime.episode import UNFINISHED
from phframe.runtime.files import load
from tests.cli.conftest import Spawn, spawn, until, workplace  # noqa: F401 - fixtures
from tests.trials import TIMES, tried

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals"),
]
HOSTILE = Path(__file__).with_name("hostile.py")
STEPS = 2
"""Of vieira/simple-07: a push and a grasp."""
ENDS = {
    "Ctrl-C": (signal.SIGINT,),
    "terminate": (signal.SIGTERM,),
    "hang up": (signal.SIGHUP,),
    "Ctrl-C five times": (signal.SIGINT,) * 5,
    "all of them": (signal.SIGHUP, signal.SIGTERM, signal.SIGINT),
}


def at_step(spawn: Spawn, step: int, *more: str) -> subprocess.Popen[str]:  # noqa: F811
    """A run whose action of a number does not end."""
    backend = ("--backend", f"{HOSTILE}:Tells", "--plan-backend", "pymunk")
    process = spawn("solve", "vieira/simple-07", *backend, *more, TELL=str(step))
    until(Path("told").exists, process)
    return process


def kept(process: subprocess.Popen[str], step: int) -> Path:
    """The directory of the run, once it has ended as it should."""
    out, err = process.communicate(timeout=240)
    [folder] = Path("runs").iterdir()
    assert (process.returncode, out) == (130, "")
    assert err == f"interrupted; what was recorded is in {folder}\n"
    episode = load(folder / "episode.json")
    assert isinstance(episode, Episode)
    assert (episode.status, episode.reason) == (Status.FAILED, "interrupted by Ctrl-C")
    assert (len(episode.plans), len(episode.steps)) == (1, step)
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]
    assert not (folder / "summary.json").exists()
    return folder


@pytest.mark.parametrize("_time", range(TIMES))
@pytest.mark.parametrize("step", range(STEPS))
@pytest.mark.parametrize("name", ENDS)
def test_what_was_done_until_then_is_kept(name: str, step: int, _time: int, spawn: Spawn) -> None:  # noqa: F811
    process = at_step(spawn, step, "--no-rerun")
    for number in ENDS[name]:
        process.send_signal(number)
        tried(f"signals: {name}, in an action that does not end")
    kept(process, step)


@pytest.mark.needs_rerun
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda number: number.name)
def test_the_recording_is_whole(number: signal.Signals, spawn: Spawn) -> None:  # noqa: F811
    pytest.importorskip("rerun")
    process = at_step(spawn, 1, "--rerun")
    process.send_signal(number)
    verify = [sys.executable, "-m", "rerun", "rrd", "verify", str(kept(process, 1) / "recording.rrd")]
    assert subprocess.run(verify, check=False, capture_output=True, timeout=240).returncode == 0


def test_a_second_ctrl_c_ends_what_does_not_listen(spawn: Spawn) -> None:  # noqa: F811
    deeds = ("--option", "deed=swallows_all", "--option", "at=1")
    process = spawn("solve", "vieira/simple-07", "--planner", f"{HOSTILE}:DoesIt", *deeds, "--no-rerun")
    until(lambda: '"steps": [{' in "".join(each.read_text() for each in Path("runs").glob("*/episode.json")), process)
    until(lambda: pressed(process))  # signals that come before the last was looked at are one
    kept(process, 1)


def pressed(process: subprocess.Popen[str]) -> bool:
    """Ctrl-C once more; whether it has ended."""
    process.send_signal(signal.SIGINT)
    return process.poll() is not None


def test_the_run_ends_with_its_watchdog(spawn: Spawn) -> None:  # noqa: F811
    if sys.platform != "linux":
        pytest.skip("only Linux tells a process of the end of its parent")
    process = at_step(spawn, 1, "--no-rerun")
    [child] = map(int, Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split())
    process.kill()
    until(lambda: not running(child))
    [folder] = Path("runs").iterdir()
    episode = load(folder / "episode.json")
    assert isinstance(episode, Episode)
    assert (episode.reason, len(episode.steps)) == (UNFINISHED, 1)


def running(process: int) -> bool:
    try:
        os.kill(process, 0)
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False
