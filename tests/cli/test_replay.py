from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from tests.cli.conftest import Invoke

EASY = "vieira/simple-03"


@pytest.fixture
def made(invoke: Invoke) -> Path:
    assert invoke("solve", EASY, "--option", "margin=0.02", "--no-rerun", "-q", "--out", "run").exit_code == 0
    return Path("run")


def change(path: Path, **changes: Any) -> None:
    document = json.loads(path.read_text())
    document["episode"].update(changes)
    path.write_text(json.dumps(document))


@pytest.mark.usefixtures("made")
@pytest.mark.parametrize("what", ["run", "run/episode.json"])
def test_the_same_bits_are_exit_code_0_and_nothing_is_written(invoke: Invoke, what: str) -> None:
    result = invoke("replay", what)
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith("the same, bit by bit: retrieved")
    assert [path.name for path in Path().iterdir()] == ["run"]


def test_a_difference_is_exit_code_1_and_told_with_the_version_that_differs(invoke: Invoke, made: Path) -> None:
    steps = json.loads((made / "episode.json").read_text())["episode"]["steps"]
    steps[0]["after"]["poses"][0][1] += 0.001
    change(made / "episode.json", steps=steps, versions={"numpy": "0.1"})
    result = invoke("replay", "run", "--json")
    found = json.loads(result.stdout)
    assert result.exit_code == 1
    assert (found["compared"], found["same"]) == ("bits", False)
    assert found["difference"]["step"] == 1
    assert found["difference"]["object"] is not None
    assert found["difference"]["distance"] == pytest.approx(0.001)
    assert found["versions"]["numpy"][0] == "0.1"
    said = invoke("replay", "run").stdout
    assert "step 1: " in said
    assert "numpy 0.1, here " in said


@pytest.mark.usefixtures("made")
@pytest.mark.parametrize("part", [("--planner", "ooa"), ("--arm", "planar")])
def test_another_part_is_compared_by_its_outcome(invoke: Invoke, part: tuple[str, str]) -> None:
    found = json.loads(invoke("replay", "run", *part, "--json").stdout)
    assert found["compared"] == ("outcome" if part[0] == "--planner" else "bits")
    assert found["same"]
    assert found["after"]["status"] == "retrieved"


@pytest.mark.usefixtures("made")
@pytest.mark.needs_mujoco
@pytest.mark.slow
def test_an_episode_is_repeated_on_another_backend(invoke: Invoke) -> None:
    pytest.importorskip("mujoco")
    result = invoke("replay", "run", "--backend", "mujoco", "--out", "again")
    assert result.exit_code == 0
    assert result.stdout.startswith("the same outcome: retrieved")
    assert invoke("replay", "again").stdout.startswith("the same, bit by bit")


@pytest.mark.usefixtures("made")
def test_its_files_are_those_of_a_run(invoke: Invoke) -> None:
    assert invoke("replay", "run", "--out", "again").exit_code == 0
    assert {"episode.json", "summary.json"} <= {path.name for path in Path("again").iterdir()}
    assert invoke("replay", "run", "--out", "again").exit_code == 2


FOREIGN = "from pathlib import Path\nPath('ran').touch()\nfrom phframe.planners.phia import PHIA as Cls\n"


def name_a_file(path: Path, part: str) -> None:
    """Have an episode name a class in a file that says when it is run."""
    Path("x.py").write_text(FOREIGN)
    change(path, spec={**json.loads(path.read_text())["episode"]["spec"], part: "x.py:Cls"})


def test_an_episode_file_runs_no_code_unless_it_is_given(invoke: Invoke, made: Path) -> None:
    name_a_file(made / "episode.json", "planner")
    result = invoke("replay", "run")
    assert (result.exit_code, result.stderr.count("\n")) == (2, 1)
    assert "--planner x.py:Cls" in result.stderr
    assert not Path("ran").exists()
    assert invoke("replay", "run", "--planner", "x.py:Cls").exit_code == 0
    assert Path("ran").exists()


OWN_PARTS = """
from phframe.arms.planar import PlanarArm as Arm
from phframe.backends.pymunk_.physics import PymunkPhysics as Backend
from phframe.pushing.retrieve import Retrieve as Goal
from phframe.topology.ripser_ import Ripser as Topology
"""


@pytest.mark.parametrize("part", ["arm", "backend", "plan-arm", "plan-backend", "topology", "goal"])
def test_an_episode_with_a_part_from_a_file_is_repeated_where_that_is_given(invoke: Invoke, part: str) -> None:
    Path("own.py").write_text(OWN_PARTS)
    given = (f"--{part}", f"./own.py:{part.removeprefix('plan-').capitalize()}")
    assert invoke("solve", EASY, "--option", "margin=0.02", *given, "--no-rerun", "-q", "--out", "run").exit_code == 0
    refused = invoke("replay", "run")
    assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
    assert refused.stderr.strip().endswith(" ".join(given))
    result = invoke("replay", "run", *given)
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith("the same, bit by bit: retrieved")


@pytest.mark.needs_mujoco
@pytest.mark.slow
def test_nor_does_its_export(invoke: Invoke) -> None:
    pytest.importorskip("mujoco")
    assert invoke("solve", EASY, "--backend", "mujoco", "--no-rerun", "-q", "--out", "run").exit_code == 0
    expected = invoke("export", "run").stdout
    name_a_file(Path("run/episode.json"), "arm")
    result = invoke("export", "run")
    assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (2, "", 1)
    assert "--arm x.py:Cls" in result.stderr
    given = json.loads(invoke("export", "run", "--arm", "planar").stdout)
    assert given["trajectories"] == json.loads(expected)["trajectories"]
    assert not Path("ran").exists()


@pytest.mark.parametrize(
    ("what", "said"),
    [
        ("absent.json", "cannot read"),
        ("folder", "holds no episode.json"),
        ("bad.json", "is not JSON"),
        ("", "not a path"),
    ],
)
def test_bad_input_is_one_line(invoke: Invoke, what: str, said: str) -> None:
    Path("folder").mkdir()
    Path("bad.json").write_text("{")
    result = invoke("replay", what)
    assert (result.exit_code, result.stdout, result.stderr.count("\n")) == (2, "", 1)
    assert said in result.stderr
