from __future__ import annotations

import json
from pathlib import Path

import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.motion.reachability import reachability
from phframe.runtime.scenes import find_scene
from tests.cli.conftest import Invoke, Run


def test_the_shares_are_those_of_the_map(invoke: Invoke, workplace: Path) -> None:
    scene, arm = find_scene("papallas/s02"), PlanarArm(PlanarArmOptions(link_width=0.5))
    result = invoke("arm", "reach", "--scene", "papallas/s02", "--option", "arm.link_width=0.5", "--json")
    assert result.exit_code == 0
    fractions, reach = json.loads(result.stdout), reachability(scene.shelf, arm, arm.default_base_pose(scene.shelf))
    assert fractions["fraction"] == reach.fraction < 0.7
    assert fractions["straight"] < fractions["fraction"]
    assert len(fractions["depths"]) == len(fractions["fraction_at_depth"]) == len(reach.depths)
    assert sum(fractions["fraction_at_depth"]) / len(reach.depths) == pytest.approx(reach.fraction)
    assert list(workplace.iterdir()) == []


def test_the_sentence_says_from_where_how_much_is_reached(invoke: Invoke) -> None:
    said = invoke("arm", "reach").stdout
    assert "planar with its base at x -0.100, y 0.305" in said
    assert "100.0% of the shelf of vieira/basic" in said
    assert "x -3.000" in (far := invoke("arm", "reach", "--mount", "-3", "0.3", "0.06", "0").stdout)
    assert "reaches 0.0%" in far


def test_the_map_is_drawn_once_and_again_only_if_forced(invoke: Invoke, workplace: Path) -> None:
    pytest.importorskip("matplotlib")
    command = ["arm", "reach", "--out", "reach.png"]
    assert invoke(*command).exit_code == 0
    assert Path("reach.png").read_bytes().startswith(b"\x89PNG")
    assert invoke(*command).exit_code == 2
    assert invoke(*command, "--force").exit_code == 0
    assert [each.name for each in workplace.iterdir()] == ["reach.png"]


def test_without_matplotlib_it_says_what_to_install(run: Run, tmp_path: Path, workplace: Path) -> None:
    hook = "import importlib.util as u\nf = u.find_spec\nu.find_spec = lambda n, *a: None if n == 'matplotlib' else f(n, *a)\n"
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(hook)
    done = run("arm", "reach", "--out", "reach.png")
    assert done.returncode == 3
    assert done.stderr.count("\n") == 1
    assert "phframe[plots]" in done.stderr
    assert list(workplace.iterdir()) == []


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["rech"], "Did you mean 'reach'?"),
        (["reach", "--arm", "plannar"], "Did you mean 'planar'?"),
        (["reach", "--scene", "vieira/basik"], "Did you mean 'vieira/basic'?"),
        (["reach", "--mount", "nan", "0", "0", "0"], "finite"),
        (["reach", "--mount", "1", "0"], "--mount"),
        (["reach", "--mount", "1e300", "0", "0", "0"], "x is 1e+300; distances (m) are from -100 to 100"),
        (["reach", "--option", "margin=1"], "no planner here"),
        (["reach", "--option", "arm.link_width=0"], "link_width"),
        (["reach", "--out", "-"], "--out FILE.png"),
        (["reach", "--out", "."], "--out FILE.png"),
        (["reach", "--out", "reach.jpg", "--scene", "no/such"], "--out FILE.png"),
        (["reach", "--out", "reach"], "--out FILE.png"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_bad_input_is_one_line(invoke: Invoke, workplace: Path, arguments: list[str], said: str) -> None:
    result = invoke("arm", *arguments)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert said in result.stderr
    assert list(workplace.iterdir()) == []


def test_a_group_alone_shows_its_help_and_is_no_success(invoke: Invoke) -> None:
    result = invoke("arm")
    assert result.exit_code == 2
    assert "reach" in result.stdout


@pytest.mark.needs_baxter
def test_a_mount_among_the_options_is_where_the_base_stands(invoke: Invoke) -> None:
    pytest.importorskip("pinocchio")
    options = ["--option", "arm.side=right", "--option", "arm.mount=[-0.675,0.642,-0.25,0]"]
    said = json.loads(invoke("arm", "reach", "--arm", "baxter", "--scene", "papallas/s01", *options, "--json").stdout)
    assert said["mount"] == [-0.675, 0.642, -0.25, 0.0]
    assert said["target_out_of_reach"] is None
    assert said["fraction"] > 0.95


@pytest.mark.slow
@pytest.mark.needs_baxter
def test_where_the_base_would_have_to_stand_is_told(invoke: Invoke) -> None:
    pytest.importorskip("pinocchio")
    own = ["--option", "arm.side=left", "--mount", "-0.675", "-0.058", "-0.15", "0"]
    said = invoke("arm", "reach", "--arm", "baxter", "--scene", "papallas/s08", *own).stdout
    assert "its target is out of reach at every yaw" in said
    auto = ["--option", "arm.mount=auto", "--json"]
    found = json.loads(invoke("arm", "reach", "--arm", "baxter", "--scene", "papallas/s08", *auto).stdout)
    assert found["target_out_of_reach"] is None
    assert found["mount"] != [-0.675, -0.058, -0.15, 0.0]


@pytest.mark.needs_baxter
def test_an_exported_arm_stands_where_its_options_have_it(invoke: Invoke, workplace: Path) -> None:
    pytest.importorskip("pinocchio")
    options = ["--option", "arm.side=right", "--option", "arm.mount=[-0.675,0.642,-0.25,0]"]
    done = invoke("export", "papallas/s01", "--format", "urdf-parts", "--arm", "baxter", *options, "--out", "parts")
    assert done.exit_code == 0, done.output
    listed = json.loads(next(workplace.glob("parts/*.json")).read_text())
    assert listed["arm"]["position"] == [-0.675, 0.642, -0.25]
    assert 'name="baxter_right"' in (workplace / "parts" / listed["arm"]["urdf"]).read_text()
