"""Signals at any moment of a command's life, from its first line to its last: it is told where what there is is kept, and it is.

The moments are drawn by lot, with a seed, as numbers of function calls; see ``moment.py``.
"""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from phframe.bench.store import ResultStore
from phframe.core import Episode, RunSpec
from phframe.runtime.files import load, save
from phframe.runtime.run import run
from tests.cli.conftest import Spawn, spawn, until, workplace
from tests.faults.moment import CHILD, TOP
from tests.trials import many, tried

__all__ = ["spawn", "workplace"]  # fixtures
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not hasattr(os, "fork") or sys.platform == "win32", reason="signals of POSIX, and the watchdog"),
]
MIXTURES = {
    "SIGINT": (signal.SIGINT,),
    "SIGTERM": (signal.SIGTERM,),
    "SIGHUP": (signal.SIGHUP,),
    "SIGINT five times": (signal.SIGINT,) * 5,
    "SIGTERM, then SIGINT": (signal.SIGTERM, signal.SIGINT),
    "SIGHUP, SIGTERM, SIGINT": (signal.SIGHUP, signal.SIGTERM, signal.SIGINT),
}
AFTER_INSTALLING = 200
"""Function calls that it takes to listen to signals."""
STRETCHES = (
    (TOP, "install", 20_000),  # finding the command, once it listens: before that there is only the interpreter
    (TOP, "install", 450_000),  # reading the command line
    (TOP, "supervised", 300),  # forking
    (TOP, "wait", 60),  # watching
    (TOP, "_told", 300),  # at the end
    (CHILD, "", 2_000),
    (CHILD, "_carry_out", 2_000_000),  # importing and preparing
    (CHILD, "make", 20_000),  # the run has a directory
    (CHILD, "progressed", 50_000),  # planning
    (CHILD, "stepped", 20_000),
    (CHILD, "_write", 20_000),  # the episode is over
    (CHILD, "emit", 1_000),
    (CHILD, "ended", 200),  # all is told
)
"""Of a run's life: whose events are counted, from which function on, and how many there are about."""
OF_A_BENCH = (
    (TOP, "install", 450_000),
    (TOP, "run_bench", 300_000),
    (TOP, "run_trials", 100_000),
    (TOP, "listen", 5_000),
    (TOP, "_tell", 50_000),
    (TOP, "summary_table", 50_000),
)


@dataclass(frozen=True)
class Lot:
    """What is sent, and when.

    Attributes:
        mixture: The name of the signals.
        process: Whose events are counted.
        after: From which function on.
        number: At which of them they are sent.
    """

    mixture: str
    process: int
    after: str
    number: int

    def __str__(self) -> str:
        return f"{self.mixture} at {self.number} after {self.after or 'its beginning'} of {('it', 'its child')[self.process]}"

    def start(self, spawn: Spawn, note: Path, *arguments: str) -> subprocess.Popen[str]:
        numbers = ",".join(str(int(each)) for each in MIXTURES[self.mixture])
        driver = (note, self.process, self.after, self.number, numbers)
        return spawn(*driver, *arguments, program=[str(Path(__file__).with_name("moment.py"))], MOMENT=str(note))


def drawn(number: int, salt: str, stretches: tuple[tuple[int, str, int], ...]) -> list[Lot]:
    """So many, the stretches in turn; within one, early moments are as likely as late ones, however long it is."""
    lots = random.Random(salt)
    found = []
    for row in range(number):
        process, after, length = stretches[row % len(stretches)] if number >= len(stretches) else lots.choice(stretches)
        at = lots.randrange(1, length) if lots.random() < 0.5 else int(length ** lots.random())
        found.append(Lot(lots.choice(list(MIXTURES)), process, after, at + AFTER_INSTALLING * (after == "install")))
    return found


@dataclass(frozen=True)
class Ended:
    """A command that has ended.

    Attributes:
        code: Its exit code.
        out: What it printed.
        err: What it said.
    """

    code: int
    out: str
    err: str

    @property
    def is_whole(self) -> bool:
        """Whether it was done before it was told to end; else it says in a line that it was interrupted."""
        if self.code != 130:
            assert (self.code, self.err) == (0, "")
            return True
        assert self.err.startswith("interrupted")
        assert self.err.count("\n") == 1
        return False


def ended(lot: Lot, spawn: Spawn, *arguments: str) -> Ended:
    """A command to which what was drawn has happened. Nothing of it runs on."""
    note = Path.cwd().parent / "note"
    note.unlink(missing_ok=True)
    process = lot.start(spawn, note, *arguments)
    out, err = process.communicate(timeout=240)
    if note.exists():
        tried(f"signals: {lot.mixture}, at any moment of {arguments[0]}", len(MIXTURES[lot.mixture]))
    until(lambda: not left(f"MOMENT={note}"))
    return Ended(process.returncode, out, err)


def left(variable: str) -> list[Path]:
    """The processes in whose environment something is, where the system says so."""
    return [
        each.parent for each in Path("/proc").glob("[0-9]*/environ") if variable.encode() in content(each).split(b"\0")
    ]


def content(file: Path) -> bytes:
    try:
        return file.read_bytes()
    except OSError:  # it has ended, or is somebody else's
        return b""


def check_files(found: Ended, folder: Path) -> None:
    """What was said of the files of a run is so, and nothing half is left."""
    hidden = [path for path in Path.cwd().rglob("*") if path.name.startswith(".") or path.name.endswith(".part")]
    assert hidden == []
    place = folder / "episode.json"
    if place.exists():
        assert isinstance(load(place), Episode)
    if found.is_whole:
        assert json.loads((folder / "summary.json").read_text())["status"] == "retrieved"
        return
    if place.exists():
        assert found.err == f"interrupted; what was recorded is in {folder}\n"
    else:
        assert found.err in ("interrupted\n", "interrupted; nothing was recorded yet\n")


@pytest.mark.parametrize("lot", drawn(many(4), "solve", STRETCHES), ids=str)
def test_of_a_run(lot: Lot, spawn: Spawn) -> None:
    found = ended(lot, spawn, "solve", "vieira/simple-07", "--no-rerun", "--json", "--out", "out")
    check_files(found, Path("out"))
    if found.is_whole:
        assert json.loads(found.out)["status"] == "retrieved"


@pytest.mark.needs_rerun
@pytest.mark.parametrize("lot", drawn(many(1), "rerun", STRETCHES), ids=str)
def test_of_a_run_that_is_recorded(lot: Lot, spawn: Spawn) -> None:
    pytest.importorskip("rerun")
    check_files(ended(lot, spawn, "solve", "vieira/simple-07", "--rerun", "--json", "--out", "out"), Path("out"))
    if (recording := Path("out", "recording.rrd")).exists():
        assert Path("out", "episode.json").exists()
        verify = [sys.executable, "-m", "rerun", "rrd", "verify", str(recording)]
        assert subprocess.run(verify, check=False, capture_output=True, timeout=240).returncode == 0


@pytest.mark.parametrize("lot", drawn(many(1), "replay", STRETCHES), ids=str)
def test_of_a_repetition(lot: Lot, episode: Path, spawn: Spawn) -> None:
    found = ended(lot, spawn, "replay", str(episode), "--json", "--out", "again")
    check_files(found, Path("again"))
    if found.is_whole:
        assert json.loads(found.out)["same"]


@pytest.fixture(scope="module")
def episode(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return save(run(RunSpec("vieira/simple-07")), tmp_path_factory.mktemp("before") / "episode.json")


@pytest.mark.parametrize("lot", drawn(many(2), "bench", OF_A_BENCH), ids=str)
def test_of_a_bench_which_goes_on_afterwards(lot: Lot, spawn: Spawn) -> None:
    command = ("bench", "run", "vieira/simple-07", "--planner", "ooa", "--planner", "phia", "--out", "out", "--quiet")
    assert ended(lot, spawn, *command).out == ""
    again = spawn(*command)
    assert (again.communicate(timeout=240), again.returncode) == (("", ""), 0)
    assert sorted(path.name for path in Path("out").iterdir()) == ["lock", "results.sqlite"]
    with ResultStore.open("out") as store:
        assert sorted((row.planner, row.end, row.status) for row in store.results()) == [
            ("ooa", "finished", "retrieved"),
            ("phia", "finished", "retrieved"),
        ]
