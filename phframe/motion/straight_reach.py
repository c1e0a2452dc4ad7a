"""Straight reaches: whether an arm's fingertip gets to a place straight in through the mouth of an empty shelf."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from phframe.core import (
    ArmModel,
    BasePose,
    GripperPath,
    Shelf,
    State,
    Unreachable,
)
from phframe.geometry.arm_view import ArmView
from phframe.motion.budget import SearchBudget
from phframe.motion.cartesian_following import CartesianFollower
from phframe.motion.cartesian_path import CartesianPathFollower, JointPath
from phframe.motion.cartesian_waypoints import waypoints
from phframe.motion.coal_ import CollisionModel
from phframe.motion.collision_checking import CollisionContext
from phframe.motion.configuration_search import ConfigurationSearch
from phframe.motion.differential_ik import DifferentialIK
from phframe.motion.null_space_objective import NullSpaceObjective
from phframe.motion.options import ArticulatedOptions
from phframe.motion.pinocchio_ import Kinematics
from phframe.motion.straight_way import YAWS, straight_way, way_length
from phframe.motion.surface_points import SurfacePoints
from phframe.urdf.description import ArmDescription
from phframe.urdf.model import Robot

ROUGHLY = 6
"""Every how many waypoints a way in is looked at where many are."""
PAST, ROOM = 0.004, 0.003
"""The least by which a grasp's fingertips go past the middle of its object, and the least room beside it (m)."""
ATTEMPTS = 3
"""Configurations that are tried at random at each yaw before an object counts as out of reach."""
SHORT = 1e-6
"""By which a way ends before a wall that is in it (m)."""
EMPTY = State(np.empty((0, 7)), ())
"""Of a shelf in which nothing stands."""


class StraightReach:
    """Straight ways into an empty shelf, from one base pose.

    The fingertip goes straight ahead at constant height, the gripper level, along its yaw. A way is free where the arm's
    outlines pass between the walls, and joints follow it continuously from one of the arm's seed configurations with
    no link touching another, a wall, the board or the ceiling.

    Args:
        shelf: The shelf.
        arm: The arm.
        base_pose: Where its base stands.
        description: Of the arm.
        robot: Its links.
        kinematics: Of the chain from its base to the fingertip.
        options: Of the arm.
    """

    def __init__(
        self,
        shelf: Shelf,
        arm: ArmModel[Any],
        base_pose: BasePose,
        description: ArmDescription,
        robot: Robot,
        kinematics: Kinematics,
        options: ArticulatedOptions,
    ) -> None:
        self._shape, self._kinematics, self._spacing = arm.shape, kinematics, options.cartesian_spacing
        surface = SurfacePoints(kinematics, robot, description.joints, arm.tip_link, base_pose, shelf.depth)
        self._objective = NullSpaceObjective(kinematics, surface, description.behind, shelf)
        self._seeds = [*(np.array(seed) for seed in description.seed_configurations), arm.home]
        ik = DifferentialIK(kinematics, self._objective, np.empty((0, 4)))
        collisions = CollisionModel(arm, description, shelf, (), base_pose, options.wall_margin, 0.0)

        @cache  # over no method: what it keeps must not keep this object, or the engine's memory comes back late
        def follower(opening: float) -> CartesianFollower:
            checker = collisions.checker(CollisionContext(EMPTY, opening))
            return CartesianFollower(ik, checker, base_pose, arm.shape.height, description.joints)

        self._follower = follower
        self._view = cache(lambda opening: ArmView(shelf, arm.shape.outlines(opening), options.wall_margin))

    def yaws(self, place: Sequence[float], opening: float, stride: int = ROUGHLY) -> tuple[float, ...]:
        """Those of ``YAWS`` (rad) at which the way to a place is free; arguments as for ``way``."""
        return tuple(yaw for yaw in YAWS if isinstance(self.way(place, yaw, opening, stride), JointPath))

    def way(
        self,
        place: Sequence[float],
        yaw: float,
        opening: float,
        stride: int = ROUGHLY,
        attempts: int = 0,
        *,
        back: bool = False,
    ) -> JointPath | Unreachable:
        """Joints for the way in to a place at a yaw, or how far they get, and why no farther.

        Args:
            place: Where the fingertip is to be: x, y in the shelf frame (m).
            yaw: Of the gripper (rad).
            opening: Distance between the fingers on the way (m).
            stride: Every how many waypoints is looked at.
            attempts: Configurations to be tried at random where none of the seeds leads there.
            back: Whether the same joints must also take the gripper out of the shelf again.
        """
        path = straight_way(self._view(opening), place, yaw, opening, back=back)
        if isinstance(path, Unreachable):
            return path
        if not attempts and not self._can_end(self._follower(opening).target(path.poses[1])):
            return Unreachable(0.0, "out of reach: inverse kinematics finds no joint values for the end of the way", 0)
        return self._followed(path, stride, attempts)

    def grasp_yaws(
        self, position: Sequence[float], radius: float, stride: int = ROUGHLY, *, back: bool = False
    ) -> tuple[float, ...]:
        """Those of ``YAWS`` (rad) at which the way to a grasp is free; arguments as for ``grasp``."""
        return tuple(yaw for yaw in YAWS if isinstance(self.grasp(position, radius, yaw, stride, back=back), JointPath))

    def grasp(
        self,
        position: Sequence[float],
        radius: float,
        yaw: float,
        stride: int = ROUGHLY,
        attempts: int = 0,
        *,
        back: bool = False,
    ) -> JointPath | Unreachable:
        """The way to a grasp of an object, as ``way``.

        Args:
            position: Of the object (m).
            radius: Of the object (m).
            yaw: Of the gripper (rad).
            stride: As for ``way``.
            attempts: As for ``way``.
            back: As for ``way``.
        """
        place = position[0] + PAST * math.cos(yaw), position[1] + PAST * math.sin(yaw)
        opening = min(max(2.0 * (radius + ROOM), self._shape.min_opening), self._shape.max_opening)
        return self.way(place, yaw, opening, stride, attempts, back=back)

    def out_of_reach(self, position: Sequence[float], radius: float) -> Unreachable | None:
        """Why an object can be grasped at none of ``YAWS`` in an empty shelf: how far that gets at best; None: it can."""
        endings = []
        for yaw in YAWS:
            ending = self.grasp(position, radius, yaw)
            if isinstance(ending, JointPath):
                return None
        for yaw in YAWS:
            ending = self.grasp(position, radius, yaw, attempts=ATTEMPTS)
            if isinstance(ending, JointPath):
                return None
            endings.append(ending)
        return max(endings, key=lambda ending: ending.where)

    def depth(self, across: float, opening: float, deepest: float) -> float:
        """How deep (m, at most ``deepest``) the fingertip gets straight ahead at yaw 0 with its y at ``across`` (m)."""
        view = self._view(opening)
        start = deepest - way_length(view, (deepest, across), 0.0)
        path = straight_way(view, (deepest, across), 0.0, opening)
        if isinstance(path, Unreachable):
            deepest = start + path.where - SHORT
            path = straight_way(view, (deepest, across), 0.0, opening)
        if isinstance(path, Unreachable):
            return start
        found = self._followed(path, ROUGHLY, 0)
        return deepest if isinstance(found, JointPath) else start + found.where - ROUGHLY * self._spacing

    def _followed(self, path: GripperPath, stride: int, attempts: int) -> JointPath | Unreachable:
        """Joints for a path."""
        follower = self._follower(path.rule(0).opening)
        paths = CartesianPathFollower(path, waypoints(path, self._spacing), self._spacing, lambda _: follower)
        search = ConfigurationSearch(paths, self._kinematics, self._objective, 0.0, SearchBudget(1, math.inf))
        found = search.first(self._seeds, stride)
        if found is None and attempts:
            found = next(search.joint_paths((), attempts, np.random.default_rng(0)), None)
        return search.farthest if found is None else found

    def _can_end(self, target: Any) -> bool:
        return any(self._kinematics.descend_to(target, seed) is not None for seed in self._seeds)
