from __future__ import annotations

from pathlib import Path

import pytest

from phframe.scenes import read_scene
from tests.cli.conftest import Invoke, Run

pytestmark = pytest.mark.needs_mujoco
FOREIGN = Path(__file__).parents[1] / "scenes" / "foreign.xml"


def test_a_file_is_written_that_can_be_solved(invoke: Invoke, workplace: Path) -> None:
    pytest.importorskip("mujoco")
    result = invoke("scene", "import", FOREIGN, "--out", "cabinet.yaml", "--target", "cola", "--name", "cabinet")
    assert (result.exit_code, result.stdout) == (0, "")
    assert "ignored: actuators: 1" in result.stderr
    scene = read_scene("cabinet.yaml")
    assert (scene.name, scene.target) == ("cabinet", "cola")
    assert invoke("solve", "cabinet.yaml", "--no-rerun", "--out", "run").exit_code == 0
    assert invoke("scene", "import", FOREIGN, "--out", "cabinet.yaml").exit_code == 2
    assert read_scene("cabinet.yaml") == scene
    assert sorted(each.name for each in workplace.iterdir()) == ["cabinet.yaml", "run"]


def test_only_the_scene_goes_to_standard_output(invoke: Invoke) -> None:
    pytest.importorskip("mujoco")
    result = invoke("scene", "import", FOREIGN)
    assert result.stdout.startswith("phframe: 1\n")
    Path("again.yaml").write_text(result.stdout)
    assert read_scene("again.yaml").name == "lab cabinet"


def test_what_is_exported_can_be_imported(invoke: Invoke) -> None:
    pytest.importorskip("mujoco")
    invoke("export", "papallas/s02", "--arm", "planar", "--out", "s02.xml")
    invoke("scene", "import", "s02.xml", "--out", "s02.yaml")
    from phframe.runtime.scenes import find_scene

    assert read_scene("s02.yaml") == find_scene("papallas/s02")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["absent.xml"], "no such file"),
        (["broken.xml"], "not valid XML"),
        ([FOREIGN, "--target", "colla"], "Did you mean 'cola'?"),
        ([FOREIGN, "--out", "."], "directory"),
        ([FOREIGN, "--name", "two\nlines"], "name"),
        ([], "missing argument"),
    ],
)
def test_bad_input_is_one_line(invoke: Invoke, workplace: Path, arguments: list[object], said: str) -> None:
    pytest.importorskip("mujoco")
    Path("broken.xml").write_text("<mujoco")
    result = invoke("scene", "import", *arguments)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert said in result.stderr
    assert [each.name for each in workplace.iterdir()] == ["broken.xml"]


def test_without_mujoco_it_says_what_to_install(run: Run, tmp_path: Path) -> None:
    hook = (
        "import importlib.util as u\nf = u.find_spec\nu.find_spec = lambda n, *a: None if n == 'mujoco' else f(n, *a)\n"
    )
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(hook)
    for command in (("scene", "import", FOREIGN), ("export", "vieira/basic", "--arm", "planar")):
        done = run(*command)
        assert (done.returncode, done.stdout, done.stderr.count("\n")) == (3, "", 1)
        assert "phframe[mujoco]" in done.stderr
