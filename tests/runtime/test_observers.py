"""Observers are told everything, in order, and closed whatever happens."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phframe.core import Episode, InputError, PhframeError, Status
from phframe.planners.phia import PHIA
from phframe.runtime.audience import ObserverError
from phframe.runtime.observer import Frames, Observer
from phframe.runtime.solve import solve
from phframe.runtime.world import WorldSpec
from tests.runtime.worlds import BASIC, Clumsy, Meddling, run, shifted

SPEC = WorldSpec(BASIC)


class Diary(Observer):
    """Writes down what it is told."""

    def __init__(self, raise_at: str = "", error: type[BaseException] = KeyboardInterrupt) -> None:
        self.told: list[tuple[str, tuple[Any, ...]]] = []
        self._raise_at, self._error = raise_at, error

    @property
    def words(self) -> list[str]:
        return [word for word, _ in self.told]

    def _note(self, word: str, *what: Any) -> None:
        self.told.append((word, what))
        if word == self._raise_at:
            raise self._error(word)

    def begin(self, scene: Any, setup: Any, arm: Any) -> None:
        self._note("begin", scene, setup, arm)

    def planned(self, plan: Any) -> None:
        self._note("planned", plan)

    def stepped(self, step: Any, frames: Frames) -> None:
        self._note("stepped", step, frames)

    def finished(self, episode: Episode) -> None:
        self._note("finished", episode)

    def close(self) -> None:
        self._note("close")


def test_everything_is_told_in_order_and_is_what_the_episode_holds() -> None:
    diary = Diary()
    episode = solve(BASIC, observers=[diary])
    assert diary.words == ["begin", "planned", *["stepped"] * len(episode.steps), "finished", "close"]
    what = dict(diary.told)
    assert what["begin"][:2] == (episode.scene, episode.spec)
    assert what["planned"][0] is episode.plans[0]
    assert [told[0] for word, told in diary.told if word == "stepped"] == list(episode.steps)
    assert what["finished"][0] is episode


def test_replans_are_told_between_the_steps() -> None:
    diary, name = Diary(), next(n for n in BASIC.ids if n not in (*solve(BASIC).steps[0].action.moves, BASIC.target))
    episode = run(Meddling(SPEC, {1: shifted(name, (0.0, 0.02))}), observers=[diary])
    assert episode.replans == 1
    assert diary.words[:4] == ["begin", "planned", "stepped", "planned"]
    assert diary.words[-1] == "finished", "who made them closes them"


def test_a_refused_action_is_not_a_step() -> None:
    diary = Diary()
    run(Clumsy(SPEC, lambda action: True), observers=[diary])
    assert "stepped" not in diary.words
    assert diary.words[-1] == "finished"


def test_observers_change_nothing() -> None:
    class Nosy(Diary):
        def stepped(self, step: Any, frames: Frames) -> None:
            for _ in frames:
                pass

    assert solve(BASIC, observers=[Nosy(), Diary()]) == solve(BASIC)


@pytest.mark.parametrize("when", ["begin", "planned", "stepped", "finished"])
def test_all_are_closed_when_one_is_interrupted(when: str) -> None:
    one, other = Diary(when), Diary()
    with pytest.raises(KeyboardInterrupt):
        solve(BASIC, observers=[one, other])
    assert one.words[-2:] == [when, "close"]
    assert other.words[-1] == "close"
    assert (one.words.count("close"), other.words.count("close")) == (1, 1)


@pytest.mark.parametrize("when", ["begin", "planned", "stepped", "finished", "close"])
@pytest.mark.parametrize("error", [RuntimeError, OSError, SystemExit])
def test_one_that_fails_costs_neither_the_episode_nor_the_others(when: str, error: type[BaseException]) -> None:
    broken, other, undisturbed = Diary(when, error), Diary(), Diary()
    expected = solve(BASIC, observers=[undisturbed])
    with pytest.raises(ObserverError, match=f"Diary failed: {error.__name__}: {when}") as failed:
        solve(BASIC, observers=[broken, other])
    assert failed.value.episode == expected
    assert other.words == undisturbed.words
    assert broken.words.count(when) == 1
    assert broken.words[-1] == "close"


def test_one_that_cannot_begin_says_so_before_anything_is_done() -> None:
    broken, other = Diary("begin", InputError), Diary()
    with pytest.raises(InputError, match="begin"):
        solve(BASIC, observers=[other, broken])
    assert other.words == ["begin", "close"]


@pytest.mark.parametrize(
    "wrong", [{"planner": "nope"}, {"backend": "nope"}, {"options": {"arm": {"nope": 1}}}, {"topology": "nope"}]
)
def test_all_are_closed_when_nothing_could_begin(wrong: dict[str, Any]) -> None:
    diary = Diary()
    with pytest.raises(PhframeError):
        solve(BASIC, observers=[diary], **wrong)
    assert diary.words == ["close"]


@pytest.mark.parametrize("wrong", [{"scene": "vieira/nope"}, {"options": {"nope": {}}}])
def test_all_are_closed_when_there_is_no_scene(wrong: dict[str, Any]) -> None:
    diary = Diary()
    with pytest.raises(PhframeError):
        solve(**{"scene": BASIC, **wrong}, observers=[diary])
    assert diary.words == ["close"]


def test_the_frames_of_a_step_can_be_looked_at_again_and_end_where_the_action_ends() -> None:
    diary = Diary()
    episode = solve(BASIC, observers=[diary])
    told = [what for word, what in diary.told if word == "stepped"]
    step, frames = told[0]
    first, second = list(frames), list(frames)
    assert first == second
    assert first[-1] == (pytest.approx(step.motion.duration), step.after)
    times = np.array([time for time, _ in first])
    assert times[0] == 0.0
    assert len(times) == pytest.approx(30 * times[-1], abs=2)
    assert step in episode.steps


def test_the_default_observer_does_nothing() -> None:
    assert solve(BASIC, observers=[Observer()]).status is Status.RETRIEVED


def test_an_interrupt_while_planning_closes_them_too(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: Any) -> Any:
        raise KeyboardInterrupt

    monkeypatch.setattr(PHIA, "search", interrupted)
    diary = Diary()
    with pytest.raises(KeyboardInterrupt):
        solve(BASIC, observers=[diary])
    assert diary.words == ["begin", "close"]
