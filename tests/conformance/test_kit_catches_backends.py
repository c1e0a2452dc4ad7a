"""Every check of physics backends finds a backend that breaks its promise."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.backends.pymunk_.physics import PymunkOptions, PymunkPhysics
from phframe.core import ArmModel, BasePose, Condition, InputError, Scene, State
from phframe.testing import PHYSICS_CHECKS, Check, ConformanceError, PhysicsUnderTest, check_physics
from phframe.testing.physics.many import MANY_CHECKS
from phframe.testing.physics.paths import crowd
from phframe.testing.physics.propagation import PROPAGATION_CHECKS
from phframe.testing.subjects import PhysicsFactory
from tests.conformance.broken_backends import (
    Ages,
    Altered,
    BackToFront,
    BrakesOnlyToSettle,
    Claims,
    ClosesAllTheWay,
    ClosesOnce,
    DislikesBeingWatched,
    DoesNothing,
    Drifts,
    EmptyHanded,
    EndlessStrength,
    FeelsNothing,
    ForgetsWhatItHolds,
    HeavyThingsStick,
    Jumps,
    NeverLetsGo,
    NeverOpens,
    NeverSettles,
    NeverSpills,
    NeverStops,
    NothingIsHeavy,
    NothingIsLow,
    OneBuffer,
    OnTheBoard,
    RestoresElsewhere,
    SeesElsewhere,
    ShowsNothing,
    Slippery,
    Smooths,
    SoftWalls,
    StiffFingers,
    StuckForGood,
    TakesAnything,
    ThinObjects,
    WallsWithoutEnd,
    WornByLooks,
    WritesToTrajectories,
)

ARM = PlanarArm(PlanarArmOptions())
Broken = type[PymunkPhysics]

BROKEN: dict[str, Broken] = {
    "restore_returns_what_it_holds": RestoresElsewhere,
    "poses_are_in_the_shelf_frame": OnTheBoard,
    "a_scene_is_at_rest_as_written": SeesElsewhere,
    "what_has_spilled_stays_where_it_was_seen": NeverSpills,
    "bad_states_are_refused": TakesAnything,
    "closing_twice_is_allowed": ClosesOnce,
    "runs_repeat_bit_by_bit": Ages,
    "runs_forget_what_ran_before": Ages,
    "new_backends_give_the_same_bits": Ages,
    "arguments_are_not_changed": WritesToTrajectories,
    "results_do_not_change_later": OneBuffer,
    "watching_changes_nothing": DislikesBeingWatched,
    "observing_changes_nothing": WornByLooks,
    "trajectories_are_followed": Smooths,
    "fingers_open_and_close_as_told": StiffFingers,
    "execution_goes_on_from_where_the_world_is": DoesNothing,
    "trajectories_that_begin_elsewhere_are_refused": Jumps,
    "waiting_for_rest_changes_nothing_before": BrakesOnlyToSettle,
    "what_is_placed_stays": NeverOpens,
    "a_held_target_passes_the_mouth_at_an_angle": WallsWithoutEnd,
    "what_is_too_heavy_does_not_come_out": NothingIsHeavy,
    "contacts_are_told_in_order": BackToFront,
    "a_watcher_sees_it_all": ShowsNothing,
    "stops_at_the_first_contact": NeverStops,
    "stops_at_a_force": NeverStops,
    "stops_at_a_wall": NeverStops,
    "things_come_to_rest": NeverSettles,
    "a_settled_world_stays_as_it_is": Drifts,
    "sliding_objects_stop_where_friction_says": Slippery,
    "mass_does_not_change_how_far_things_slide": HeavyThingsStick,
    "what_leaves_at_the_mouth_has_spilled": NeverSpills,
    "walls_hold_what_is_pressed_into_them": SoftWalls,
    "walls_hold_the_arm": SoftWalls,
    "nothing_passes_through_anything": ThinObjects,
    "pushes_move_what_is_in_the_way": ThinObjects,
    "the_arm_passes_over_what_is_lower": NothingIsLow,
    "a_load_too_heavy_stalls_the_arm": EndlessStrength,
    "forces_are_those_of_friction": FeelsNothing,
    "a_stalled_arm_stands_still_and_can_go_back": StuckForGood,
    "a_grasped_target_comes_out": EmptyHanded,
    "fingers_stop_at_what_they_hold": ClosesAllTheWay,
    "a_held_target_survives_restoring": ForgetsWhatItHolds,
    "fingers_that_close_on_nothing_hold_nothing": Claims,
    "open_fingers_let_go": NeverLetsGo,
}


def subject(backend: Broken) -> PhysicsUnderTest:
    return PhysicsUnderTest(lambda s, a, m: backend(s, a, m, PymunkOptions()), ARM, name=backend.__name__)


def found_by(check: Check[PhysicsUnderTest], backend: Broken) -> str:
    with pytest.raises(ConformanceError) as caught:
        check(subject(backend))
    assert caught.value.failures[0].check == check.name
    return str(caught.value)


OF_ALL = [check for check in PHYSICS_CHECKS if check not in (*PROPAGATION_CHECKS, *MANY_CHECKS)]


@pytest.mark.parametrize("check", OF_ALL, ids=lambda check: check.name)
def test_every_check_can_fail(check: Check[PhysicsUnderTest]) -> None:
    message = found_by(check, BROKEN[check.name])
    assert "no exception" not in message or BROKEN[check.name] is ClosesOnce, message


def test_the_message_says_what_was_promised_expected_and_found() -> None:
    check = next(check for check in OF_ALL if check.name == "forces_are_those_of_friction")
    message = found_by(check, FeelsNothing)
    assert check.contract.startswith("Motion.largest_force: magnitude of the sum of the contact forces on the arm")
    assert message.splitlines() == [
        "FeelsNothing with PlanarArm does not keep to its interface:",
        "- forces_are_those_of_friction",
        f"    the contract: {check.contract}",
        "    expected: at least 0.9 of the 14.7 N that friction takes",
        "    found:    0 N",
    ]


def test_all_failures_are_told_at_once() -> None:
    factory: PhysicsFactory = lambda s, a, m: NeverStops(s, a, m, PymunkOptions())  # noqa: E731
    with pytest.raises(ConformanceError) as caught:
        check_physics(factory, ARM, name="mine")
    failed = {failure.check for failure in caught.value.failures}
    assert {"stops_at_the_first_contact", "stops_at_a_force", "stops_at_a_wall"} <= failed
    assert "poses_are_in_the_shelf_frame" not in failed


def test_bad_input_is_not_hidden_by_the_altered_backend() -> None:
    stand = Altered(*_parts(), PymunkOptions())
    with pytest.raises(InputError):
        stand.restore(State(np.full((1, 7), np.nan), (Condition.UPRIGHT,)))


def _parts() -> tuple[Scene, ArmModel[Any], BasePose]:
    scene = crowd()
    return scene, ARM, ARM.default_base_pose(scene.shelf)
