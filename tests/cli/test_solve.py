from __future__ import annotations

import json
from pathlib import Path

import pytest

from phframe.core import Episode
from tests.cli.conftest import Install, Invoke, Run

KEYS = [
    *(
        "format",
        "scene",
        "planner",
        "variant",
        "backend",
        "arm",
        "plan_backend",
        "plan_arm",
        "topology",
        "goal",
        "seed",
    ),
    "noise",
    *("status", "reason", "actions", "planning_time", "motion_planning_time", "execution_time", "simulated_actions"),
    *("replans", "toppled", "spilled", "target_moved", "tracking_error", "prediction_error", "wall_contact", "clean"),
    *("recording", "versions"),
]
GIVES_UP = """
from phframe.core import Options, Plan, Planner, Status

class GivesUp(Planner[Options]):
    options_type = Options

    def search(self, task):
        return Plan(Status.FAILED, "no [red]way[/red] in")

class Breaks(GivesUp):
    def search(self, task):
        raise RuntimeError("never meant to be")
"""


@pytest.mark.slow
def test_json_is_exactly_one_object_and_the_same_in_two_processes(run: Run, workplace: Path) -> None:
    results = [run("solve", "random/1", "--planner", "ooa", "--seed", "7", "--no-rerun", "--json") for _ in range(2)]
    for result in results:
        assert result.returncode == 0
        assert result.stderr == ""
        assert result.stdout.count("\n") == 1
    one, two = (json.loads(result.stdout) for result in results)
    assert list(one) == KEYS
    assert {**one, "planning_time": 0} == {**two, "planning_time": 0}
    assert (one["status"], one["seed"], one["planner"], one["scene"]) == ("retrieved", 7, "ooa", "random/1")
    assert len(list((workplace / "runs").iterdir())) == 2


@pytest.mark.needs_rerun
def test_a_run_leaves_episode_summary_and_recording(invoke: Invoke) -> None:
    pytest.importorskip("rerun")
    result = invoke("solve", "--out", "here", "--json")
    summary = json.loads(result.stdout)
    assert (result.exit_code, summary["status"], summary["scene"]) == (0, "retrieved", "vieira/basic")
    assert sorted(path.name for path in Path("here").iterdir()) == ["episode.json", "recording.rrd", "summary.json"]
    assert json.loads(Path("here/summary.json").read_text()) == summary
    assert summary["recording"] == str(Path("here/recording.rrd"))
    assert Path("here/recording.rrd").read_bytes().startswith(b"RRF")
    assert _episode(Path("here")).pushes == summary["actions"]


def test_people_get_a_table(invoke: Invoke) -> None:
    result = invoke("solve", "vieira/simple-03", "--no-rerun", "--out", "here")
    assert result.exit_code == 0
    rows = dict(line.split("  ", 1) for line in result.stdout.splitlines())
    assert rows["status"].strip() == "retrieved"
    assert rows["files"].strip() == "here"
    assert "simulated" in rows["planning"]
    assert {"pushes", "execution", "replans", "toppled", "spilled", "clean"} <= set(rows)
    assert result.stderr == ""


def test_quiet_says_nothing(invoke: Invoke) -> None:
    result = invoke("solve", "vieira/simple-03", "--no-rerun", "--quiet")
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", "")


def test_any_other_outcome_is_exit_code_1_with_its_reason(invoke: Invoke) -> None:
    Path("mine.py").write_text(GIVES_UP)
    result = invoke("solve", "--planner", "./mine.py:GivesUp", "--no-rerun", "--out", "here")
    assert result.exit_code == 1
    assert "no [red]way[/red] in" in result.stdout
    assert json.loads(Path("here/summary.json").read_text())["status"] == "failed"


def test_an_error_in_a_planner_is_one_line_and_its_traceback_and_the_episode_are_kept(
    invoke: Invoke, monkeypatch: pytest.MonkeyPatch
) -> None:
    Path("mine.py").write_text(GIVES_UP)
    arguments = ("solve", "--planner", "./mine.py:Breaks", "--no-rerun", "--json")
    result = invoke(*arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("error: planner './mine.py:Breaks' raised RuntimeError: never meant to be (line ")
    assert result.stderr.count("\n") == 1
    kept = result.stderr.partition("the traceback is in ")[2].partition(";")[0]
    assert "mine.py" in Path(kept).read_text()
    [folder] = Path("runs").iterdir()
    assert result.stderr.endswith(f"; what was done until then is in {folder}\n")
    assert "never meant to be" in _episode(folder).reason
    monkeypatch.setenv("PHFRAME_DEBUG", "1")
    assert "Traceback (most recent call last)" in invoke(*arguments).stderr


def test_an_internal_error_is_one_line_and_the_traceback_is_kept(
    invoke: Invoke, monkeypatch: pytest.MonkeyPatch
) -> None:
    def breaks(*_: object) -> None:
        raise RuntimeError("never meant to be")

    monkeypatch.setattr("phframe.planners.phia.PHIA.search", breaks)
    result = invoke("solve", "--no-rerun", "--json")
    assert (result.exit_code, result.stdout) == (70, "")
    assert result.stderr.startswith("error: internal: RuntimeError: never meant to be")
    assert result.stderr.count("\n") == 1
    assert "test_solve.py" in Path(result.stderr.partition("the traceback is in ")[2].partition(";")[0]).read_text()


def test_options_reach_their_parts(invoke: Invoke) -> None:
    arguments = ["arm.link_width=0.1", "margin=0.02", "scenes.count=3", "backend.step=0.004"]
    options = [text for option in arguments for text in ("--option", option)]
    result = invoke("solve", "random/2", *options, "--no-rerun", "--out", "here", "--json")
    assert result.exit_code in (0, 1)
    episode = _episode(Path("here"))
    assert len(episode.scene.objects) == 4
    assert {part: dict(values) for part, values in episode.spec.options.items() if values} == {
        "planner": {"margin": 0.02},
        "arm": {"link_width": 0.1},
        "backend": {"step": 0.004},
        "scenes": {"count": 3},
    }


@pytest.mark.slow
def test_without_rerun_there_is_a_hint_unless_it_was_asked_for(run: Run, install: Install, tmp_path: Path) -> None:
    install("phframe", version="0.0", requires=("no-such-sdk; extra == 'rerun'",))
    (tmp_path / "site" / "rerun").mkdir()
    absent = "raise ModuleNotFoundError(\"No module named 'rerun'\", name='rerun')"
    (tmp_path / "site" / "rerun" / "__init__.py").write_text(absent)
    default = run("solve", "vieira/simple-03", "--json")
    assert default.returncode == 0
    assert json.loads(default.stdout)["recording"] is None
    assert default.stderr.startswith("hint: nothing is recorded")
    assert default.stderr.count("\n") == 1
    assert 'pip install "phframe[rerun]"' in default.stderr
    asked = run("solve", "vieira/simple-03", "--rerun", "--out", "new")
    assert (asked.returncode, asked.stdout) == (3, "")
    assert 'pip install "phframe[rerun]"' in asked.stderr
    assert not Path("new").exists()


@pytest.mark.needs_rerun
def test_the_viewer_without_a_display_is_refused_before_the_run(
    invoke: Invoke, workplace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("rerun")
    monkeypatch.setattr("sys.platform", "linux")
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    result = invoke("solve", "--view")
    assert (result.exit_code, result.stdout) == (2, "")
    assert "display" in result.stderr
    assert list(workplace.iterdir()) == []


def _episode(folder: Path) -> Episode:
    from phframe.runtime.files import load

    episode = load(folder / "episode.json")
    assert isinstance(episode, Episode)
    return episode
