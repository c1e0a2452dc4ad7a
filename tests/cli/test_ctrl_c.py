"""Ctrl-C ends what would never end, keeps what there is, and says where. Simulations are counted, not seconds."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from phframe.core import Episode, Status
from tests.cli.conftest import Spawn, until

NEVER_DONE = """
from pathlib import Path
from phframe.core import Plan, Planner, Status
from phframe.planners.ooa import OOA
from phframe.pushing.options import ClearingOptions

class NeverDone(Planner[ClearingOptions]):
    options_type = ClearingOptions
    plans = 0

    def search(self, task):
        \"\"\"One push at first, then no end of simulations.\"\"\"
        plan = OOA(self.options).search(task)
        action = plan.actions[0]
        while NeverDone.plans:
            task.apply(task.start, action)
            with Path("simulated").open("a") as file:
                file.write(".")
        NeverDone.plans += 1
        return Plan.of(Status.CLEARED, "", task.start, [(action, task.start)])
"""
FEW = 20
"""Simulations until an interrupt that an engine swallows has been raised again."""

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT to send to one process"),
]


@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM], ids=lambda by: by.name)
def test_an_interruption_keeps_what_was_recorded_and_says_where(spawn: Spawn, by: signal.Signals) -> None:
    from phframe.runtime.files import load

    Path("mine.py").write_text(NEVER_DONE)
    process = spawn("solve", "--planner", "./mine.py:NeverDone", "--option", "max_actions=1", "--json")
    until(lambda: simulated() > 2, process)
    os.kill(process.pid, signal.SIGSTOP)  # so that the count and the interruption are of one moment
    before = simulated()
    out, err = interrupted(process, by)
    assert simulated() < before + FEW
    assert process.returncode == 130
    assert out == ""
    [folder] = Path("runs").iterdir()
    assert err.splitlines() == [f"interrupted; what was recorded is in {folder}"]
    episode = load(folder / "episode.json")
    assert isinstance(episode, Episode)
    assert (episode.status, episode.pushes, len(episode.plans)) == (Status.FAILED, 1, 1)
    assert "Ctrl-C" in episode.reason
    assert episode.versions["pymunk"]
    assert not (folder / "summary.json").exists()
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]


def test_ctrl_c_before_anything_was_recorded_leaves_nothing(spawn: Spawn) -> None:
    Path("mine.py").write_text("import threading, pathlib\npathlib.Path('busy').touch()\nthreading.Event().wait()\n")
    process = spawn("solve", "--planner", "./mine.py:Mine", "--no-rerun")
    until(Path("busy").exists, process)
    out, err = interrupted(process, signal.SIGINT)
    assert process.returncode == 130
    assert (out, err) == ("", "interrupted; nothing was recorded yet\n")
    assert not Path("runs").exists()


def simulated() -> int:
    return Path("simulated").stat().st_size if Path("simulated").exists() else 0


def interrupted(process: subprocess.Popen[str], by: signal.Signals) -> tuple[str, str]:
    process.send_signal(by)
    process.send_signal(signal.SIGCONT)
    return process.communicate(timeout=120)
