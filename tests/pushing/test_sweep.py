"""A sweep as an action in the shelf frame."""

from __future__ import annotations

import numpy as np
from hypothesis import given

from phframe.core import ActionKind, Contacts, Phase
from phframe.pushing.options import PushingOptions
from phframe.pushing.sweep import push_action
from tests.pushing.parts import often
from tests.pushing.sweep_cases import Case, cases

OPTIONS = PushingOptions(insert_speed=0.3, sweep_speed=0.1)


@often
@given(cases())
def test_in_across_and_out_at_one_yaw(case: Case) -> None:
    corridor = case.corridor
    for push in case.pushes:
        action = push_action(corridor, push.sweep, ("a", "b"), 0.004, OPTIONS)
        assert action.path.phases == (Phase.INSERT, Phase.SWEEP, Phase.RETREAT)
        np.testing.assert_allclose(corridor.to_local(action.path.poses[:, :2]), push.sweep.waypoints, atol=1e-12)
        assert set(action.path.poses[:, 2]) == {corridor.angle + push.sweep.tilt}
        towards = "north" if push.sweep.direction == 1 else "south"
        assert (action.name, action.moves, action.kind) == (f"sweep {towards}: a, b", ("a", "b"), ActionKind.PUSH)
        speeds = {phase: rule.speed for phase, rule in action.path.rules.items()}
        assert speeds == {Phase.INSERT: 0.3, Phase.SWEEP: 0.1, Phase.RETREAT: 0.3}
        for rule in action.path.rules.values():
            assert (rule.opening, rule.contacts) == (0.004, Contacts.OBJECTS)


@often
@given(cases())
def test_towards_the_north_the_fingertip_goes_north(case: Case) -> None:
    for push in case.pushes:
        action = push_action(case.corridor, push.sweep, (), 0.0, OPTIONS)
        inserted, swept = action.path.poses[1], action.path.poses[2]
        assert np.sign(swept[1] - inserted[1]) == (1 if "north" in action.name else -1)
