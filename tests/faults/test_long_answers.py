"""Answers without end: a plan that is more than anybody carries out is refused in a line, or ends as a timeout."""

from __future__ import annotations

from pathlib import Path

import pytest

import phframe
from phframe.core import Episode, PhframeError, Planner, Status
from phframe.runtime.files import load
from phframe.runtime.observer import Observer
from tests.cli.conftest import Spawn, spawn, workplace
from tests.faults import hostile
from tests.trials import TIMES, tried

__all__ = ["spawn", "workplace"]  # fixtures
SCENES = ("vieira/simple-07", "papallas/s01", "vieira/basic", "random/0")
REFUSED: dict[type[Planner], str] = {
    hostile.ManyActions: "it has 3000 actions; at most 1000 are carried out",
    hostile.LongPath: "a gripper path needs at least one leg, and at most 10000, not 1000000",
    hostile.ForcedLongPath: "a path in its tree has 999999 legs; at most 10000 are taken",
    hostile.ManyPaths: "the paths in its tree have 1005000 legs; at most 1000000 are taken",
    hostile.LargeTree: "its tree has 100001 nodes; at most 100000 are taken",
}


class Kept(Observer):
    """Keeps what there was of an episode that ended early."""

    episode: Episode | None = None

    def interrupted(self, episode: Episode) -> None:
        self.episode = episode


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES[:TIMES])
@pytest.mark.parametrize("planner", REFUSED)
def test_what_is_too_much_is_refused_in_a_line(planner: type[Planner], scene: str) -> None:
    tried("inputs: plans that are too long")
    kept = Kept()
    with pytest.raises(PhframeError) as caught:
        phframe.solve(scene, planner=planner, observers=[kept])
    assert f"planner {planner.__name__!r}" in str(caught.value)
    assert REFUSED[planner] in str(caught.value)
    assert "\n" not in str(caught.value)
    assert kept.episode is not None
    assert (kept.episode.status, kept.episode.steps) == (Status.FAILED, ())


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES[:TIMES])
def test_an_action_that_takes_too_long_is_not_begun(scene: str) -> None:
    tried("inputs: plans that are too long")
    episode = phframe.solve(scene, planner=hostile.LongAction)
    assert (episode.status, episode.steps) == (Status.FAILED, ())
    assert "it takes 4" in episode.reason
    assert "an action may take 1000 s" in episode.reason


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES[:TIMES])
def test_actions_end_with_the_time(scene: str, monkeypatch: pytest.MonkeyPatch) -> None:
    tried("inputs: plans that are too long")
    monkeypatch.setattr("phframe.runtime.episode.LEAST_TO_ACT", 0.3)
    episode = phframe.solve(scene, planner=hostile.AllThatMayBe, time_limit=0.3)
    assert (episode.status, episode.reason) == (Status.TIMEOUT, "carrying out took longer than 0.3 s")
    assert 0 < len(episode.steps) < hostile.AllThatMayBe.number


@pytest.mark.slow
@pytest.mark.parametrize("scene", SCENES[:TIMES])
@pytest.mark.parametrize("planner", [hostile.ManyActions, hostile.ForcedLongPath])
def test_so_it_is_by_the_command_within_its_memory(planner: type[Planner], scene: str, spawn: Spawn) -> None:
    tried("processes: a plan that is too long")
    given = ("--planner", f"{hostile.__file__}:{planner.__name__}", "--memory-limit", 800, "--out", "out")
    process = spawn("solve", scene, "--no-rerun", *given)
    out, err = process.communicate(timeout=240)
    assert (process.returncode, out) == (2, "")
    assert err.count("\n") == 1
    assert REFUSED[planner] in err
    assert "what was done until then is in out" in err
    episode = load(Path("out", "episode.json"))
    assert isinstance(episode, Episode)
    assert (episode.status, episode.steps) == (Status.FAILED, ())
