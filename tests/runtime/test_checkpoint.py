"""The file of an episode that grows: at every moment one that can be read, and in the end the one that ``save`` writes."""

from __future__ import annotations

from pathlib import Path

import pytest

from phframe.cli import watchdog
from phframe.core import Episode, InputError, Loop, RunSpec, Status
from phframe.planners.phia import PHIA, PHIAOptions
from phframe.runtime import episode as closed_loop
from phframe.runtime.checkpoint import EpisodeFile
from phframe.runtime.episode import UNFINISHED
from phframe.runtime.files import load, save
from phframe.runtime.observer import Observer
from phframe.runtime.run import run
from tests.faults.hostile import ManyActions

SCENE = "vieira/basic"


class Growing(Observer):
    """Writes the file whenever there is more, and reads it back."""

    def __init__(self, path: Path) -> None:
        self.file, self.read, self.given = EpisodeFile(path), list[object](), list[Episode]()

    def progressed(self, episode: Episode) -> None:
        self.file.keep(episode)
        self.given.append(episode)
        self.read.append(load(self.file.path))


def test_what_is_kept_is_what_there_is_and_in_the_end_what_save_writes(tmp_path: Path) -> None:
    growing = Growing(tmp_path / "growing.json")
    episode = run(RunSpec(SCENE), [growing])
    assert growing.read == growing.given
    sizes = [(len(each.plans), len(each.steps)) for each in growing.given]
    assert sizes == [(0, 0), *((1, steps) for steps in range(len(episode.steps) + 1))]
    assert {(each.status, each.reason) for each in growing.given} == {(Status.FAILED, UNFINISHED)}
    assert UNFINISHED.startswith(watchdog.UNFINISHED)
    growing.file.save(episode)
    assert growing.file.path.read_bytes() == save(episode, tmp_path / "whole.json").read_bytes()
    assert growing.file.path.stat().st_mode == (tmp_path / "whole.json").stat().st_mode
    assert {path.name for path in tmp_path.iterdir()} == {"growing.json", "whole.json"}


def test_an_episode_of_an_object_is_not_kept(tmp_path: Path) -> None:
    class Unregistered(PHIA):
        pass

    episode = run(RunSpec("vieira/simple-07", planner=Unregistered(PHIAOptions())))
    with pytest.raises(InputError, match="the planner is an object, Unregistered"):
        EpisodeFile(tmp_path / "x.json").keep(episode)
    assert not list(tmp_path.iterdir())


def test_carrying_out_is_limited(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(closed_loop, "LEAST_TO_ACT", 1e-9)
    episode = run(RunSpec("vieira/simple-07", planner=ManyActions, loop=Loop(time_limit=1e-6)))
    assert (episode.status, len(episode.plans), len(episode.steps)) == (Status.TIMEOUT, 1, 1)
    assert episode.reason == "carrying out took longer than 1e-06 s"
