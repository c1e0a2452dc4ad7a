"""Lifts paths of the gripper to the joints of an arm: followed in the shelf, on free ways outside of it."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING, Any

import numpy as np

from phframe.core import (
    BasePose,
    Contacts,
    FloatArray,
    GripperPath,
    JointTrajectory,
    MotionPlanner,
    PhaseRule,
    Scene,
    State,
    Unreachable,
    compose,
    inverse,
    planar_pose,
    yaw_of,
)
from phframe.motion.coal_ import CollisionModel
from phframe.motion.follow import Follower
from phframe.motion.joint_path import joint_path, require_planner
from phframe.motion.options import ArticulatedOptions
from phframe.motion.posture import Posture
from phframe.motion.route import OUTSIDE, Router
from phframe.motion.route_search import RouteSearch
from phframe.motion.segments import free_way, legs_of
from phframe.motion.surface_points import Skin
from phframe.motion.time_parametrisation import Scheduler
from phframe.motion.track import Tracker
from phframe.motion.waypoints import waypoints

if TYPE_CHECKING:
    from phframe.arms.articulated import ArticulatedArm

SAME_POSITION, SAME_YAW = 5e-3, 0.03
"""A path that begins no farther than this (m, rad) from where the gripper is goes on from there."""
RESOLUTION = 0.03
"""Most that a joint moves between two configurations of a free way that are looked at (rad or m)."""

NOWHERE = Unreachable(0.0, "the arm's joints cannot have the gripper where it is said to be", 0)
OUT_OF_TIME = Unreachable(0.0, "no motion was found in the time allowed", 0)
UNAPPROACHABLE = Unreachable(0.0, "no free way leads to where the path goes in", 0)


class ArticulatedMotionPlanner(MotionPlanner[ArticulatedOptions]):
    """Follows paths with any arm that is given by a URDF and a description.

    In the shelf, joints follow the path at constant height, continuously and in a posture that is as narrow behind the
    gripper as can be. The gripper keeps to the path's yaw; it is turned against it, by up to 15 degrees, only where the
    arm can do no other, and may turn away freely where the fingers are less than 5 cm in the shelf. From where the arm
    is to where its way in begins, OMPL plans.

    Raises:
        UnknownNameError: If there is no such planner.
        NotInstalledError: If OMPL is not installed.
    """

    options_type = ArticulatedOptions

    def __init__(
        self, scene: Scene, arm: ArticulatedArm[Any], base_pose: BasePose, options: ArticulatedOptions
    ) -> None:
        super().__init__(scene, arm, base_pose, options)
        require_planner(options.motion_planner)
        self._described, self._kinematics = arm.description, arm.kinematics
        skin = Skin(self._kinematics, arm.robot, self._described.joints, arm.tip_link, base_pose, scene.shelf.depth)
        self._posture = Posture(self._kinematics, skin, self._described.behind, scene.shelf)
        self._follower = Follower(self._kinematics, self._posture)
        names, apart = self._described.joints, self._described.overlapping
        self._collisions = CollisionModel(arm.urdf(), names, self._described.fingers, apart, scene, base_pose)
        self._tracker = Tracker(self._follower, self._collisions, base_pose, arm, scene)
        self._scheduler = Scheduler(arm, base_pose, options)

    def plan(
        self, path: GripperPath, state: State, *, attempts: int, seconds: float, rng: np.random.Generator
    ) -> JointTrajectory | Unreachable:
        """Lift a path. The same inputs give the same bits, unless the time runs out."""
        until = time.monotonic() + seconds
        begin, opening = self._where(state)
        if begin is None:
            return NOWHERE
        self._tracker.place(state)
        router = Router(path, waypoints(path), self._tracker)
        found = self._onwards(path, router, begin, opening) if self._goes_on(begin, path) else None
        if isinstance(found, JointTrajectory) or (found is not None and path.poses[0, 0] > OUTSIDE):
            return found
        return self._approached(path, router, begin, opening, attempts, until, rng)

    def _where(self, state: State) -> tuple[FloatArray | None, float]:
        """Joint values ``(dof,)``, None where none are known, and commanded opening (m)."""
        if state.arm is None:
            return self.arm.home, self.arm.shape.min_opening
        joints = state.arm.joints
        if joints is None:
            joints = self.arm.inverse(self._in_base(state.arm.gripper), self.arm.home)
        return joints, state.arm.commanded_opening

    def _onwards(
        self, path: GripperPath, router: Router, begin: FloatArray, opening: float
    ) -> JointTrajectory | Unreachable:
        """The path from where the arm is; what it touches there, it may touch until it has got away."""
        self._tracker.permit(path.rule(0), path.manipuland)
        with self._collisions.tolerating(begin):
            route = router.onwards(begin, self._seen(begin))
        if isinstance(route, Unreachable):
            return route
        return self._scheduler.trajectory([*legs_of(route, path, opening)])

    def _seen(self, q: FloatArray) -> FloatArray:
        """The gripper's pose seen from above ``(3,)`` at joint values ``(dof,)``."""
        pose = compose(self.base_pose.pose, self.arm.forward(q))
        return np.array([pose[0], pose[1], yaw_of(pose)])

    def _goes_on(self, begin: FloatArray, path: GripperPath) -> bool:
        """Whether a path begins where the gripper is."""
        x, y, yaw = (self._seen(begin) - path.poses[0]).tolist()
        return math.hypot(x, y) < SAME_POSITION and abs(math.remainder(yaw, math.tau)) < SAME_YAW

    def _approached(
        self,
        path: GripperPath,
        router: Router,
        begin: FloatArray,
        opening: float,
        attempts: int,
        until: float,
        rng: np.random.Generator,
    ) -> JointTrajectory | Unreachable:
        """The way to where a route of the path begins, and the route."""
        search = RouteSearch(router, self._tracker, self._follower, self._kinematics, until)
        seeds = [*(np.array(posture) for posture in self._described.postures), begin, self.arm.home]
        approached = True
        for route in search.routes(seeds, attempts, rng):
            first = path.rule(int(route.legs[0])).opening
            way = self._free_way(begin, route.joints[0], max(opening, first), until, rng)
            if way is not None:
                return self._scheduler.trajectory([*free_way(way, opening, first), *legs_of(route, path, first)])
            approached = False
        if time.monotonic() > until:
            return OUT_OF_TIME
        return search.farthest if approached else UNAPPROACHABLE

    def _free_way(
        self, begin: FloatArray, end: FloatArray, opening: float, until: float, rng: np.random.Generator
    ) -> FloatArray | None:
        """Corners ``(k, dof)`` of a way on which nothing is touched but what is touched where it begins."""
        self._tracker.permit(PhaseRule(1.0, opening, Contacts.NONE), None)
        with self._collisions.tolerating(begin):
            return joint_path(
                begin,
                end[None],
                lower=np.minimum(self._kinematics.lower, begin),  # a controller may have gone a little too far
                upper=np.maximum(self._kinematics.upper, begin),
                valid=self._collisions.is_free,
                planner=self.options.motion_planner,
                resolution=RESOLUTION,
                iterations=self.options.search,
                seconds=max(0.0, until - time.monotonic()),
                rng=rng,
            )

    def _in_base(self, gripper: FloatArray) -> FloatArray:
        x, y, yaw = gripper.tolist()
        return compose(inverse(self.base_pose.pose), planar_pose(x, y, self.arm.shape.height, yaw))
