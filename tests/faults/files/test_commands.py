"""The commands, given files in which anything is wrong: exit code 0, 1, 2 or 3, at most one line of complaint, no code run."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner, Result

from phframe.cli.main import app
from phframe.runtime.files import FORMAT, content_of
from phframe.runtime.scenes import find_scene
from phframe.runtime.solve import solve
from phframe.scenes import scene_to_yaml
from phframe.scenes.writer import scene_content
from tests.faults.files.spoiling import TEXTS, spoilt, spoilt_text
from tests.faults.files.yaml_text import YAML, as_yaml
from tests.trials import many, tried

pytestmark = pytest.mark.slow
SCENE = find_scene("vieira/simple-10")
SCENES = spoilt(scene_content(SCENE)).map(as_yaml) | spoilt_text(scene_to_yaml(SCENE), (*TEXTS, *YAML))
CONTENT = json.loads(json.dumps(content_of(solve("vieira/simple-10"))))
RUNS = "open('ran', 'w').close()\nfrom phframe.planners.phia import PHIA as Cls\n"


def _with_spec(spec: Any) -> Any:
    return {"phframe": FORMAT, "kind": "episode", "episode": {**CONTENT, "spec": spec}}


PARTS = ("planner", "backend", "arm", "plan_backend", "plan_arm", "topology", "goal", "scene")
NAMES = (
    "./x.py:Cls",
    "x.py:Cls",
    "x.py",
    "x:Cls",
    "phframe:phia",
    "phia[sweeps=paper]",
    "phia[",
    "./x.py:Cls[a=1]",
    "",
    "fast",
)
SPECS = spoilt(CONTENT["spec"]) | st.builds(
    lambda part, name: {**CONTENT["spec"], part: name}, st.sampled_from(PARTS), st.sampled_from(NAMES)
)
given_anything = settings(deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The working directory, with code in it that tells when it runs."""
    (tmp_path / "x.py").write_text(RUNS)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "200")
    return tmp_path


def asked(place: Path, *arguments: str) -> Result:
    result = CliRunner().invoke(app, arguments, prog_name="phframe")
    assert result.exit_code in (0, 1, 2, 3), (result.exit_code, result.stderr, result.exception)
    assert result.stderr.count("\n") == (1 if result.exit_code in (2, 3) else 0), result.stderr
    assert result.stderr.replace("\n", "").isprintable()
    assert "internal" not in result.stderr
    assert not (place / "ran").exists()
    assert not [each for each in place.rglob("*") if ".part" in each.name]
    return result


@settings(given_anything, max_examples=many(12))
@given(text=SCENES)
def test_scenes_are_shown_and_solved_or_refused(place: Path, text: str) -> None:
    tried("inputs: scene files given to commands")
    (place / "scene.yaml").write_text(text, encoding="utf-8", errors="surrogatepass")
    shown = asked(place, "scenes", "scene.yaml", "--json")
    solved = asked(place, "solve", "scene.yaml", "--no-rerun", "--json", "--time-limit", "5")
    assert (shown.exit_code == 0) is (solved.exit_code in (0, 1))
    if shown.exit_code == 0:
        json.loads(shown.stdout), json.loads(solved.stdout)


@settings(given_anything, max_examples=many(12))
@given(spec=SPECS)
def test_episodes_are_repeated_or_refused(place: Path, spec: Any) -> None:
    tried("inputs: runs of episodes given to commands")
    (place / "episode.json").write_text(json.dumps(_with_spec(spec)))
    asked(place, "replay", "episode.json", "--json")
    asked(place, "export", "episode.json", "--out", "-")
