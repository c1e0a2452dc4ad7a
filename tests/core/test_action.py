"""Actions say what they are, legs may have rules of their own, and what differs by a hair is the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from phframe.core import (
    Action,
    ActionKind,
    Contacts,
    GripperPath,
    InputError,
    Phase,
    PhaseRule,
    controlled_path,
    time_path,
)

RULE = PhaseRule(0.2, 0.0, Contacts.OBJECTS)


def path(*phases: Phase, manipuland: str | None = None) -> GripperPath:
    poses = np.column_stack([0.1 * np.arange(len(phases) + 1), np.zeros((len(phases) + 1, 2))])
    return GripperPath(poses, phases, dict.fromkeys(phases, RULE), manipuland)


@pytest.mark.parametrize(
    ("kind", "phases", "manipuland"),
    [
        (ActionKind.PUSH, (Phase.REACH, Phase.GRASP), "a"),
        (ActionKind.GRASP, (Phase.INSERT, Phase.SWEEP), "a"),
        (ActionKind.GRASP, (Phase.REACH, Phase.GRASP), None),
        (ActionKind.GRASP, (Phase.GRASP, Phase.RELEASE), "a"),
        (ActionKind.PLACE, (Phase.PLACE,), "a"),
        (ActionKind.MOVE, (Phase.PLACE, Phase.RELEASE), "a"),
    ],
)
def test_an_action_that_is_not_what_it_says_is_refused(
    kind: ActionKind, phases: tuple[Phase, ...], manipuland: str | None
) -> None:
    with pytest.raises(InputError, match=r"'it' is a"):
        Action("it", path(*phases, manipuland=manipuland), (), kind)


def test_grasps_placements_and_moves_are_told_apart() -> None:
    assert Action("it", path(Phase.INSERT)).kind is ActionKind.PUSH
    assert Action("it", path(Phase.REACH, Phase.GRASP, manipuland="a"), ("a",), ActionKind.GRASP).path.manipuland == "a"
    both = path(Phase.REACH, Phase.GRASP, Phase.PLACE, Phase.RELEASE, manipuland="a")
    assert Action("pick and place", both, ("a",), ActionKind.PLACE).kind is ActionKind.PLACE
    assert Action("aside", path(Phase.APPROACH), (), ActionKind.MOVE).kind is ActionKind.MOVE


def test_less_than_a_millimetre_makes_no_other_action() -> None:
    action = Action("push", path(Phase.INSERT, Phase.SWEEP), ("a",))
    near = replace(action, path=action.path.shifted([9e-4, -9e-4, 4e-3]), name="again")
    assert action.resembles(near)
    for shift in ([1.1e-3, 0.0, 0.0], [0.0, 0.0, 6e-3]):
        assert not action.resembles(replace(action, path=action.path.shifted(shift)))
    assert not action.resembles(replace(action, moves=("b",)))
    assert not action.resembles(replace(action, path=path(Phase.INSERT, Phase.RETREAT)))


def test_two_controls_of_a_second_at_different_speeds_last_two_seconds() -> None:
    twists = np.array([[0.10, 0.0, 0.0], [0.03, 0.0, 0.0]])
    timed = time_path(controlled_path([0.0, 0.3, 0.0], twists, 1.0, Phase.SWEEP, RULE), 0.0, 60.0)
    np.testing.assert_allclose(timed.times, [0.0, 1.0, 2.0])
    np.testing.assert_allclose(timed.poses[:, 0], [0.0, 0.10, 0.13])


@pytest.mark.parametrize("twist", [[0.0, 0.0, 0.1], [0.05, -0.02, -0.1], [0.0, 0.08, 0.0]])
def test_every_twist_is_held_for_its_time_turning_included(twist: list[float]) -> None:
    timed = time_path(controlled_path(np.zeros(3), [twist, twist], 0.5, Phase.SWEEP, RULE), 0.0, 60.0)
    np.testing.assert_allclose(timed.times, [0.0, 0.5, 1.0])
    np.testing.assert_allclose(timed.poses[-1], twist)
    with pytest.raises(InputError, match="zero"):
        controlled_path(np.zeros(3), [twist, [0.0, 0.0, 0.0]], 0.5, Phase.SWEEP, RULE)


def test_a_rule_for_a_leg_that_is_not_there_is_refused() -> None:
    with pytest.raises(InputError, match="no leg 2"):
        replace(path(Phase.INSERT, Phase.SWEEP), overrides={2: RULE})
