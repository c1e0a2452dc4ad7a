"""An episode written by hand: two plans, a sweep, a sweep that topples something, and the grasp."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import (
    ROOT,
    Action,
    ActionKind,
    ArmState,
    Condition,
    Contact,
    Contacts,
    Cost,
    Cylinder,
    Episode,
    FloatArray,
    GripperPath,
    Motion,
    PersistenceDiagram,
    Phase,
    PhaseRule,
    Plan,
    RunSpec,
    Scene,
    SceneObject,
    SearchTree,
    Shelf,
    State,
    Status,
    Step,
    Transition,
    planar_pose,
    time_path,
)
from phframe.pushing import Corridor, PushDecision, Rectangle
from phframe.runtime.observer import MountedArm

PERIOD = 1.0 / 30.0
PLACES = {
    "object_1": (0.12, 0.28),
    "object_2": (0.19, 0.31),
    "object_3": (0.33, 0.25),
    "object_4": (0.30, 0.50),
    "mug": (0.42, 0.30),
}
SCENE = Scene(
    "hand/made", Shelf(0.55, 0.61), tuple(SceneObject(i, Cylinder(0.03), at) for i, at in PLACES.items()), target="mug"
)
SPEC = RunSpec(seed=7, options={"planner": {"margin": 0.015}})
CORRIDOR = Corridor(np.zeros(2), 0.0, 0.30, 0.12, -0.05, 0.42)
RULES = {phase: PhaseRule(0.25, 0.0, Contacts.OBJECTS) for phase in Phase}


@dataclass(frozen=True)
class Recorded:
    """An episode, the arm that did it, and the frames of each of its steps."""

    episode: Episode
    arm: MountedArm
    frames: tuple[tuple[tuple[float, State], ...], ...]


def hand_made() -> Recorded:
    """The episode."""
    start = SCENE.initial_state()
    first = _moved(start, {"object_1": (0.12, 0.46), "object_2": (0.19, 0.45)}, arm=(-0.05, 0.4, 0.0))
    second = _moved(first, {"object_3": (0.33, 0.10)}, arm=(-0.05, 0.2, 0.0), toppled="object_3")
    third = _moved(second, {"mug": (-0.10, 0.30)}, arm=(-0.12, 0.3, 0.0), held="mug")
    steps = (
        _sweep("sweep north: object_1, object_2", start, first, _first_decision()),
        _sweep("sweep south: object_3", first, second, _second_decision()),
        _grasp(second, third),
    )
    plans = (
        _plan(start, steps[:1], Cost(0.03, 0.002, 0.02, 0.0, 4)),
        _plan(first, steps[1:], Cost(0.01)),
    )
    episode = Episode(SCENE, SPEC, Status.RETRIEVED, "", plans, steps)
    return Recorded(episode, mounted(), tuple(tuple(_frames(step)) for step in steps))


def _plan(start: State, steps: tuple[Step, ...], cost: Cost) -> Plan:
    expected = [(s.action, s.expected, s.decision) for s in steps if s.expected is not None]
    return replace(Plan.of(Status.RETRIEVED, "", start, expected), cost=cost)


def failed_plan() -> Plan:
    """Of four pushes: two in a row, then nothing more that moves anything, and one that was not gone on from."""
    steps = hand_made().episode.steps
    tree = SearchTree(steps[0].before)
    ends = [Transition(step.after, step.motion) for step in steps]
    first = tree.child(ROOT, steps[0].action, ends[0], steps[0].decision, value=-1.0)
    tree.child(ROOT, steps[1].action, ends[1], steps[1].decision, closed="something spilled")
    second = tree.child(first, steps[1].action, ends[1], steps[1].decision)
    tree.child(second, steps[0].action, replace(ends[1], state=steps[1].after), closed="nothing moved")
    return tree.plan(second, Status.FAILED, "no sweep fits")


def mounted(*, by_joints: bool = False) -> MountedArm:
    """The planar arm: two fingers, a palm and a link."""
    arm = PlanarArm(PlanarArmOptions())
    return MountedArm(arm, arm.default_base_pose(SCENE.shelf), by_joints)


def _first_decision() -> PushDecision:
    diagram = PersistenceDiagram(np.zeros(3), np.array([0.0762, 0.1523, np.inf]))
    return PushDecision(
        corridor=CORRIDOR,
        members=("object_1", "object_2", "object_3"),
        diagram=diagram,
        persistent_radii=(0.0762, 0.1523),
        radius=0.0762,
        labels=np.array([0, 0, 1]),
        chosen=("object_1", "object_2"),
        rectangle=Rectangle(np.array([0.12, 0.28]), np.array([0.19, 0.31])),
    )


def _second_decision() -> PushDecision:
    diagram = PersistenceDiagram(np.zeros(1), np.array([np.inf]))
    labels, point = np.array([0]), np.array([0.33, 0.25])
    return PushDecision(
        deviations=("fallback radius",),
        corridor=CORRIDOR,
        members=("object_3",),
        diagram=diagram,
        radius=0.08,
        labels=labels,
        chosen=("object_3",),
        rectangle=Rectangle(point, point),
    )


def _sweep(name: str, before: State, after: State, decision: PushDecision) -> Step:
    lane, end = (0.2, 0.4) if "north" in name else (0.4, 0.2)
    poses = np.array([[-0.05, lane, 0.0], [0.2, lane, 0.0], [0.2, end, 0.0], [-0.05, end, 0.0]])
    path = GripperPath(poses, (Phase.INSERT, Phase.SWEEP, Phase.RETREAT), RULES)
    action = Action(name, path, decision.chosen)
    motion = Motion(3.05, (Contact(0.7, decision.chosen[0], Phase.SWEEP),), largest_force=12.5)
    return Step(
        action, time_path(path, 0.0, 60.0), before, after, replace(after, poses=before.poses), motion, decision, 0
    )


def _grasp(before: State, after: State) -> Step:
    poses = np.array([[-0.05, 0.3, 0.0], [0.4, 0.3, 0.0], [0.4, 0.3, 0.0], [-0.12, 0.3, 0.0]])
    rules = {**RULES, Phase.REACH: PhaseRule(0.25, 0.07, Contacts.MANIPULAND)}
    path = GripperPath(poses, (Phase.REACH, Phase.GRASP, Phase.WITHDRAW), rules, "mug")
    action = Action("grasp mug", path, ("mug",), ActionKind.GRASP)
    motion = Motion(4.0, wall_contacts=(Contact(3.9, "north wall", Phase.WITHDRAW),), largest_force=3.0)
    return Step(
        action, time_path(action.path, 0.0, 60.0), before, after, after, motion, PushDecision(corridor=CORRIDOR), 1
    )


def _moved(
    state: State,
    places: dict[str, tuple[float, float]],
    *,
    arm: tuple[float, float, float],
    toppled: str | None = None,
    held: str | None = None,
) -> State:
    poses, conditions = state.poses.copy(), list(state.conditions)
    for object_id, place in places.items():
        poses[SCENE.index(object_id)] = planar_pose(*place, 0.06)
    if toppled is not None:
        conditions[SCENE.index(toppled)] = Condition.TOPPLED
    return State(poses, tuple(conditions), held, ArmState(np.array(arm), 0.06 if held else 0.0))


def _frames(step: Step) -> Iterator[tuple[float, State]]:
    """Objects glide to where they end in the second half of the time; what falls does so ten frames before the end."""
    times = np.arange(0.0, step.motion.duration, PERIOD)
    for number, time in enumerate(times):
        pose, opening = step.trajectory.at(min(time, step.trajectory.duration))  # type: ignore[union-attr]
        half_over = 2.0 * time >= step.motion.duration
        late = number >= len(times) - 10 or (step.action.kind is ActionKind.GRASP and half_over)
        world = step.after if late else step.before
        poses = _between(step, max(0.0, 2.0 * time / step.motion.duration - 1.0))
        yield float(time), replace(world, poses=poses, arm=ArmState(pose, opening))


def _between(step: Step, part: float) -> FloatArray:
    return (1.0 - part) * step.before.poses + part * step.after.poses
