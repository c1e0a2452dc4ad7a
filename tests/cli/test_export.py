from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

import phframe
from phframe.core import Episode
from phframe.runtime.scenes import find_scene
from phframe.scenes.mjcf import scene_to_mjcf
from tests.cli.conftest import Invoke, Run

BASIC = scene_to_mjcf(find_scene("vieira/basic"))


@pytest.fixture(scope="module")
def planar_run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The directory of a run in pymunk."""
    folder = tmp_path_factory.mktemp("run")
    phframe.save(phframe.solve("vieira/simple-03"), folder / "episode.json")
    return folder


def test_a_scene_is_mjcf_on_standard_output(invoke: Invoke, workplace: Path) -> None:
    result = invoke("export", "vieira/basic")
    assert result.exit_code == 0
    assert result.stdout == BASIC
    assert result.stderr == ""
    assert list(workplace.iterdir()) == []


@pytest.mark.parametrize(("name", "root"), [("a.xml", "<mujoco"), ("a.urdf", "<robot")])
def test_the_files_name_tells_the_format(invoke: Invoke, name: str, root: str) -> None:
    assert invoke("export", "vieira/basic", "--out", name).exit_code == 0
    assert Path(name).read_text().startswith(root)


def test_a_file_is_not_overwritten_unless_forced(invoke: Invoke, workplace: Path) -> None:
    Path("a.xml").write_text("years of work")
    refused = invoke("export", "vieira/basic", "--out", "a.xml")
    assert refused.exit_code == 2
    assert "--force" in refused.stderr
    assert Path("a.xml").read_text() == "years of work"
    assert invoke("export", "vieira/basic", "--out", "a.xml", "--force").exit_code == 0
    assert Path("a.xml").read_text() == BASIC
    assert [each.name for each in workplace.iterdir()] == ["a.xml"]


def test_parts_are_a_folder_with_the_arm(invoke: Invoke, workplace: Path) -> None:
    command = ["export", "vieira/basic", "--format", "urdf-parts", "--out", "parts", "--arm", "planar"]
    assert invoke(*command, "--option", "arm.link_width=0.1").exit_code == 0
    listed = json.loads(Path("parts/poses.json").read_text())
    assert (Path("parts") / listed["arm"]["urdf"]).read_text().startswith("<robot")
    assert listed["arm"]["position"][0] == -0.1
    assert all((Path("parts") / each["urdf"]).is_file() for each in listed["objects"])
    assert [each.name for each in workplace.iterdir()] == ["parts"]
    (Path("parts") / "mine.txt").write_text("mine")
    assert invoke(*command).exit_code == 2
    assert invoke(*command, "--force").exit_code == 0
    assert (Path("parts") / "mine.txt").read_text() == "mine"
    assert [each.name for each in workplace.iterdir()] == ["parts"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere") if hasattr(os, "geteuid") else lambda f: f
def test_a_folder_that_cannot_be_written_leaves_nothing(invoke: Invoke, workplace: Path) -> None:
    workplace.chmod(0o500)
    try:
        result = invoke("export", "vieira/basic", "--format", "urdf-parts", "--out", "parts")
    finally:
        workplace.chmod(0o700)
    assert result.exit_code == 2
    assert list(workplace.iterdir()) == []


def test_what_is_no_regular_file_is_never_replaced(invoke: Invoke, workplace: Path) -> None:
    Path("link").symlink_to("there.xml")
    os.mkfifo("pipe")
    kept = Path("kept.xml")
    kept.write_text("before")
    kept.chmod(0o600)
    assert invoke("export", "vieira/basic", "--format", "mjcf", "--out", "link").exit_code == 0
    assert invoke("export", "vieira/basic", "--out", "kept.xml", "--force").exit_code == 0
    assert invoke("export", "vieira/basic", "--format", "mjcf", "--out", "/dev/null").exit_code == 0
    refused = invoke("export", "vieira/basic", "--format", "mjcf", "--out", "pipe", "--force")
    assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
    assert Path("link").is_symlink()
    assert Path("there.xml").read_text() == kept.read_text() == BASIC
    assert kept.stat().st_mode & 0o777 == 0o600
    assert Path("pipe").is_fifo()
    assert Path("/dev/null").is_char_device()
    assert sorted(each.name for each in workplace.iterdir()) == ["kept.xml", "link", "pipe", "there.xml"]


def test_a_tilde_is_the_home_also_after_an_equals_sign(
    invoke: Invoke, workplace: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    assert invoke("export", "vieira/basic", "--out=~/a.xml").exit_code == 0
    assert invoke("solve", "vieira/simple-03", "--no-rerun", "-q", "--out=~/run").exit_code == 0
    assert invoke("export", "~/run", "--format", "mjcf", "--out=~/b.xml").exit_code == 0
    assert sorted(each.name for each in (tmp_path / "home").iterdir()) == ["a.xml", "b.xml", "run"]
    assert sorted(each.name for each in (tmp_path / "home" / "run").iterdir()) == ["episode.json", "summary.json"]
    assert list(workplace.iterdir()) == []


def test_the_scene_of_an_episode_is_exported_too(invoke: Invoke, planar_run: Path) -> None:
    expected = scene_to_mjcf(find_scene("vieira/simple-03"))
    for what in (planar_run, planar_run / "episode.json"):
        assert invoke("export", what, "--format", "mjcf").stdout == expected


@pytest.mark.slow
@pytest.mark.needs_mujoco
def test_a_run_in_mujoco_becomes_trajectories(invoke: Invoke) -> None:
    pytest.importorskip("mujoco")
    invoke("solve", "vieira/simple-03", "--backend", "mujoco", "--no-rerun", "--out", "run", "-q")
    content = json.loads(invoke("export", "run").stdout)
    episode = phframe.load("run/episode.json")
    assert isinstance(episode, Episode)
    assert [each["number"] for each in content["trajectories"]] == list(range(1, len(episode.steps) + 1))
    assert invoke("export", "run", "--out", "all.csv").exit_code == 0
    assert invoke("export", "run", "--action", "2", "--out", "one.csv").exit_code == 0
    one = Path("one.csv").read_text().splitlines()
    assert set(one[1:]) < set(Path("all.csv").read_text().splitlines())
    assert all(line.startswith("2,") for line in one[1:])
    assert "actions 1 to" in invoke("export", "run", "--action", "99").stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["vieira/basik"], "Did you mean 'vieira/basic'?"),
        (["vieira/basic", "--format", "mjfc"], "Did you mean 'mjcf'?"),
        (["vieira/basic", "--format", "json"], "is a scene"),
        (["vieira/basic", "--out", "a.csv"], "is a scene"),
        (["vieira/basic", "--format", "urdf-parts"], "--out DIR"),
        (["vieira/basic", "--format", "urdf", "--arm", "planar"], "--arm goes with"),
        (["vieira/basic", "--format", "urdf-parts", "--out", "parts", "--arm", "plannar"], "Did you mean 'planar'?"),
        (["vieira/basic", "--action", "1"], "--action goes with"),
        (["vieira/basic", "--option", "margin=0.02"], "no planner here"),
        (["vieira/basic", "--option", "arm.link_width=1"], "no arm"),
        (["vieira/basic", "--out", "folder"], "is a directory"),
        (["vieira/basic", "--out", "file/below.xml"], "file"),
        (["vieira/basic", "--out", "zero\0byte"], "zero byte"),
        (["vieira/basic", "--out", ""], "is not a path"),
        (["vieira/basic", "--out", "a" * 300], "cannot write"),
        (["folder"], "holds no episode.json"),
        (["absent.json"], "cannot read"),
        (["broken.json"], "is not JSON"),
        (["a" * 5000], ""),
        ([], "missing argument"),
    ],
    ids=lambda value: " ".join(value)[:60] if isinstance(value, list) else "",
)
def test_bad_input_is_one_line(invoke: Invoke, workplace: Path, arguments: list[str], said: str) -> None:
    Path("folder").mkdir()
    Path("file").write_text("")
    Path("broken.json").write_text("{")
    result = invoke("export", *arguments)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert said in result.stderr
    assert sorted(each.name for each in workplace.iterdir()) == ["broken.json", "file", "folder"]


def test_what_was_not_driven_by_joints_and_plans_are_refused(invoke: Invoke, planar_run: Path) -> None:
    refused = invoke("export", planar_run)
    assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
    assert "--backend mujoco" in refused.stderr
    episode = phframe.load(planar_run / "episode.json")
    assert isinstance(episode, Episode)
    phframe.save(episode.plans[0], "plan.json")
    assert "is a plan" in invoke("export", "plan.json").stderr


def test_formats_scenes_and_runs_are_offered(planar_run: Path) -> None:
    from phframe.cli import completion

    assert [name for name, _ in completion.export_formats("urdf")] == ["urdf", "urdf-parts"]
    Path("runs/one").mkdir(parents=True)
    Path("runs/one/episode.json").write_bytes((planar_run / "episode.json").read_bytes())
    assert ("runs/one", "an episode") in completion.scenes_and_runs("ru")
    assert "vieira/basic" in [name for name, _ in completion.scenes_and_runs("vieira/b")]


@pytest.mark.slow
def test_a_pipe_that_closes_early_is_no_error(run: Run) -> None:
    done = run("export", "vieira/basic")
    assert done.returncode == 0
    assert done.stdout == BASIC
