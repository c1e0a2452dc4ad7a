"""Ctrl-C ends what would never end, keeps what there is, and says where. Simulations are counted, not seconds."""

from __future__ import annotations

import os
import signal
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
    pytest.mark.skipif(sys.platform != "linux", reason="only Linux tells which process is whose, and what is pending"),
]


@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM], ids=lambda by: by.name)
def test_an_interruption_keeps_what_was_recorded_and_says_where(spawn: Spawn, by: signal.Signals) -> None:
    from phframe.runtime.files import load

    Path("mine.py").write_text(NEVER_DONE)
    process = spawn("solve", "--planner", "./mine.py:NeverDone", "--option", "max_actions=1", "--json")
    until(lambda: simulated() > 2, process)
    [child] = map(int, Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split())
    os.kill(child, signal.SIGSTOP)  # so that the count and the interruption are of one moment
    until(lambda: status_of(child)["State"].strip().startswith("T"), process)
    process.send_signal(by)
    until(lambda: is_pending(by, child), process)
    before = simulated()
    os.kill(child, signal.SIGCONT)
    out, err = process.communicate(timeout=120)
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
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=120)
    assert process.returncode == 130
    assert (out, err) == ("", "interrupted; nothing was recorded yet\n")
    assert not Path("runs").exists()


def simulated() -> int:
    return Path("simulated").stat().st_size if Path("simulated").exists() else 0


def is_pending(number: signal.Signals, process: int) -> bool:
    """Whether a process has been sent a signal that it has not looked at yet."""
    return any(int(status_of(process)[name], 16) >> (number - 1) & 1 for name in ("ShdPnd", "SigPnd"))


def status_of(process: int) -> dict[str, str]:
    """What the system says of a process, by name."""
    lines = Path(f"/proc/{process}/status").read_text().splitlines()
    return {name: value for name, _, value in (line.partition(":") for line in lines)}
