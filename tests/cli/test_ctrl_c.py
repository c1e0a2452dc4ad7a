from __future__ import annotations

import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from phframe.core import Episode, Status
from tests.cli.conftest import Spawn

NEVER_DONE = """
from pathlib import Path
from phframe.core import Options, Plan, Planner, Status
from phframe.planners.ooa import OOA
from phframe.pushing.options import PushingOptions

class NeverDone(Planner[PushingOptions]):
    options_type = PushingOptions
    plans = 0

    def search(self, task):
        \"\"\"One push at first, then no end of simulations.\"\"\"
        plan = OOA(self.options).search(task)
        while NeverDone.plans:
            Path("busy").touch()
            task.apply(task.start, plan.actions[0])
        NeverDone.plans += 1
        return Plan.of(Status.CLEARED, "", task.start, [(plan.actions[0], task.start)])
"""

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT to send to one process"),
]


def test_ctrl_c_keeps_what_was_recorded_and_says_where(spawn: Spawn) -> None:
    from phframe.runtime.files import load

    Path("mine.py").write_text(NEVER_DONE)
    process = spawn("solve", "--planner", "./mine.py:NeverDone", "--option", "max_actions=1", "--json")
    _wait_for(Path("busy"), process)
    seconds, out, err = _interrupted(process)
    assert process.returncode == 130
    assert seconds < 1.0
    assert out == ""
    [folder] = Path("runs").iterdir()
    assert err.splitlines() == [f"interrupted; what was recorded is in {folder}"]
    episode = load(folder / "episode.json")
    assert isinstance(episode, Episode)
    assert (episode.status, episode.pushes, len(episode.plans)) == (Status.FAILED, 1, 1)
    assert "Ctrl-C" in episode.reason
    assert not (folder / "summary.json").exists()
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]


def test_ctrl_c_before_anything_was_recorded_leaves_nothing(spawn: Spawn) -> None:
    Path("mine.py").write_text("import time, pathlib\npathlib.Path('busy').touch()\ntime.sleep(30)\n")
    process = spawn("solve", "--planner", "./mine.py:Mine", "--no-rerun")
    _wait_for(Path("busy"), process)
    seconds, out, err = _interrupted(process)
    assert process.returncode == 130
    assert seconds < 1.0
    assert (out, err) == ("", "interrupted; nothing was recorded yet\n")
    assert not Path("runs").exists()


def _wait_for(path: Path, process: subprocess.Popen[str]) -> None:
    end = time.monotonic() + 30
    while not path.exists():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end
        time.sleep(0.02)


def _interrupted(process: subprocess.Popen[str]) -> tuple[float, str, str]:
    time.sleep(0.2)
    began = time.monotonic()
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=10)
    return time.monotonic() - began, out, err
