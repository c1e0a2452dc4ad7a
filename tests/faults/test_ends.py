"""However a run ends, the episode as far as it got is on the disk, says why, and the exit code is 0 only where it was achieved."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from phframe.bench.store import ResultStore
from phframe.core import Episode, RunSpec, Status
from phframe.runtime.files import load, save
from phframe.runtime.run import run
from tests.cli.conftest import Spawn, install, spawn, workplace  # noqa: F401 - fixtures
from tests.trials import TIMES, tried

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
CASES = [
    ("vieira/simple-07", 1),
    ("vieira/simple-01", 2),
    ("vieira/simple-04", 3),
    ("vieira/simple-06", 0),
    ("vieira/simple-05", 1),
    ("vieira/simple-04", 2),
    ("papallas/s01", 1),
    ("vieira/simple-08", 2),
    ("random/0", 1),
    ("vieira/basic", 3),
][:TIMES]
"""Scenes, and how many actions are carried out in each before it is done."""
DEED = re.compile(r"deed=(\w+)|$")
"""In the name of a planner; none in that of one that does as it does by default."""
TIMEOUTS = ("turns", "swallows_all", "hangs_in_c", "hangs")


def solve(
    spawn: Spawn,  # noqa: F811
    *args: object,
    scene: str = SCENE,
    **environment: str,
) -> subprocess.Popen[str]:
    tried("processes: a run with a hostile part")
    return spawn("solve", scene, "--no-rerun", "--json", *args, **environment)


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


@pytest.mark.parametrize(("scene", "at"), CASES)
@pytest.mark.parametrize("deed", DEEDS)
def test_a_planner_that_fails_when_it_is_asked_again(deed: str, scene: str, at: int, spawn: Spawn) -> None:  # noqa: F811
    code, said = DEEDS[deed]
    deeds = ("--option", f"deed={deed}", "--option", f"at={at}")
    process = solve(spawn, "--planner", f"{HOSTILE}:DoesIt", *deeds, scene=scene)
    out, [line], episode = ended(process)
    assert (process.returncode, out) == (code, "")
    assert line.startswith("error: ")
    assert said in line
    assert "DoesIt" in line or code == OTHER
    assert (episode.status, len(episode.plans), len(episode.steps)) == (Status.FAILED, at, at)
    assert said in episode.reason


PARTS = {
    "backend": "DoesItWhileExecuting",
    "topology": "DoesItInTopology",
    "arm": "DoesItInArm",
    "goal": "DoesItInGoal",
}
FEW = [
    ("backend", "raises"),
    ("backend", "exits"),
    ("topology", "raises"),
    ("arm", "raises"),
    ("goal", "asks_to_exit"),
]
"""What is tried as usual; of more than that, everything."""


@pytest.mark.parametrize("scene", [scene for scene, _ in CASES[:3]])
@pytest.mark.parametrize(("part", "deed"), FEW if TIMES == 1 else [(part, deed) for part in PARTS for deed in DEEDS])
def test_every_part_that_fails_is_named(part: str, deed: str, scene: str, spawn: Spawn) -> None:  # noqa: F811
    (code, said), name = DEEDS[deed], PARTS[part]
    plan_in = ("--plan-backend", "pymunk") if part == "backend" else ()
    process = solve(spawn, f"--{part}", f"{HOSTILE}:{name}", *plan_in, scene=scene, DEED=deed)
    _, [line], episode = ended(process)
    assert process.returncode == code
    assert said in line
    assert f"{part} {name!r}" in line or code == OTHER
    assert episode.status is Status.FAILED
    assert len(episode.steps) == (1 if part == "backend" else 0)


@pytest.mark.parametrize(("scene", "at"), [(SCENE, 0), *CASES[1:4]])
@pytest.mark.parametrize("deed", TIMEOUTS)
def test_what_never_ends_is_ended(deed: str, scene: str, at: int, spawn: Spawn) -> None:  # noqa: F811
    limited = ("--time-limit", 1, "--option", f"deed={deed}", "--option", f"at={at}")
    process = solve(spawn, "--planner", f"{HOSTILE}:DoesIt", *limited, scene=scene)
    out, errors, episode = ended(process)
    assert process.returncode == OTHER
    assert episode.status is Status.TIMEOUT
    assert (errors == []) is bool(out)
    assert out or re.match(  # what is left of the second, where it was asked before
        r"error: planning took longer than (1|0\.\d+) s and was stopped; what was recorded is in runs", errors[0]
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


@pytest.mark.parametrize(("scene", "_at"), CASES)
def test_a_repetition_with_a_part_that_fails(scene: str, _at: int, spawn: Spawn) -> None:  # noqa: F811
    save(run(RunSpec(scene)), "before.json")
    deed = list(DEEDS)[CASES.index((scene, _at)) % len(DEEDS)]
    (code, said), name = DEEDS[deed], PARTS["backend"]
    tried("processes: a repetition with a hostile part")
    process = spawn("replay", "before.json", "--backend", f"{HOSTILE}:{name}", "--out", "runs/again", DEED=deed)
    out, [line], episode = ended(process)
    assert (process.returncode, out) == (code, "")
    assert said in line
    assert (episode.status, len(episode.steps)) == (Status.FAILED, 1)


def test_trials_of_a_bench_that_fail_are_its_results(spawn: Spawn) -> None:  # noqa: F811
    """Each is a process of its own, and so is what ends it."""
    scenes = list(dict.fromkeys(scene for scene, _ in CASES))
    planners = [f"{HOSTILE}:DoesIt[deed={deed},at={at}]" for at in (0, 1) for deed in DEEDS]
    given = [word for planner in planners for word in ("--planner", planner)]
    tried("processes: a trial of a bench with a hostile planner", len(scenes) * len(planners))
    process = spawn("bench", "run", *scenes, *given, "--out", "bench", "--quiet", "--workers", 2)
    assert (process.communicate(timeout=600), process.returncode) == (("", ""), OTHER)
    with ResultStore.open("bench") as store:
        found = Counter((DEED.findall(row.planner)[0] or "raises", row.end) for row in store.results())
    ends = {"exits": "crashed", "segfaults": "crashed"}
    assert found == {(deed, ends.get(deed, "error")): 2 * len(scenes) for deed in DEEDS}
