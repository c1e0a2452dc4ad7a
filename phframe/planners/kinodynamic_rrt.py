"""Kinodynamic RRT: a tree of states at rest, joined by simulated dynamic pushes (after Haustein et al. 2015)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from phframe.core import (
    ROOT,
    Action,
    ActionKind,
    Attempt,
    Contacts,
    Decision,
    FloatArray,
    Infeasible,
    Options,
    Phase,
    PhaseRule,
    Plan,
    Planner,
    State,
    Status,
    Task,
    controlled_path,
)
from phframe.kinodynamic.approach_poses import BESIDE, approach_poses
from phframe.kinodynamic.faults import fault_of
from phframe.kinodynamic.paths import straight_back, way_out
from phframe.kinodynamic.places import drawn_place
from phframe.kinodynamic.region import pose_coordinates
from phframe.kinodynamic.steered_tree import MOST_YAW, Room
from phframe.pushing import Grasp, Pushing, PushingOptions, StraightDrive, straight_drive

DRAWS = 100
"""How often an action is drawn that does not lead out of the room."""
OUT_SPEED = 0.25
"""Drawing the arm out before the grasp (m/s)."""


class KinodynamicRRTOptions(Options):
    """Figures of the method, and how long it searches.

    Attributes:
        half_width: Of the corridor along which the target is grasped, w (m); ``auto``: half the arm's link, the largest
            obstacle's radius and 4 mm.
        actions: Actions drawn and simulated from the node chosen in each iteration.
        goal_bias: How often a configuration is drawn in which something that blocks the grasp stands elsewhere.
        gripper_weight: What the gripper's distance counts for beside the objects' in the distance of configurations.
        speed: Greatest velocity of an action, forwards and sideways (m/s).
        turn_speed: Greatest rate at which one turns the gripper (rad/s).
        shortest: Least duration of an action (s).
        longest: Greatest duration of an action (s); where it is less than the least, all last that long.
        max_iterations: After which to give up.
    """

    half_width: Annotated[float, Field(gt=0.0, le=1.0)] | Literal["auto"] = 0.12
    actions: Annotated[int, Field(ge=1, le=1000)] = 10
    goal_bias: Annotated[float, Field(ge=0.0, le=1.0)] = 0.5
    gripper_weight: Annotated[float, Field(gt=0.0, le=100.0)] = 0.5
    speed: Annotated[float, Field(gt=0.0, le=2.0)] = 0.2
    turn_speed: Annotated[float, Field(gt=0.0, le=2.0)] = 0.5
    shortest: Annotated[float, Field(gt=0.0, le=30.0)] = 0.5
    longest: Annotated[float, Field(gt=0.0, le=30.0)] = 3.0
    max_iterations: Annotated[int, Field(ge=1, le=1_000_000)] = 1000


class KinodynamicRRT(Planner[KinodynamicRRTOptions]):
    """Grows a tree of states at rest by simulated pushes towards drawn configurations, until the target can be grasped."""

    options_type = KinodynamicRRTOptions

    def search(self, task: Task) -> Plan:
        """Search; pushes may move anything, the target too, but nothing may fall and no wall be touched."""
        return _Growing(task, self.options).run()


@dataclass(frozen=True, slots=True, eq=False)
class DrawnConfiguration:
    """What an iteration grows towards.

    Attributes:
        positions: Of all objects ``(n, 2)`` (m).
        gripper: Pose ``(3,)``: x, y (m), yaw (rad).
        moved: Id of the object that is to be moved; empty: none in particular.
    """

    positions: FloatArray
    gripper: FloatArray
    moved: str = ""


class _Growing:
    """One run for one task."""

    def __init__(self, task: Task, options: KinodynamicRRTOptions) -> None:
        self._task, self._options = task, options
        self._pushing = Pushing(task, PushingOptions(half_width=options.half_width))
        self._scene, self._tree = self._pushing.scene, task.search_tree()
        self._room = Room.of(self._scene.shelf)
        self._rule = PhaseRule(options.speed, task.arm.min_opening, Contacts.OBJECTS)
        self._open: list[int] = []
        self._blockers: dict[int, tuple[str, ...]] = {}  # of the open nodes that objects keep from the grasp

    def run(self) -> Plan:
        """Grow the tree until the grasp succeeds."""
        if self._task.start.held is not None:
            return self._tree.plan(ROOT, Status.FAILED, f"{self._task.start.held} is in the hand")
        drive = straight_drive(self._pushing, self._task.start)
        if isinstance(drive, Infeasible):
            return self._tree.plan(ROOT, Status.FAILED, drive.reason)
        if (plan := self._opened(ROOT)) is not None:
            return plan
        for _ in range(self._options.max_iterations):
            wanted = self._drawn(drive)
            grown = self._grown(self._nearest(wanted), wanted)
            if grown is not None and (plan := self._opened(grown)) is not None:
                return plan
        tried = len(self._tree) - 1
        return self._tree.plan(ROOT, Status.FAILED, f"no grasp succeeded from any of {tried} states that pushes led to")

    def _opened(self, node: int) -> Plan | None:
        """Make a node one that the tree may grow from; the plan that ends there, where the target can be grasped."""
        problem = self._pushing.problem(self._tree[node].state)
        grasp = problem if isinstance(problem, Infeasible) else self._pushing.grasp(problem)
        if isinstance(grasp, Grasp):
            plan = self._grasped(node)
            if plan is not None:
                return plan
        self._open.append(node)
        if isinstance(grasp, Infeasible) and grasp.blockers:
            self._blockers[node] = grasp.blockers
            self._tree.rate(node, -float(len(grasp.blockers)))
        return None

    def _grasped(self, node: int) -> Plan | None:
        """Draw the arm out, grasp, and have the task's goal judge it; None where it does not succeed."""
        node = self._drawn_out(node)
        if self._tree[node].closed:
            return None
        problem = self._pushing.problem(self._tree[node].state)
        grasp = problem if isinstance(problem, Infeasible) else self._pushing.grasp(problem)
        if isinstance(grasp, Infeasible):
            return None
        made = self._task.apply(self._tree[node].state, grasp.action)
        end = self._tree.child(node, grasp.action, made, Decision("nothing blocks the grasp", grasp.deviations))
        outcome = self._task.goal.assess(self._task.scene, made.state, Attempt(grasp.action, made.motion))
        if outcome.status.is_success:
            return self._tree.plan(end, outcome.status, outcome.reason)
        self._tree.close(end, outcome.reason)
        return None

    def _drawn_out(self, node: int) -> int:
        """The node after drawing the arm straight out of the shelf, closed if that went wrong; the same where it is out."""
        state = self._tree[node].state
        distance = 0.0 if state.arm is None else way_out(state.arm.gripper, self._task.arm)
        if state.arm is None or distance == 0.0:
            return node
        rule = PhaseRule(OUT_SPEED, self._rule.opening, Contacts.OBJECTS)
        action = Action(
            "draw back", straight_back(state.arm.gripper, distance, Phase.RETREAT, rule), kind=ActionKind.MOVE
        )
        made, why = self._task.apply(state, action), Decision("the grasp begins outside")
        return self._tree.child(node, action, made, why, closed=fault_of(state, made))

    def _drawn(self, drive: StraightDrive) -> DrawnConfiguration:
        """A configuration to grow towards: any, or one that is nearer to the goal."""
        if self._task.rng.random() < self._options.goal_bias and (better := self._better(drive)) is not None:
            return better
        rng, shelf = self._task.rng, self._scene.shelf
        positions = rng.uniform([0.0, 0.0], [shelf.depth, shelf.width], (len(self._scene.objects), 2))
        return DrawnConfiguration(positions, rng.uniform(self._room.lower, self._room.upper))

    def _better(self, drive: StraightDrive) -> DrawnConfiguration | None:
        """As at the node with the fewest blockers, one of which stands at a free place, the gripper behind it.

        Nodes without any, from which the grasp is kept by a wall, was rejected or failed, say nothing about what to move.
        """
        if not self._blockers:
            return None
        rng = self._task.rng
        best = min(self._blockers, key=lambda node: (len(self._blockers[node]), -node))
        blockers, state = self._blockers[best], self._tree[best].state
        moved = blockers[int(rng.integers(len(blockers)))]
        row = self._scene.index(moved)
        radius = float(self._scene.radii[row])
        place = drawn_place(self._scene, state, row, lambda at: bool(drive.meets(at[None], radius)[0]), rng)
        if place is None:
            return None
        positions = state.positions.copy()
        _, pose = next(approach_poses(positions[row], place, radius + BESIDE, MOST_YAW))
        positions[row] = place
        return DrawnConfiguration(positions, pose, moved)

    def _nearest(self, wanted: DrawnConfiguration) -> int:
        return min(self._open, key=lambda node: self._distance(self._tree[node].state, wanted))

    def _distance(self, state: State, wanted: DrawnConfiguration) -> float:
        """Sum of the distances of the objects, and of the gripper's as it is weighted (m)."""
        objects = np.linalg.norm(state.positions - wanted.positions, axis=1)
        gripper = pose_coordinates(self._gripper(state, wanted) - wanted.gripper)
        return float(objects[state.on_board].sum() + self._options.gripper_weight * np.linalg.norm(gripper))

    def _gripper(self, state: State, wanted: DrawnConfiguration) -> FloatArray:
        """Where the fingertip is; a parked arm begins before the mouth, straight before the pose that is wanted."""
        if state.arm is not None:
            return state.arm.gripper
        half, pose = self._task.arm.link_width / 2.0, np.zeros(3)
        pose[0] = -way_out(pose, self._task.arm)
        pose[1] = min(max(float(wanted.gripper[1]), half), self._scene.shelf.width - half)
        return pose

    def _grown(self, node: int, wanted: DrawnConfiguration) -> int | None:
        """Simulate actions drawn at a node; the new node nearest to a configuration, if any came of it."""
        state = self._tree[node].state
        actions = [action for _ in range(self._options.actions) if (action := self._action(state, wanted)) is not None]
        left = self._task.simulations_left
        actions = actions if left is None else actions[: max(left, 1)]
        made = self._task.apply_many([(state, action) for action in actions])
        decision = Decision(f"towards a configuration with {wanted.moved} aside" if wanted.moved else "towards any")
        rows = [
            self._tree.child(node, action, each, decision, closed=fault_of(state, each))
            for action, each in zip(actions, made, strict=True)
        ]
        sound = [row for row in rows if not self._tree[row].closed]
        if not sound:
            return None
        best = min(sound, key=lambda row: self._distance(self._tree[row].state, wanted))
        for row in sound:
            if row != best:
                self._tree.close(row, "another action led nearer to the configuration drawn")
        return best

    def _action(self, state: State, wanted: DrawnConfiguration) -> Action | None:
        """A twist, drawn evenly, held for a time, drawn evenly, that stays in the room and was not rejected."""
        o, rng, start = self._options, self._task.rng, self._gripper(state, wanted)
        room, most = self._room.with_pose(start), np.array([o.speed, o.speed, o.turn_speed])
        for _ in range(DRAWS):
            duration, twist = float(rng.uniform(o.shortest, max(o.shortest, o.longest))), rng.uniform(-most, most)
            if not room.holds(start + twist * duration):
                continue
            path = controlled_path(start, twist[None], duration, Phase.SWEEP, self._rule)
            action = Action(f"push for {duration:.1f} s", path, (wanted.moved,) if wanted.moved else ())
            if self._task.rejects(action) is None:
                return action
        return None
