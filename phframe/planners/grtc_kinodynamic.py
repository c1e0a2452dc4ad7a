"""GRTC-Heuristic, kinodynamic (Papallas and Dogar 2020): what blocks the straight drive is steered to a free place."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from phframe.core import (
    ROOT,
    Attempt,
    FloatArray,
    Infeasible,
    Options,
    Plan,
    Planner,
    State,
    Status,
    Steering,
    Task,
    Transition,
)
from phframe.geometry.arm_view import ArmView
from phframe.kinodynamic.approach_poses import BESIDE, approach_poses
from phframe.kinodynamic.faults import fault_of
from phframe.kinodynamic.ompl_ import ControlSearch
from phframe.kinodynamic.places import drawn_place
from phframe.kinodynamic.region import GripperNear, ObjectNear, TargetInHand, pose_coordinates
from phframe.kinodynamic.steered_actions import steered_push, steered_reach
from phframe.kinodynamic.steered_decision import SteeredDecision
from phframe.kinodynamic.steered_tree import MOST_YAW, Controls, Room
from phframe.kinodynamic.steerer import SteeredLeg, Steerer
from phframe.pushing import (
    Pushing,
    PushingOptions,
    StraightDrive,
    first_blocker,
    is_unchanged,
    straight_drive,
)

PAST = 0.02
"""How far the fingertips go past the target's centre (m)."""
IN_HAND = 0.015
"""How far off that the target may be when the fingers close (m)."""
ARRIVED = 0.04
"""How near to an approach pose is near enough, a radian counting as 0.1 m (m)."""
PLACED = 0.1
"""How near to its place a blocker is pushed (m)."""

Bias = Annotated[float, Field(ge=0.0, le=1.0)]
Count = Annotated[int, Field(ge=1, le=1_000_000)]


class GRTCKinodynamicOptions(Options):
    """Figures of the method, and how long it searches.

    Attributes:
        half_width: Of the corridor along which the straight drive goes, w (m); ``auto``: half the arm's link, the largest
            obstacle's radius and 4 mm.
        search: Of controls: OMPL's RRT or KPIECE1.
        approach_bias: How often RRT aims at an approach pose, and at the grasp; KPIECE1 has a bias of its own, 0.05.
        push_bias: How often RRT aims at the blocker's place.
        speed: Greatest velocity of a control, forwards and sideways (m/s).
        turn_speed: Greatest rate at which one turns the gripper (rad/s).
        step: How long a control is held (s).
        controls: Controls that each approach and each push tries at most; 1000 take about 10 s.
        reach_controls: Controls that the reach for the target tries at most; the time limit ends it, too.
        back_off: How long the arm backs off after a push (s).
        attempts: Blockers in a row that could not be steered anywhere, after which to give up.
        max_actions: Pushes after which to give up.
    """

    half_width: Annotated[float, Field(gt=0.0, le=1.0)] | Literal["auto"] = 0.12
    search: ControlSearch = "rrt"
    approach_bias: Bias = 0.6
    push_bias: Bias = 0.5
    speed: Annotated[float, Field(gt=0.0, le=2.0)] = 0.1
    turn_speed: Annotated[float, Field(gt=0.0, le=2.0)] = 0.1
    step: Annotated[float, Field(ge=0.05, le=10.0)] = 1.0
    controls: Count = 1000
    reach_controls: Count = 5000
    back_off: Annotated[float, Field(ge=0.0, le=10.0)] = 1.5
    attempts: Annotated[int, Field(ge=1, le=1000)] = 10
    max_actions: Annotated[int, Field(ge=1, le=1000)] = 30


class GRTCKinodynamic(Planner[GRTCKinodynamicOptions]):
    """Drives straight at the target in simulation and steers the first object met to a free place, until none is met."""

    options_type = GRTCKinodynamicOptions

    def search(self, task: Task) -> Plan:
        """Search with the steering of the planning world; without it there is no plan."""
        if task.steering is None:
            return Plan(Status.FAILED, "the planning world cannot be steered: plan in another backend, such as pymunk")
        return _KinodynamicClearing(task, self.options, task.steering).run()


class _KinodynamicClearing:
    """One run for one task."""

    def __init__(self, task: Task, options: GRTCKinodynamicOptions, steering: Steering[Any]) -> None:
        self._task, self._options, self._steering = task, options, steering
        self._pushing = Pushing(task, PushingOptions(half_width=options.half_width))
        self._scene, self._tree = self._pushing.scene, task.search_tree()
        self._controls = Controls(options.speed, options.turn_speed, options.step)
        self._closed = ArmView(self._scene.shelf, task.arm.closed, 0.0)

    def run(self) -> Plan:
        """Steer blockers aside until the straight drive meets none; then reach."""
        node, attempts = ROOT, 0
        while True:
            before = self._tree[node].state
            drive = self._drive(before)
            if isinstance(drive, Infeasible):
                return self._fail(node, drive.reason)
            blocker = first_blocker(self._pushing, before.parked(), drive)
            if isinstance(blocker, Infeasible):
                return self._fail(node, blocker.reason)
            if blocker is None:
                return self._reach(node, drive)
            if self._tree.depth(node) >= self._options.max_actions:
                return self._fail(node, f"{blocker} blocks the drive after {self._options.max_actions} actions")
            pushed = self._push(node, blocker, drive)
            attempts = attempts + 1 if pushed is None else 0
            if attempts >= self._options.attempts:
                return self._fail(node, f"{blocker} could not be steered aside in {attempts} attempts")
            node = node if pushed is None else pushed

    def _push(self, node: int, blocker: str, drive: StraightDrive) -> int | None:
        """Steer a blocker to a drawn place, from one of three sides; the node where that led, or None."""
        before, row = self._tree[node].state, self._scene.index(blocker)
        radius = float(self._scene.radii[row])
        place = drawn_place(self._scene, before, row, lambda at: bool(drive.meets(at[None], radius)[0]), self._task.rng)
        if place is None:
            return None
        steerer = self._steerer(before)
        for side, pose in approach_poses(before.positions[row], place, radius + BESIDE, MOST_YAW):
            if self._stands_free(before, row, pose, steerer):
                decision = SteeredDecision(
                    f"{blocker} blocks the straight drive; from {side}", (), blocker, place, pose
                )
                pushed = self._push_from(node, steerer, decision)
                if pushed is not None:
                    return pushed
        return None

    def _push_from(self, node: int, steerer: Steerer, decision: SteeredDecision) -> int | None:
        """Approach, push, and simulate the two as one action; what falls short is kept in the tree, closed."""
        o, before, closed = self._options, self._tree[node].state, self._task.arm.min_opening
        assert decision.approach is not None, "given"
        region = GripperNear.of(decision.approach, ARRIVED, steerer.room)
        start = steerer.begin(before)
        approach = steerer.leg(start, region, opening=closed, bias=o.approach_bias, most=o.controls)
        if not approach.reached:
            self._add(node, [approach], decision, "no way to the approach pose was found")
            return None
        pushing = self._to_place(decision, steerer)
        push = steerer.leg(approach.snapshot, pushing, opening=closed, bias=o.push_bias, most=o.controls)
        if not push.reached:
            self._add(node, [approach, push], decision, "no push to the place was found")
            return None
        added = self._add(node, [approach, push], decision, "")
        return None if added is None or self._tree[added].closed else added

    def _add(self, node: int, legs: list[SteeredLeg], decision: SteeredDecision, closed: str) -> int | None:
        """Simulate steered legs as one action, and note it; None where they move nothing or were rejected."""
        controls, arm = self._controls, self._task.arm
        action = steered_push(legs, controls, arm, decision.moved, self._options.back_off)
        if action is None or self._task.rejects(action) is not None:
            return None
        before = self._tree[node].state
        made = self._task.apply(before, action)
        noted = _noted(decision, legs, made.state)
        fault = closed or _fault(before, made)
        assert decision.place is not None, "given"
        short = np.linalg.norm(made.state.positions[self._scene.index(decision.moved)] - decision.place)
        return self._tree.child(node, action, made, noted, value=-float(short), closed=fault)

    def _reach(self, node: int, drive: StraightDrive) -> Plan:
        """Steer to the target with open fingers, close them and draw it out; again while that fails and controls are left."""
        left, plan = self._options.reach_controls, self._fail(node, "no controls were left to reach the target")
        state = self._tree[node].state
        steerer = self._steerer(state)
        region = self._in_hand(state, drive, steerer.room)
        opening = drive.action.path.rule(0).opening
        for attempt in range(self._options.attempts):
            start = steerer.begin(state)
            leg = steerer.leg(start, region, opening=opening, bias=self._options.approach_bias, most=left)
            if not leg.reached:
                short = f"no controls that reach the target were found: {leg.distance:.3f} m short"
                return plan if attempt else self._fail(node, short)
            plan, left = self._grasp(node, leg, opening), left - leg.tree.tried
            if plan.status.is_success or left <= 0:
                break
        return plan

    def _grasp(self, node: int, leg: SteeredLeg, opening: float) -> Plan:
        """The plan that ends with a steered reach, simulated and judged by the task's goal."""
        target, row, task = self._scene.target, self._scene.target_index, self._task
        out = float(self._scene.radii[row]) + self._pushing.options.withdrawal
        action = steered_reach(leg, self._controls, opening, task.arm.min_opening, target, out)
        if task.rejects(action) is not None:
            return self._tree.plan(node, Status.FAILED, "the reach that was found was rejected")
        made = task.apply(self._tree[node].state, action)
        decision = _noted(SteeredDecision("nothing blocks the straight drive", moved=target), [leg], made.state, row)
        end = self._tree.child(node, action, made, decision)
        outcome = task.goal.assess(task.scene, made.state, Attempt(action, made.motion))
        plan = self._tree.plan(end, outcome.status, outcome.reason)
        if not outcome.status.is_success:
            self._tree.close(end, outcome.reason)
        return plan

    def _drive(self, state: State) -> StraightDrive | Infeasible:
        if state.held is not None:
            return Infeasible(f"{state.held} is in the hand")
        return straight_drive(self._pushing, state.parked())

    def _steerer(self, state: State) -> Steerer:
        """What steers from a state, in a room that holds where the fingertip is."""
        room = Room.of(self._scene.shelf)
        arm = self._steering.state_of(self._steering.begin(state)).arm
        assert arm is not None, "steering begins where the arm is"
        return Steerer(
            self._steering, self._controls, room.with_pose(arm.gripper), self._options.search, self._task.rng
        )

    def _stands_free(self, state: State, row: int, pose: FloatArray, steerer: Steerer) -> bool:
        """Whether the arm at a pose keeps off the walls, and its fingertip off other objects."""
        apart = np.linalg.norm(state.positions - pose[:2], axis=1) - self._scene.radii
        others = state.on_board & (np.arange(len(apart)) != row)
        off_walls = bool(self._closed.walls(float(pose[2])).is_free(pose[:2]))
        return steerer.room.holds(pose) and off_walls and bool((apart[others] > self._task.arm.insertion_width).all())

    def _to_place(self, decision: SteeredDecision, steerer: Steerer) -> ObjectNear:
        """The region in which the blocker is at its place."""
        assert decision.place is not None, "given"
        assert decision.approach is not None, "given"
        row, room = self._scene.index(decision.moved), steerer.room
        along = decision.place - decision.approach[:2]
        behind = -along / np.linalg.norm(along) * (float(self._scene.radii[row]) + BESIDE)
        return ObjectNear(row, decision.place, behind, float(decision.approach[2]), PLACED, *self._with_object(room))

    def _in_hand(self, state: State, drive: StraightDrive, room: Room) -> TargetInHand:
        """The region in which the target is between the fingers."""
        row = self._scene.target_index
        bounds = self._with_object(room)
        return TargetInHand(row, PAST, float(drive.tip[2]), state.positions[row], IN_HAND, *bounds)

    def _with_object(self, room: Room) -> tuple[FloatArray, FloatArray]:
        """Bounds of a fingertip's pose and an object's position ``(5,)``."""
        board = np.array([self._scene.shelf.depth, self._scene.shelf.width])
        lower, upper = pose_coordinates(room.lower), pose_coordinates(room.upper)
        return np.concatenate([lower, np.zeros(2)]), np.concatenate([upper, board])

    def _fail(self, node: int, reason: str) -> Plan:
        return self._tree.plan(node, Status.FAILED, reason)


def _noted(decision: SteeredDecision, legs: list[SteeredLeg], made: State, taken: int | None = None) -> SteeredDecision:
    """The decision with what the searches came to, and how far the whole action differs, but for the object it takes."""
    apart = np.linalg.norm(legs[-1].state.positions - made.positions, axis=1)
    if taken is not None:
        apart[taken] = 0.0
    return replace(
        decision,
        controls=sum(leg.tree.tried for leg in legs),
        distance=legs[-1].distance,
        drift=float(apart.max()),
    )


def _fault(before: State, made: Transition) -> str:
    """Why a push is not gone on from."""
    if fault := fault_of(before, made):
        return fault
    return "nothing moved" if is_unchanged(before, made.state) else ""
