"""Values: equal by content, hashable, immutable, and the same after a walk through JSON or pickle."""

from __future__ import annotations

import json
import pickle
from dataclasses import FrozenInstanceError, replace

import numpy as np
import pytest
from pydantic import TypeAdapter

from phframe.core import (
    Action,
    ActionKind,
    ArmState,
    BasePose,
    Condition,
    Contact,
    Contacts,
    Cost,
    Cylinder,
    Decision,
    Episode,
    GripperPath,
    GripperTrajectory,
    InputError,
    JointTrajectory,
    Motion,
    PersistenceDiagram,
    Phase,
    PhaseRule,
    Plan,
    Rejection,
    RunSpec,
    Scene,
    SceneObject,
    Shelf,
    State,
    Status,
    Step,
    StopCause,
    StopReason,
    Transition,
    Unreachable,
    time_path,
)
from phframe.pushing import Corridor, PushDecision, Rectangle, Sweep


def scene() -> Scene:
    objects = (SceneObject("a", Cylinder(0.03), (0.2, 0.3), yaw=0.4), SceneObject("t", Cylinder(0.03, 0.1), (0.4, 0.3)))
    return Scene("two", Shelf(0.6, 0.6), objects, "t", {"planar": BasePose(-0.1, 0.3, 0.06, 0.0)})


def state(arm: ArmState | None = None, held: str | None = None) -> State:
    return State(scene().initial_state().poses, (Condition.UPRIGHT, Condition.TOPPLED), held, arm)


ARM = ArmState(np.array([0.1, 0.2, 0.3]), 0.05, command=0.0, joints=np.array([0.1, 1.0 / 3.0]))


def path() -> GripperPath:
    rules = {
        Phase.INSERT: PhaseRule(0.25, 0.0, Contacts.OBJECTS),
        Phase.GRASP: PhaseRule(0.1, 0.0, Contacts.MANIPULAND),
    }
    poses = np.array([[-0.1, 0.3, 0.0], [0.3, 0.3, 0.1], [0.3, 0.3, 0.1]])
    return GripperPath(poses, (Phase.INSERT, Phase.GRASP), rules, "t", {0: PhaseRule(0.1, 0.0, Contacts.NONE)})


def decision() -> Decision:
    return PushDecision(
        "the closest",
        corridor=Corridor(np.array([0.0, 0.6]), -0.7, -0.12, 0.12, 0.0, 0.45, "south"),
        members=("a",),
        diagram=PersistenceDiagram(np.zeros(2), np.array([0.1, np.inf])),
        persistent_radii=(0.1,),
        radius=0.1,
        labels=np.array([0, 1]),
        chosen=("a",),
        rectangle=Rectangle(np.array([0.1, 0.1]), np.array([0.2, 0.3])),
        sweep=Sweep(-1, depth=0.2, lane=0.1, end=0.3, entry=0.25, exit=0.3, tilt=0.1),
        deviations=("fallback radius",),
    )


def plan() -> Plan:
    steps = [(grasp(), state(), decision()), (grasp(), state(ARM, "t"), Decision("because"))]
    return replace(Plan.of(Status.CLEARED, "no way", state(), steps), cost=Cost(1.5))


def grasp() -> Action:
    return Action("grasp t", path(), ("t",), ActionKind.GRASP)


def motion() -> Motion:
    contact = Contact(0.5, "a", Phase.INSERT, "link")
    return Motion(
        1.0,
        (contact,),
        (replace(contact, body="south wall"),),
        7.0,
        True,
        StopReason(StopCause.CONTACT, "a"),
        0.001,
        False,
        0.9,
    )


def joint_trajectory() -> JointTrajectory:
    gripper = time_path(path(), 0.0, 60.0)
    return JointTrajectory(gripper, np.ones((3, 2)) / 3.0, np.zeros((3, 2)))


def episode() -> Episode:
    trajectories: list[GripperTrajectory | JointTrajectory] = [time_path(path(), 0.0, 60.0), joint_trajectory()]
    steps = tuple(
        Step(plan().actions[0], trajectory, state(), state(ARM, "t"), expected, motion(), decision(), 0)
        for trajectory, expected in zip(trajectories, (state(), None), strict=True)
    )
    spec = RunSpec(seed=3, options={"planner": {"margin": 0.02}})
    return Episode(
        scene(), spec, Status.FAILED, "it fell", (plan(),), steps, (Rejection(grasp(), "no", Unreachable(0.1, "no")),)
    )


VALUES = [
    state(),
    state(ARM, "t"),
    path(),
    joint_trajectory(),
    decision(),
    plan(),
    Transition(state(ARM), motion()),
    scene(),
    episode(),
]
each_value = pytest.mark.parametrize("value", VALUES, ids=lambda value: type(value).__name__)


@each_value
def test_json_gives_the_same_value_back(value: object) -> None:
    adapter = TypeAdapter(type(value))
    text = adapter.dump_json(value)
    assert adapter.validate_json(text) == value
    assert "NaN" not in str(json.loads(text, parse_constant=lambda name: pytest.fail(f"{name} is no JSON")))
    assert adapter.dump_json(adapter.validate_json(text)) == text


@each_value
def test_pickle_gives_the_same_value_back(value: object) -> None:
    copy = pickle.loads(pickle.dumps(value))
    assert copy == value
    assert copy is not value


@each_value
def test_equal_values_have_equal_hashes(value: object) -> None:
    copy = pickle.loads(pickle.dumps(value))
    assert hash(copy) == hash(value)
    assert len({copy, value}) == 1


def test_arrays_read_from_json_and_pickle_are_read_only() -> None:
    adapter = TypeAdapter(State)
    for copy in (adapter.validate_json(adapter.dump_json(state())), pickle.loads(pickle.dumps(state())), state()):
        with pytest.raises(ValueError, match="read-only"):
            copy.poses[0, 0] = 1.0


def test_a_value_does_not_follow_the_array_it_was_made_of() -> None:
    poses = scene().initial_state().poses.copy()
    made = State(poses, (Condition.UPRIGHT,) * 2)
    poses[0, 0] = 9.0
    assert made.poses[0, 0] == 0.2


def test_values_are_frozen() -> None:
    with pytest.raises(FrozenInstanceError):
        state().held = "a"  # type: ignore[misc]


@pytest.mark.parametrize(
    "other",
    [
        replace(state(), poses=state().poses + np.array([1e-16, 0, 0, 0, 0, 0, 0])[None] * 256),
        replace(state(), conditions=(Condition.UPRIGHT, Condition.SPILLED)),
        replace(state(), arm=ArmState(np.zeros(3), 0.0)),
    ],
    ids=["a bit of a pose", "a condition", "the arm"],
)
def test_any_difference_makes_values_unequal(other: State) -> None:
    assert other != state()
    assert state() != other


def test_values_of_other_types_are_not_equal() -> None:
    assert state() != "a state"
    assert Rectangle(np.zeros(2), np.ones(2)) != PersistenceDiagram(np.zeros(2), np.ones(2))


def test_minus_zero_is_another_number() -> None:
    assert Rectangle(np.zeros(2), np.ones(2)) != Rectangle(-np.zeros(2), np.ones(2))


def test_cost_does_not_count_when_plans_are_compared() -> None:
    assert replace(plan(), cost=Cost(99.0)) == plan()
    assert hash(replace(plan(), cost=Cost(99.0))) == hash(plan())
    assert replace(plan(), reason="another") != plan()


def test_versions_do_not_count_when_setups_are_compared() -> None:
    whole = episode()
    assert replace(whole, versions={"phframe": "0.0"}) == whole
    assert replace(whole.spec, workers=4) == whole.spec
    assert replace(whole.spec, seed=4) != whole.spec


def test_states_must_agree_with_themselves() -> None:
    with pytest.raises(InputError, match=r"2 objects need poses of shape \(2, 7\), not \(1, 7\)"):
        State(np.zeros((1, 7)), (Condition.UPRIGHT,) * 2)
    with pytest.raises(InputError, match="'t' cannot be held by a parked arm"):
        State(np.zeros((1, 7)), (Condition.UPRIGHT,), held="t")


def test_an_arm_that_holds_something_cannot_be_parked() -> None:
    assert state(ARM).parked() == state()
    with pytest.raises(InputError):
        state(ARM, "t").parked()


def test_displacement_is_infinite_where_the_condition_changed() -> None:
    moved = replace(state(), poses=state().poses + np.array([0.03, 0.04, 0, 0, 0, 0, 0]))
    np.testing.assert_allclose(moved.displacement(state()), [0.05, 0.05])
    spilled = replace(moved, conditions=(Condition.UPRIGHT, Condition.SPILLED))
    np.testing.assert_allclose(spilled.displacement(state()), [0.05, np.inf])


def test_an_episode_sums_up_its_plans_and_steps() -> None:
    found = episode()
    assert (found.pushes, found.replans, found.cost.total, found.execution_time) == (0, 0, 1.5, 2.0)
    assert found.toppled == ("t",)
    assert found.spilled == ()
    assert found.wall_contact
    assert not found.clean
    assert found.deviations == {"fallback radius": 2}
    assert found.final_state == state(ARM, "t")
    assert replace(found, steps=()).final_state == scene().initial_state()


def test_motions_one_after_the_other() -> None:
    first = Motion(2.0, (Contact(1.0, "a", Phase.INSERT, "link"),), largest_force=3.0, followed=1.5, settled=False)
    later = Motion(
        1.0,
        (Contact(0.5, "a", Phase.INSERT, "link"), Contact(0.7, "b", Phase.SWEEP, "link")),
        largest_force=2.0,
        stopped=StopReason(StopCause.CONTACT, "b"),
        followed=0.7,
    )
    both = first.then(later)
    assert (both.duration, both.largest_force, both.followed, both.settled) == (3.0, 3.0, 1.5, True)
    assert both.contacts == (first.contacts[0], Contact(2.7, "b", Phase.SWEEP, "link"))
    assert str(both.stopped) == "contact with b"
    assert not both.complete
    assert first.complete
