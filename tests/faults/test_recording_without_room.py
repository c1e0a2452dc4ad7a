"""No room for a recording, which Rerun writes itself: it is told, the run is whole, and no half recording is left.

What a full disk does is done here by the system's limit on the size of a file, which needs no file system of its own.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from phframe.core import Episode, Status
from phframe.runtime.files import load
from tests.cli.conftest import Spawn, spawn, workplace
from tests.trials import TIMES, tried

__all__ = ["spawn", "workplace"]  # fixtures
pytestmark = [
    pytest.mark.slow,
    pytest.mark.needs_rerun,
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such limits"),
]
pytest.importorskip("rerun")
LIMIT = """
import resource, runpy, sys
most = int(sys.argv.pop(1))
resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
"""
COMMAND = f"{LIMIT}\nrunpy.run_module('phframe', run_name='__main__', alter_sys=True)"
LIBRARY = f"""{LIMIT}
import phframe
from phframe.core import PhframeError
from phframe.recorders.rerun_ import RerunRecorder
from pathlib import Path
try:
    phframe.solve("vieira/simple-07", observers=[RerunRecorder(Path("recording.rrd"))])
except PhframeError as error:
    print(error)
"""
BEGINNING = 264_000
"""Bytes of a file for which there is just so room: Rerun has been seen not to come back from there."""
TOO_FEW = [BEGINNING, 400_000, *range(BEGINNING + 1000, 600_000, 40_000)][: 2 * TIMES]


def test_of_what_cannot_even_begin_there_is_nothing(spawn: Spawn) -> None:
    tried("processes: no room for a recording")
    process = spawn(100_000, "solve", "vieira/simple-07", "--rerun", "--json", "--out", "out", program=["-c", COMMAND])
    out, err = process.communicate(timeout=240)
    assert (process.returncode, out, err.count("\n")) == (2, "", 1)
    assert err.startswith("error: cannot write the recording out/recording.rrd: ")
    assert not Path("out").exists()


@pytest.mark.parametrize("most", TOO_FEW)
def test_of_what_does_not_fit_the_run_is_kept(most: int, spawn: Spawn) -> None:
    tried("processes: no room for a recording")
    process = spawn(most, "solve", "vieira/simple-07", "--rerun", "--json", "--out", "out", program=["-c", COMMAND])
    out, err = process.communicate(timeout=240)
    assert process.returncode == 2
    assert err == "error: the recording failed: cannot write the recording out/recording.rrd: File too large\n"
    assert sorted(path.name for path in Path("out").iterdir()) == ["episode.json", "summary.json"]
    summary = json.loads(Path("out", "summary.json").read_text())
    assert (json.loads(out), summary["recording"]) == (summary, None)
    episode = load(Path("out", "episode.json"))
    assert isinstance(episode, Episode)
    assert episode.status is Status.RETRIEVED


def test_a_process_with_a_recording_that_was_lost_comes_to_its_end(spawn: Spawn) -> None:
    tried("processes: no room for a recording")
    process = spawn(BEGINNING, program=["-c", LIBRARY], RUST_LOG="off")
    out, err = process.communicate(timeout=240)
    assert (process.returncode, err) == (0, "")
    assert out == "RerunRecorder failed: cannot write the recording recording.rrd: File too large\n"
