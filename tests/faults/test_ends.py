"""However a run ends, the episode as far as it got is on the disk, says why, and the exit code is 0 only where it was achieved."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from phframe.core import Episode, Status
from phframe.runtime.files import load
from tests.cli.conftest import Spawn, install, spawn, workplace  # noqa: F401 - fixtures

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(not hasattr(__import__("os"), "fork"), reason="the watchdog needs fork"),
]
HOSTILE = Path(__file__).with_name("hostile.py")
SCENE = "vieira/simple-07"
PLUGIN_FAULT, OTHER = 2, 1
DEEDS = {
    "raises": (PLUGIN_FAULT, "raised RuntimeError: no idea (line "),
    "raises_what_has_no_text": (PLUGIN_FAULT, "raised MuteError: it cannot say what is wrong (line "),
    "raises_no_exception": (PLUGIN_FAULT, "raised Unruly: x (line "),
    "asks_to_exit": (PLUGIN_FAULT, "asked to exit, with 0"),
    "exits": (OTHER, "its process ended with exit code 0 before there was a result"),
    "segfaults": (OTHER, "its process was ended by signal 11 (Segmentation fault) before there was a result"),
}
"""What a part does, the exit code, and what is said of it."""
TIMEOUTS = ("turns", "swallows_all", "hangs_in_c", "hangs")


def solve(spawn: Spawn, *args: object, **environment: str) -> subprocess.Popen[str]:  # noqa: F811
    return spawn("solve", SCENE, "--no-rerun", "--json", *args, **environment)


def ended(process: subprocess.Popen[str]) -> tuple[str, list[str], Episode]:
    """What was printed, the lines of errors, and the episode; nothing half is left."""
    out, err = process.communicate(timeout=240)
    [folder] = Path("runs").iterdir()
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]
    episode = load(folder / "episode.json")
    assert isinstance(episode, Episode)
    assert (folder / "summary.json").exists() == bool(out)
    if out:
        assert (
            json.loads(out)["status"] == json.loads((folder / "summary.json").read_text())["status"] == episode.status
        )
        assert err == ""
    else:
        assert str(folder) in err
    return out, err.splitlines(), episode


@pytest.mark.parametrize("deed", DEEDS)
def test_a_planner_that_fails_when_it_is_asked_again(deed: str, spawn: Spawn) -> None:  # noqa: F811
    code, said = DEEDS[deed]
    deeds = ("--option", f"deed={deed}", "--option", "at=1")
    process = solve(spawn, "--planner", f"{HOSTILE}:DoesIt", *deeds)
    out, [line], episode = ended(process)
    assert (process.returncode, out) == (code, "")
    assert line.startswith("error: ")
    assert said in line
    assert "DoesIt" in line or code == OTHER
    assert (episode.status, len(episode.plans), len(episode.steps)) == (Status.FAILED, 1, 1)
    assert said in episode.reason


@pytest.mark.parametrize(
    ("part", "name", "deed"),
    [
        ("backend", "DoesItWhileExecuting", "raises"),
        ("backend", "DoesItWhileExecuting", "exits"),
        ("topology", "DoesItInTopology", "raises"),
        ("arm", "DoesItInArm", "raises"),
        ("goal", "DoesItInGoal", "asks_to_exit"),
    ],
)
def test_every_part_that_fails_is_named(part: str, name: str, deed: str, spawn: Spawn) -> None:  # noqa: F811
    code, said = DEEDS[deed]
    plan_in = ("--plan-backend", "pymunk") if part == "backend" else ()
    process = solve(spawn, f"--{part}", f"{HOSTILE}:{name}", *plan_in, DEED=deed)
    _, [line], episode = ended(process)
    assert process.returncode == code
    assert said in line
    assert f"{part} {name!r}" in line or deed == "exits"
    assert episode.status is Status.FAILED
    assert len(episode.steps) == (1 if part == "backend" else 0)


@pytest.mark.parametrize("deed", TIMEOUTS)
def test_what_never_ends_is_ended(deed: str, spawn: Spawn) -> None:  # noqa: F811
    limited = ("--time-limit", 1, "--option", f"deed={deed}")
    process = solve(spawn, "--planner", f"{HOSTILE}:DoesIt", *limited)
    out, errors, episode = ended(process)
    assert process.returncode == OTHER
    assert episode.status is Status.TIMEOUT
    assert (errors == []) is bool(out)
    assert out or errors[0].startswith(
        "error: planning took longer than 1 s and was stopped; what was recorded is in runs"
    )


def test_a_planner_that_does_not_listen_to_its_budget_is_ended(spawn: Spawn) -> None:  # noqa: F811
    process = solve(spawn, "--planner", f"{HOSTILE}:NeverEnough", "--time-limit", 1)
    _, _, episode = ended(process)
    assert (process.returncode, episode.status) == (OTHER, Status.TIMEOUT)


def test_a_topology_engine_that_hangs_is_ended(spawn: Spawn) -> None:  # noqa: F811
    topology = ("--topology", f"{HOSTILE}:DoesItInTopology")
    process = solve(spawn, *topology, "--time-limit", 1, DEED="hangs_in_c")
    _, _, episode = ended(process)
    assert (process.returncode, episode.status) == (OTHER, Status.TIMEOUT)


def test_what_takes_too_much_memory_is_ended(spawn: Spawn) -> None:  # noqa: F811
    if sys.platform != "linux":
        pytest.skip("only Linux says what a process has in use")
    process = solve(spawn, "--planner", f"{HOSTILE}:DoesIt", "--option", "deed=eats", "--memory-limit", 600)
    _, [line], episode = ended(process)
    assert process.returncode == OTHER
    assert line.startswith(
        "error: it used more than the 600 MB of memory that it may have; what was recorded is in runs"
    )
    assert episode.status is Status.FAILED
