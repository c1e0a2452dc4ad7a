"""Files of episodes in which anything is wrong: an episode that all of phframe takes, or one line that names the file."""

from __future__ import annotations

import functools
import json
import operator
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import Episode, InputError, Motion, PhframeError, Plan, SearchNode, State
from phframe.runtime.border import problem_of_motion, problem_of_state
from phframe.runtime.files import FORMAT, content_of, load, save
from phframe.runtime.joint_trajectories import as_csv, as_json, joint_trajectories
from phframe.runtime.replay import StoredAdvice, differing_versions, first_difference, spec_of
from phframe.runtime.solve import solve
from phframe.runtime.summary import summarize
from tests.faults.files.spoiling import TEXTS, a_line, spoilt, spoilt_text
from tests.trials import many, tried

CORPUS = Path(__file__).parent / "corpus" / "episodes"
ARM = PlanarArm(PlanarArmOptions())
EPISODE = solve("vieira/simple-10", seed=3)


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return save(EPISODE, tmp_path_factory.mktemp("files") / "episode.json")


def _document(content: Any) -> Any:
    """What is in the file of an episode."""
    return {"phframe": FORMAT, "kind": "episode", "episode": content}


CONTENT = json.loads(json.dumps(content_of(EPISODE)))
TEXT = json.dumps(_document(CONTENT), indent=0)
DOCUMENTS = spoilt(CONTENT).map(_document) | spoilt(CONTENT).map(_document) | spoilt(_document(CONTENT))
PIECES = (
    *map(json.dumps, TEXTS),
    "NaN",
    "-Infinity",
    "1e999",
    "9" * 5000,
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "[" * 3000,
    '"./x.py:Cls"',
)


def judged(text: str, path: Path) -> Plan | Episode | str:
    """What is in a file, which all of phframe must then take; or what is wrong with it, a line."""
    path.write_text(text, encoding="utf-8", errors="surrogatepass")
    try:
        loaded = load(path)
    except InputError as error:
        told = a_line(error)
        assert str(path) in told
        return told
    if isinstance(loaded, Episode):
        _is_one(loaded, path)
    return loaded


def _is_one(episode: Episode, path: Path) -> None:
    for state in _states(episode):
        assert problem_of_state(state, episode.scene) is None
    for motion in _motions(episode):
        assert problem_of_motion(motion) is None
    named = {*(step.plan for step in episode.steps), *(rejection.plan for rejection in episode.rejections)}
    assert named <= set(range(len(episode.plans)))
    json.dumps(summarize(episode), allow_nan=False).encode()
    path.write_text(json.dumps(_document(content_of(episode))))  # without ``save``, which waits for the disk
    assert load(path) == episode
    assert first_difference(episode, episode) is None
    assert first_difference(episode, EPISODE) is not None or episode.steps == EPISODE.steps
    first_difference(EPISODE, episode)
    spec_of(episode, planner="ooa").key()
    list(differing_versions(episode))
    StoredAdvice(episode)
    try:
        driven = joint_trajectories(episode, ARM)
        assert as_json(episode, driven)
        assert as_csv(driven)
    except PhframeError as error:
        a_line(error)


def _states(episode: Episode) -> Iterator[State]:
    for step in episode.steps:
        yield from filter(None, (step.before, step.after, step.expected, step.seen))
    yield from (node.state for node in _nodes(episode))


def _motions(episode: Episode) -> Iterator[Motion]:
    yield from (step.motion for step in episode.steps)
    yield from (node.motion for node in _nodes(episode) if node.motion is not None)


def _nodes(episode: Episode) -> Iterator[SearchNode]:
    for plan in episode.plans:
        yield from plan.tree.nodes if plan.tree is not None else ()


@settings(max_examples=many(60), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(content=DOCUMENTS)
def test_whatever_an_episode_says_it_is_an_episode_or_one_line(path: Path, content: Any) -> None:
    tried("inputs: episodes that say something else")
    judged(json.dumps(content), path)


@settings(max_examples=many(60), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=spoilt_text(TEXT, PIECES))
def test_whatever_is_written_in_an_episode_it_is_an_episode_or_one_line(path: Path, text: str) -> None:
    tried("inputs: episodes with a word changed")
    judged(text, path)


@pytest.mark.parametrize("kept", sorted(CORPUS.glob("*.json")), ids=lambda kept: kept.stem)
def test_episodes_that_went_wrong_once_are_one_line(kept: Path, path: Path) -> None:
    change, content = json.loads(kept.read_text()), json.loads(json.dumps(CONTENT))
    *way, last = change["at"]
    functools.reduce(operator.getitem, way, content)[last] = change["put"]
    assert isinstance(judged(json.dumps(_document(content)), path), str)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="what has no end")
def test_a_file_without_end_is_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("phframe.runtime.files.MOST_BYTES", 1 << 20)
    with pytest.raises(InputError, match="/dev/zero is larger than 1 MB"):
        load("/dev/zero")


def test_no_shape_of_a_text_is_an_episode(path: Path) -> None:
    for text in ("[" * 100_000, "9" * 5000, "\ufeff" + TEXT, TEXT[:-1], TEXT + TEXT, '{"a":' * 2000, "NaN", "null", ""):
        assert isinstance(judged(text, path), str)
