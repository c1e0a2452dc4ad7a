"""What is shown of a search that failed: the path it got farthest on."""

from __future__ import annotations

from dataclasses import replace

import pytest

from phframe.core import ROOT, Motion, SearchTree, Transition
from phframe.recorders.search_path import farthest_path
from tests.recorders.synthetic_episode import hand_made


@pytest.mark.parametrize("force", [0.0, 12.0])
def test_a_push_that_met_nothing_is_a_step_like_any_other(force: float) -> None:
    step = hand_made().episode.steps[0]
    tree = SearchTree(step.before)
    motion = replace(step.motion, largest_force=force)
    end = tree.child(ROOT, step.action, Transition(step.before, motion), step.decision, closed="nothing moved")
    shown = list(farthest_path(tree.explored(end)))
    assert [(each.action, each.motion, why) for each, why in shown] == [(step.action, motion, "nothing moved")]


def test_so_is_one_of_which_nothing_is_known() -> None:
    step = hand_made().episode.steps[0]
    tree = SearchTree(step.before)
    end = tree.child(ROOT, step.action, Transition(step.before, Motion(0.0)), step.decision)
    assert len(list(farthest_path(tree.explored(end)))) == 1
