"""Motion planning of arms of joints: Cartesian following in the shelf, collision-free joint paths outside of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from phframe.core import (
    ArmModel,
    BasePose,
    FloatArray,
    GripperPath,
    JointTrajectory,
    MotionPlanner,
    Scene,
    State,
    Unreachable,
)
from phframe.motion.budget import SearchBudget
from phframe.motion.cartesian_following import CartesianFollower
from phframe.motion.cartesian_path import OUTSIDE, CartesianPathFollower, JointPath, pose_text
from phframe.motion.cartesian_waypoints import waypoints
from phframe.motion.coal_ import CollisionChecker, CollisionModel
from phframe.motion.collision_checking import CollisionContext, allowed_objects
from phframe.motion.collision_free_path import collision_free_path, require_planner
from phframe.motion.configuration_search import ConfigurationSearch
from phframe.motion.differential_ik import DifferentialIK
from phframe.motion.null_space_objective import NullSpaceObjective
from phframe.motion.options import ArticulatedOptions
from phframe.motion.pinocchio_ import Kinematics
from phframe.motion.segments import leg_segments, straight_segments
from phframe.motion.surface_points import SurfacePoints
from phframe.motion.time_parametrisation import TimeParametrisation
from phframe.urdf.description import ArmDescription
from phframe.urdf.model import Robot

SAME_POSITION, SAME_YAW = 5e-3, 0.03
"""A path that begins no farther than this (m, rad) from where the gripper is goes on from there."""
STRIDE = 6
"""Every how many waypoints is looked at where a path is beyond the arm, to say how far it gets."""
RESOLUTION = 0.03
"""Most that a joint moves between two configurations of a joint path that are checked for collisions (rad or m)."""


@dataclass(frozen=True, slots=True, eq=False)
class _Problem:
    """A path and where it begins: joint values ``(dof,)`` and commanded opening (m)."""

    path: GripperPath
    state: State
    begin: FloatArray
    opening: float


class ArticulatedMotionPlanner(MotionPlanner[ArticulatedOptions]):
    """Follows paths with any arm that is given by a URDF and a description.

    In the shelf, joints follow the path at constant height, continuously and in a configuration that is as narrow
    behind the gripper as can be. The gripper keeps to the path's yaw; it is turned against it only where the arm can do
    no other, and may turn away freely where the fingers are less than 5 cm in the shelf. From where the arm is to where
    its way in begins, OMPL plans a collision-free joint path.

    Args:
        scene: The shelf and its objects.
        arm: The arm.
        base_pose: Where its base stands.
        options: Of the arm.
        description: Of the arm.
        robot: Its links.
        kinematics: Of the chain from its base to the fingertip.

    Raises:
        UnknownNameError: If there is no such planner.
        NotInstalledError: If OMPL is not installed.
    """

    options_type = ArticulatedOptions

    def __init__(
        self,
        scene: Scene,
        arm: ArmModel[Any],
        base_pose: BasePose,
        options: ArticulatedOptions,
        description: ArmDescription,
        robot: Robot,
        kinematics: Kinematics,
    ) -> None:
        super().__init__(scene, arm, base_pose, options)
        require_planner(options.motion_planner)
        self._kinematics = kinematics
        depth, margins = scene.shelf.depth, (options.wall_margin, options.object_margin)
        surface = SurfacePoints(kinematics, robot, description.joints, arm.tip_link, base_pose, depth)
        self._objective = NullSpaceObjective(kinematics, surface, description.behind, scene.shelf)
        self._collisions = CollisionModel(arm, description, scene.shelf, scene.objects, base_pose, *margins)
        self._time_parametrisation = TimeParametrisation(arm, base_pose, options)
        self._names = [joint.name for joint in arm.joints]
        self._seeds = [np.array(seed) for seed in description.seed_configurations]

    def plan(
        self, path: GripperPath, state: State, *, attempts: int, seconds: float, rng: np.random.Generator
    ) -> JointTrajectory | Unreachable:
        """Plan a joint trajectory: the same inputs give the same bits, or ``timed_out`` where the time was up before."""
        budget = SearchBudget(self.options.search, seconds)
        begin, opening = self._where(state)
        if begin is None:
            where = "" if state.arm is None else f", at {pose_text(state.arm.gripper)}"
            return Unreachable(0.0, f"the arm's joints cannot have the gripper where it is said to be{where}", 0)
        found = self._planned(_Problem(path, state, begin, opening), attempts, budget, rng)
        if budget.timed_out:
            return Unreachable(0.0, f"no motion was found in the {seconds:g} s allowed", 0, timed_out=True)
        return found

    def _where(self, state: State) -> tuple[FloatArray | None, float]:
        """Joint values ``(dof,)``, None where none are known, and commanded opening (m)."""
        if state.arm is None:
            return self.arm.home, self.arm.shape.min_opening
        joints = state.arm.joints
        if joints is None:
            joints = self.arm.inverse(self.arm.fingertip_pose(state.arm.gripper, self.base_pose), self.arm.home)
        return joints, state.arm.commanded_opening

    def _planned(
        self, problem: _Problem, attempts: int, budget: SearchBudget, rng: np.random.Generator
    ) -> JointTrajectory | Unreachable:
        """From where the gripper is, if the path begins there and that can be; else by an approach from outside."""
        found = self._onwards(problem) if self._begins_here(problem) else None
        if isinstance(found, JointTrajectory) or (found is not None and problem.path.poses[0, 0] > OUTSIDE):
            return found
        return self._approached(problem, attempts, budget, rng)

    def _onwards(self, problem: _Problem) -> JointTrajectory | Unreachable:
        """The path from where the arm is; what it touches there, it may touch until it has got away."""
        begin = problem.begin
        found = self._paths(problem, start=begin).onwards(begin, self.arm.gripper_pose(begin, self.base_pose))
        if isinstance(found, Unreachable):
            return found
        return self._time_parametrisation.trajectory([*leg_segments(found, problem.path, problem.opening)])

    def _begins_here(self, problem: _Problem) -> bool:
        """Whether a path begins where the gripper is."""
        x, y, yaw = (self.arm.gripper_pose(problem.begin, self.base_pose) - problem.path.poses[0]).tolist()
        return math.hypot(x, y) < SAME_POSITION and abs(math.remainder(yaw, math.tau)) < SAME_YAW

    def _approached(
        self, problem: _Problem, attempts: int, budget: SearchBudget, rng: np.random.Generator
    ) -> JointTrajectory | Unreachable:
        """The joint path to where one that follows the gripper path begins, and that one."""
        tolerance, paths = self.options.yaw_tolerance, self._paths(problem, start=None)
        seeds, blocked = [*self._seeds, problem.begin, self.arm.home], None
        if (beyond := self._beyond_reach(paths, seeds)) is not None:
            return beyond
        search = ConfigurationSearch(paths, self._kinematics, self._objective, tolerance, budget)
        for found in search.joint_paths(seeds, attempts, rng):
            approach = self._approach(problem, found, budget, rng)
            if not isinstance(approach, Unreachable):
                return self._joined(problem, approach, found)
            blocked = blocked or approach
        return blocked or search.farthest

    def _beyond_reach(self, paths: CartesianPathFollower, seeds: Sequence[FloatArray]) -> Unreachable | None:
        """That inverse kinematics cannot have the deepest pose of a path, turned as far as may be, if so: the quick no."""
        tolerance = self.options.yaw_tolerance
        if any(self._solved(paths, paths.deepest, yaw, seeds) is not None for yaw in (0.0, tolerance, -tolerance)):
            return None
        row, q = paths.gate, self._solved(paths, paths.gate, 0.0, seeds)
        while q is not None and row < paths.deepest:
            row = min(row + STRIDE, paths.deepest)
            q = self._kinematics.descend_to(paths.follower(row).target(paths.pose(row)), q)
        return paths.unreachable(row, "out of reach: inverse kinematics finds no joint values")

    def _solved(
        self, paths: CartesianPathFollower, row: int, yaw: float, seeds: Sequence[FloatArray]
    ) -> FloatArray | None:
        """Joint values ``(dof,)`` for a pose of a path, the gripper turned by a yaw (rad), or None."""
        target = paths.follower(row).target(paths.pose(row) + np.array([0.0, 0.0, yaw]))
        found = (self._kinematics.descend_to(target, start) for start in self._kinematics.starts(seeds))
        return next((q for q in found if q is not None), None)

    def _joined(self, problem: _Problem, approach: FloatArray, found: JointPath) -> JointTrajectory:
        """The motion along corners ``(k, dof)`` and then a joint path."""
        first = problem.path.rule(int(found.legs[0])).opening
        segments = [*straight_segments(approach, problem.opening, first), *leg_segments(found, problem.path, first)]
        return self._time_parametrisation.trajectory(segments)

    def _approach(
        self, problem: _Problem, found: JointPath, budget: SearchBudget, rng: np.random.Generator
    ) -> FloatArray | Unreachable:
        """Corners ``(k, dof)`` of a joint path to where another begins, collision-free but for what touches at its start."""
        begin, end = problem.begin, found.joints[0]
        opening = max(problem.opening, problem.path.rule(int(found.legs[0])).opening)
        checker = self._collisions.checker(CollisionContext(problem.state, opening, start=begin))
        corners = collision_free_path(
            begin,
            end[None],
            lower=np.minimum(self._kinematics.lower, begin),  # a controller may have gone a little too far
            upper=np.maximum(self._kinematics.upper, begin),
            valid=checker.is_free,
            planner=self.options.motion_planner,
            resolution=RESOLUTION,
            stop=budget.search(),
            rng=rng,
        )
        return self._unapproachable(checker, begin, end) if corners is None else corners

    def _unapproachable(self, checker: CollisionChecker, begin: FloatArray, end: FloatArray) -> Unreachable:
        """Why no joint path leads to where the gripper path is entered, as far as one can tell."""
        if met := checker.collisions(end):
            why, bodies = f"{met[0][0]} meets {met[0][1]} there", (met[0][1],)
        else:
            steps = max(2, math.ceil(float(np.abs(end - begin).max()) / RESOLUTION))
            line = begin + np.linspace(0.0, 1.0, steps)[:, None] * (end - begin)
            link, body = next((met[0] for q in line if (met := checker.collisions(q))), ("the arm", "something"))
            why, bodies = f"straight, {link} meets {body}, and {self.options.motion_planner} finds none", (body,)
        return Unreachable(0.0, f"no collision-free joint path leads to where the path goes in: {why}", 0, bodies)

    def _paths(self, problem: _Problem, start: FloatArray | None) -> CartesianPathFollower:
        """What finds joint paths for a gripper path, each leg in its own collision context."""

        @cache
        def follower(opening: float, allowed: frozenset[str]) -> CartesianFollower:
            return self._follower(CollisionContext(problem.state, opening, allowed, start))

        def follower_of(leg: int) -> CartesianFollower:
            rule = problem.path.rule(leg)
            return follower(rule.opening, allowed_objects(rule.contacts, self.scene, problem.path.manipuland))

        spacing = self.options.cartesian_spacing
        return CartesianPathFollower(problem.path, waypoints(problem.path, spacing), spacing, follower_of)

    def _follower(self, context: CollisionContext) -> CartesianFollower:
        """What follows poses in a collision context."""
        ik = DifferentialIK(self._kinematics, self._objective, context.obstacles(self.scene))
        checker = self._collisions.checker(context)
        return CartesianFollower(ik, checker, self.base_pose, self.arm.shape.height, self._names)
