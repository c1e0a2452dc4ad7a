"""A pipe or a device where a file is to be read is refused in a line, at once: nobody waits for it, or reads it for ever."""

from __future__ import annotations

import os
import signal
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

from phframe.core import ArmError
from phframe.urdf.convex_hull import read_hull
from tests.cli.conftest import Invoke, invoke, workplace
from tests.trials import tried

__all__ = ["invoke", "workplace"]  # fixtures
pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes and devices of POSIX")
COMMANDS = {
    "a scene": ("scenes", "./special"),
    "a scene to solve": ("solve", "./special", "--no-rerun"),
    "a scene of a bench": ("bench", "run", "./special", "--quiet"),
    "an episode to replay": ("replay", "special"),
    "an episode in a folder": ("replay", "folder"),
    "an episode to export": ("export", "./special", "--format", "mcap", "--out", "x.mcap"),
    "a plugin": ("planners", "./special.py:Mine"),
    "a plugin to solve with": ("solve", "--planner", "./special.py:Mine", "--no-rerun"),
    "a file of hints": ("solve", "--planner", "guided", "--option", "hints=special", "--no-rerun"),
    "MuJoCo XML": ("scene", "import", "special"),
}
KINDS = ("pipe", "device", "socket")


@pytest.fixture(autouse=True)
def patience() -> Iterator[None]:
    """What waits for a pipe is told after two minutes; nothing takes as long as that."""
    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.alarm(120)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


def make(kind: str, *paths: Path) -> None:
    for path in paths:
        path.parent.mkdir(exist_ok=True)
        if kind == "pipe":
            os.mkfifo(path)
        elif kind == "device":
            path.symlink_to("/dev/zero")
        else:
            with socket.socket(socket.AF_UNIX) as made:
                made.bind(str(path))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("what", COMMANDS)
def test_it_is_refused_in_a_line(what: str, kind: str, invoke: Invoke) -> None:
    if what == "MuJoCo XML":
        pytest.importorskip("mujoco")
    tried("inputs: a pipe, device or socket for a file")
    make(kind, Path("special"), Path("special.py"), Path("folder", "episode.json"))
    result = invoke(*COMMANDS[what])
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.count("\n") == 1
    assert "not a regular file" in result.stderr or kind == "socket"
    assert not Path("runs").exists()


@pytest.mark.needs_baxter
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("file", ["arm.yaml", "robot.urdf", "robot.srdf"])
def test_so_it_is_of_an_arm(file: str, kind: str, invoke: Invoke) -> None:
    for library in ("pinocchio", "ompl", "toppra", "coal"):
        pytest.importorskip(library)
    from phframe.arms.articulated import EXAMPLE

    tried("inputs: a pipe, device or socket for a file")
    description = EXAMPLE.read_text() + "\nsrdf: robot.srdf\n"
    for path, text in (("arm.yaml", description), ("robot.urdf", (EXAMPLE.parent / "robot.urdf").read_text())):
        Path(path).write_text(text)
    Path("robot.srdf").write_text("<robot/>")
    Path(file).unlink()
    make(kind, Path(file))
    given = ("--arm", "articulated", "--option", "arm.description=arm.yaml", "--format", "urdf-parts", "--out", "parts")
    result = invoke("export", "vieira/basic", *given)
    assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (2, "", 1)
    assert "not a regular file" in result.stderr or kind == "socket"


@pytest.mark.parametrize("kind", KINDS)
def test_so_it_is_of_a_mesh(kind: str, workplace: Path) -> None:
    tried("inputs: a pipe, device or socket for a file")
    make(kind, workplace / "mesh.stl")
    with pytest.raises(ArmError, match="not a regular file" if kind != "socket" else "mesh"):
        read_hull(workplace / "mesh.stl", (1.0, 1.0, 1.0))


@pytest.mark.parametrize("kind", KINDS)
def test_so_it_is_of_a_bench(kind: str, invoke: Invoke) -> None:
    tried("inputs: a pipe, device or socket for a file")
    make(kind, Path("bench", "results.sqlite"))
    for command in (
        ("report", "bench"),
        ("bench", "export", "bench"),
        ("bench", "run", "vieira/basic", "--out", "bench"),
    ):
        result = invoke(*command)
        assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (2, "", 1)
        assert "results.sqlite is not a regular file" in result.stderr
