"""GRTC with a human in the loop: it asks, refuses what cannot be, does the rest, and remembers what it was told."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from phframe.core import Episode, Hint, InputError, OptionError, Question, Scene, Status
from phframe.planners.guided import MOST_REFUSALS
from phframe.pushing import StraightPushDecision
from phframe.runtime.files import load, save
from phframe.runtime.replay import StoredAdvice, first_difference, spec_of
from phframe.runtime.run import run
from phframe.runtime.solve import solve
from tests.pushing.parts import scene_of

ONE_IN_THE_WAY = scene_of((0.4, 0.3), (0.2, 0.3), (0.3, 0.5))
TWO_IN_THE_WAY = scene_of((0.45, 0.3), (0.2, 0.3), (0.3, 0.3))
ASIDE = Hint("o0", (0.2, 0.5))


class Script:
    """Answers in order, and keeps what it was asked.

    Args:
        answers: The hints.
    """

    def __init__(self, *answers: Hint) -> None:
        self._answers = iter(answers)
        self.questions: list[Question] = []

    def advise(self, question: Question) -> Hint | None:
        self.questions.append(question)
        return next(self._answers, None)


def guided(scene: str | Scene, *answers: Hint, **options: Any) -> tuple[Episode, Script]:
    script = Script(*answers)
    return solve(scene, planner="guided", options={"planner": options}, advisor=script), script


def hints(*given: tuple[str, float, float]) -> list[dict[str, Any]]:
    return [{"object": name, "to": [x, y]} for name, x, y in given]


def pushed(episode: Episode) -> list[Hint | None]:
    return [step.decision.hint for step in episode.steps if isinstance(step.decision, StraightPushDecision)]


def test_what_it_is_told_is_done_and_the_target_is_grasped() -> None:
    episode, script = guided(ONE_IN_THE_WAY, ASIDE)
    assert (episode.status, episode.pushes, episode.clean) == (Status.RETRIEVED, 1, True)
    assert pushed(episode) == [ASIDE]
    assert np.linalg.norm(episode.steps[0].after.positions[1] - ASIDE.to) <= 0.05
    [question] = script.questions
    assert (question.blocker, question.refusal) == ("o0", "")
    assert np.allclose(question.corridor, [[0, 0.18], [0.4, 0.18], [0.4, 0.42], [0, 0.42]])


def test_nobody_is_asked_where_nothing_is_in_the_way() -> None:
    episode, script = guided(scene_of((0.4, 0.3), (0.3, 0.5)))
    assert episode.status is Status.RETRIEVED
    assert script.questions == []


def test_it_asks_about_one_thing_after_another() -> None:
    episode, script = guided(TWO_IN_THE_WAY, Hint("o0", (0.2, 0.5)), Hint("o1", (0.3, 0.1)))
    assert [question.blocker for question in script.questions] == ["o0", "o1"]
    assert (script.questions[1].state.positions[1] != script.questions[0].state.positions[1]).any()
    assert (episode.status, episode.pushes) == (Status.RETRIEVED, 2)


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (Hint("0", (0.2, 0.5)), "no object named '0'. Did you mean 'o0'? There is: o0, o1, target."),
        (Hint("target", (0.2, 0.5)), "target is the target"),
        (Hint("o0", (0.2, 0.59)), "(0.2, 0.59) is not inside the shelf for o0"),
        (Hint("o0", (-0.2, 0.5)), "x from 0.03 to 0.57"),
        (Hint("o0", (0.3, 0.48)), "(0.3, 0.48) is too near to o1"),
        (Hint("o0", (0.4, 0.3)), "too near to target"),
        (Hint("o0", (0.21, 0.31)), "o0 is at (0.21, 0.31) already"),
        (Hint("o0", (0.1, 0.3)), "the arm cannot get behind it"),
        (Hint("o0", (0.45, 0.45)), "push o0 to (0.45, 0.45): o0 ended"),
    ],
)
def test_answers_that_cannot_be_used_are_asked_again_with_the_reason(answer: Hint, why: str) -> None:
    episode, script = guided(ONE_IN_THE_WAY, answer, ASIDE)
    assert [question.refusal == "" for question in script.questions] == [True, False]
    assert why in script.questions[1].refusal
    assert (episode.status, pushed(episode)) == (Status.RETRIEVED, [ASIDE])


def test_without_an_answer_it_fails_and_says_what_to_do() -> None:
    episode, _ = guided(TWO_IN_THE_WAY, ASIDE)
    assert (episode.status, episode.steps) == (Status.FAILED, ())
    assert "o1, which blocks the drive" in episode.reason
    assert "--option hints=FILE" in episode.reason
    assert [hint for hint in map(_hint, episode.plans[0].decisions) if hint] == [ASIDE]
    alone = solve(ONE_IN_THE_WAY, planner="guided")
    assert alone.status is Status.FAILED
    assert "--option hints=FILE" in alone.reason


def test_somebody_who_never_makes_sense_is_not_asked_for_ever() -> None:
    episode, script = guided(ONE_IN_THE_WAY, *([Hint("o9", (0.1, 0.1))] * (MOST_REFUSALS + 5)))
    assert episode.status is Status.FAILED
    assert f"{MOST_REFUSALS} answers in a row" in episode.reason
    assert len(script.questions) == MOST_REFUSALS


@pytest.mark.parametrize("stored", [False, True])
def test_an_episode_that_was_guided_is_repeated_bit_by_bit_with_what_was_answered(
    tmp_path: Path, *, stored: bool
) -> None:
    answers = (Hint("o9", (0.1, 0.1)), Hint("o0", (0.5, 0.5)), Hint("o0", (0.2, 0.5)), Hint("o1", (0.3, 0.1)))
    episode, _ = guided(TWO_IN_THE_WAY, *answers)
    assert episode.status is Status.RETRIEVED
    before = load(save(episode, tmp_path / "episode.json")) if stored else episode
    assert isinstance(before, Episode)
    after = run(spec_of(before), advisor=StoredAdvice(before))
    assert first_difference(before, after) is None
    assert first_difference(before, run(spec_of(before))) is not None


def test_hints_of_the_options_are_done_in_order_and_kept_as_values() -> None:
    given = hints(("o0", 0.2, 0.5), ("o1", 0.3, 0.1))
    episode = solve(TWO_IN_THE_WAY, planner="guided", options={"planner": {"hints": given}})
    assert (episode.status, episode.pushes) == (Status.RETRIEVED, 2)
    assert episode.spec.options["planner"]["hints"] == given
    assert first_difference(episode, run(spec_of(episode))) is None


def test_a_file_of_hints_is_read_once_and_needed_no_more(tmp_path: Path) -> None:
    file = tmp_path / "hints.yaml"
    file.write_text("- {object: o0, to: [0.2, 0.5]}\n")
    episode = solve(ONE_IN_THE_WAY, planner="guided", options={"planner": {"hints": str(file)}})
    assert episode.status is Status.RETRIEVED
    file.unlink()
    assert first_difference(episode, run(spec_of(episode))) is None


@pytest.mark.parametrize(
    ("at", "next_one"),
    [
        ((0.3, 0.3), ("o0", (0.2, 0.5))),  # nothing is done
        ((0.2, 0.5), ("o0", (0.4, 0.5))),  # the first hint is
        ((0.4, 0.5), ("o1", (0.3, 0.1))),  # the second is, and so the first was
    ],
)
def test_hints_that_are_done_are_passed_over(
    at: tuple[float, float], next_one: tuple[str, tuple[float, float]]
) -> None:
    given = hints(("o0", 0.2, 0.5), ("o0", 0.4, 0.5), ("o1", 0.3, 0.1))
    scene = scene_of((0.5, 0.3), at, (0.2, 0.3))
    episode = solve(scene, planner="guided", options={"planner": {"hints": given}})
    tree = episode.plans[0].tree
    assert tree is not None
    assert tree.nodes[1].decision is not None
    assert tree.nodes[1].decision.hint == Hint(*next_one)


def test_hints_that_leave_something_in_the_way_are_told() -> None:
    done = solve(TWO_IN_THE_WAY, planner="guided", options={"planner": {"hints": hints(("o0", 0.2, 0.5))}})
    assert done.status is Status.FAILED
    assert done.reason == "the straight drive still meets o1, and all 1 hints are done"
    taken = solve(ONE_IN_THE_WAY, planner="guided", options={"planner": {"hints": hints(("o0", 0.3, 0.48))}})
    assert taken.reason == "hint 1: (0.3, 0.48) is too near to o1"


def test_hints_that_can_never_be_done_are_an_error_of_theirs(tmp_path: Path) -> None:
    file = tmp_path / "hints.yaml"
    file.write_text("- {object: o0, to: [0.2, 0.5]}\n\n- {object: o7, to: [0.2, 0.5]}\n")
    with pytest.raises(InputError, match=r"hints\.yaml: line 3: no object named 'o7'.* There is: o0, o1, target"):
        solve(ONE_IN_THE_WAY, planner="guided", options={"planner": {"hints": file}})
    with pytest.raises(InputError, match=r"hint 1: .* is not inside the shelf for o0"):
        solve(ONE_IN_THE_WAY, planner="guided", options={"planner": {"hints": hints(("o0", 0.2, 0.9))}})
    with pytest.raises(OptionError, match="hints"):
        solve(ONE_IN_THE_WAY, planner="guided", options={"planner": {"hints": [{"object": "o0"}]}})
    with pytest.raises(OptionError, match="hints"):
        solve(ONE_IN_THE_WAY, planner="guided", options={"planner": {"hints": 3}})


@pytest.mark.parametrize("name", ["vieira/basic", "vieira/simple-04", "vieira/example-02", "random/0", "random/3"])
def test_what_grtc_found_is_done_again_by_a_file_of_hints(tmp_path: Path, name: str) -> None:
    found = solve(name, planner="grtc-straight")
    assert found.pushes > 0
    decisions = [each for each in found.plans[0].decisions if isinstance(each, StraightPushDecision)]
    lines = [f"- object: {each.chosen[0]}\n  to: {list(each.place or ())}\n" for each in decisions]
    file = tmp_path / "hints.yaml"
    file.write_text("".join(lines))
    episode = solve(name, planner="guided", options={"planner": {"hints": str(file)}})
    assert (episode.status, episode.reason) == (Status.RETRIEVED, "")
    assert [step.action for step in episode.steps] == [step.action for step in found.steps]


def _hint(decision: Any) -> Hint | None:
    return decision.hint  # type: ignore[no-any-return]
