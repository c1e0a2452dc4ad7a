"""``phframe scenes``: suites in full, and one scene as a table, JSON, picture or file."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from phframe.cli import completion
from phframe.runtime.scenes import find_scene
from phframe.scenes import Paper, read_scene, scene_to_yaml
from tests.cli.conftest import ROOT, Invoke, Run

SUITES = {"vieira": 21, "papallas": 10, "random": 10, "dense": 30, "near": 30, "paper": 121}


@pytest.mark.parametrize(("suite", "count"), SUITES.items())
def test_the_description_of_a_suite_lists_all_its_scenes(invoke: Invoke, suite: str, count: int) -> None:
    described = json.loads(invoke("scenes", suite, "--json").stdout)
    assert (described["kind"], len(described["scenes"])) == ("scenes", count)
    told = invoke("scenes", suite).stdout
    assert f"{count} listed: " in told
    assert set(described["scenes"]) <= set(told.replace(",", "").split())


def test_the_listing_of_all_suites_counts_the_scenes_of_large_ones_and_names_a_few(invoke: Invoke) -> None:
    told, listed = invoke("scenes").stdout, json.loads(invoke("scenes", "--json").stdout)["scenes"]
    assert {suite["name"]: len(suite["scenes"]) for suite in listed} == SUITES
    assert all(f"{count} listed: {suite}/" in told for suite, count in SUITES.items())
    assert "paper/random-2, ..., paper/simple-10" in told
    assert "papallas/s05" in told


def test_a_scene_is_told_with_its_corridor(invoke: Invoke) -> None:
    result = invoke("scenes", "vieira/basic")
    assert (result.exit_code, result.stderr) == (0, "")
    lines = result.stdout.splitlines()
    assert lines[0] == "vieira/basic"
    assert "11 objects cover 9.3% of its board" in lines[1]
    assert "0.432 m from the mouth and 0.232 m from the north wall" in lines[2]
    assert lines[3] == "corridor: straight, half-width 0.12 m, obstacles in it: 7"
    assert sum(line.endswith("in the corridor") for line in lines) == 7
    assert {line.split()[0] for line in lines[6:]} == set(find_scene("vieira/basic").ids)
    assert lines[-1].endswith("target")


def test_an_angled_corridor_is_told_with_its_angle(invoke: Invoke) -> None:
    assert "corridor: at 33.6 degrees, half-width 0.12 m" in invoke("scenes", "papallas/s08").stdout


def test_json_has_the_scene_as_in_its_file(invoke: Invoke) -> None:
    result = invoke("scenes", "near/0", "--json")
    assert (result.exit_code, result.stderr, result.stdout.count("\n")) == (0, "", 1)
    told, scene = json.loads(result.stdout), find_scene("near/0")
    assert list(told) == ["format", "scene", "coverage", "corridor"]
    assert told["coverage"] == scene.coverage
    Path("again.yaml").write_text(json.dumps(told["scene"]).replace(', "friction": null', ""))  # JSON is YAML
    assert read_scene("again.yaml") == scene
    assert (told["corridor"]["reason"], told["corridor"]["half_width"]) == ("", 0.12)
    assert set(told["corridor"]["members"]) < set(scene.ids)


def test_a_shelf_too_narrow_for_a_corridor_says_so(invoke: Invoke) -> None:
    narrow = ("random/4", "--option", "scenes.width=0.2", "--option", "scenes.count=1")
    assert "corridor: none, since the shelf is 0.2 m wide" in invoke("scenes", *narrow).stdout
    corridor = json.loads(invoke("scenes", *narrow, "--json").stdout)["corridor"]
    assert (corridor["angle"], corridor["beside"], corridor["members"]) == (None, None, [])
    assert "0.2 m wide" in corridor["reason"]


@pytest.mark.parametrize("name", ["paper/random-7", "dense/3", "vieira/simple-01"])
def test_a_scene_is_written_as_the_file_that_it_is(invoke: Invoke, workplace: Path, name: str) -> None:
    result = invoke("scenes", name, "--out", "scene.yaml")
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr == "wrote scene.yaml\n"
    assert read_scene("scene.yaml") == find_scene(name)
    assert [each.name for each in workplace.iterdir()] == ["scene.yaml"]
    assert invoke("scenes", name, "--out", "-").stdout == scene_to_yaml(find_scene(name))


def test_a_scene_file_is_shown_like_a_scene(invoke: Invoke) -> None:
    shutil.copy(ROOT / "docs" / "examples" / "three-cups.yaml", "cups.yaml")
    shutil.copy("cups.yaml", "plain")
    for spec in ("cups.yaml", "./cups.yaml", "plain", Path("cups.yaml").resolve()):
        assert invoke("scenes", spec).stdout.startswith("three-cups\n")


def test_a_file_called_like_a_suite_hides_no_suite(invoke: Invoke) -> None:
    Path("vieira").touch()
    assert "21 listed" in invoke("scenes", "vieira").stdout


def test_options_of_the_suite_are_those_of_the_scene(invoke: Invoke) -> None:
    told = json.loads(invoke("scenes", "random/7", "--option", "scenes.count=3", "--json").stdout)
    assert len(told["scene"]["objects"]) == 4


def test_the_picture_is_drawn_once_and_again_only_if_forced(invoke: Invoke, workplace: Path) -> None:
    pytest.importorskip("matplotlib")
    command = ["scenes", "near/2", "--out", "near.png"]
    result = invoke(*command)
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "wrote near.png\n")
    content = Path("near.png").read_bytes()
    assert content.startswith(b"\x89PNG")
    again = invoke(*command)
    assert again.exit_code == 2
    assert "near.png is there already" in again.stderr
    assert "--force" in again.stderr
    forced = invoke(*command, "--force", "--json")
    assert json.loads(forced.stdout)["scene"]["name"] == "near/2"
    assert Path("near.png").read_bytes() == content
    assert [each.name for each in workplace.iterdir()] == ["near.png"]


def test_without_matplotlib_it_says_what_to_install_and_tables_need_none(
    run: Run, tmp_path: Path, workplace: Path
) -> None:
    hook = "import importlib.util as u\nf = u.find_spec\nu.find_spec = lambda n, *a: None if n == 'matplotlib' else f(n, *a)\n"
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(hook)
    done = run("scenes", "vieira/basic", "--out", "basic.png")
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (3, "", 1)
    assert "phframe[plots]" in done.stderr
    assert list(workplace.iterdir()) == []
    assert run("scenes", "vieira/basic", "--out", "basic.yaml").returncode == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["vieira/basik"], "Did you mean 'vieira/basic'?"),
        (["papper/basic"], "Did you mean 'paper'?"),
        (["papper"], "Did you mean 'paper'?"),
        (["papper", "--out", "a.png"], "Did you mean 'paper'?"),
        (["paper/random-100"], "and 111 more"),
        (["vieira/"], "Did you mean 'vieira/basic'?"),
        (["near/-1"], "Every whole number from 0"),
        (["./nothing.yaml"], "no such file"),
        (["./"], "is a directory"),
        (["."], "There is: dense, near"),
        (["./mine.py:Mine"], "cannot read mine.py"),
        (["lab:suite"], "There is: "),
        (["--out", "a.png"], "--out goes with one scene"),
        (["dense", "--out", "a.png"], "--out goes with one scene"),
        (["dense", "--option", "scenes.most=30"], "--option goes with one scene"),
        (["dense/3", "--option", "scenes.moist=30"], "Did you mean 'most'?"),
        (["dense/3", "--option", "scenes.most=2"], "less than fewest, 20"),
        (["dense/3", "--option", "scenes.radius=0.1"], "lower most, radius"),
        (["dense/3", "--option", "margin=1"], "no planner here"),
        (["vieira/basic", "--out", "a.pdf"], "--out FILE.png or FILE.yaml"),
        (["vieira/basic", "--out", "a"], "--out FILE.png or FILE.yaml"),
        (["vieira/basic", "--out", ""], "--out FILE.png or FILE.yaml"),
        (["vieira/basic", "--out", "-", "--json"], "--json and --out -"),
        (["vieira/basic", "--out", "/dev/null/a.yaml"], "cannot write /dev/null/a.yaml"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_bad_input_is_one_line(invoke: Invoke, workplace: Path, arguments: list[str], said: str) -> None:
    result = invoke("scenes", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert said in result.stderr
    assert list(workplace.iterdir()) == []


def test_the_shell_is_offered_suites_and_their_scenes() -> None:
    assert [name for name, _ in completion.suites_and_scenes("pap")][:2] == ["papallas", "paper"]
    offered = [name for name, _ in completion.suites_and_scenes("paper/")]
    assert offered == [f"paper/{name}" for name in Paper().names()]
    assert [name for name, _ in completion.scenes("dense/2")] == ["dense/2", *(f"dense/2{n}" for n in range(10))]
