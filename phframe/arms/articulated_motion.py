"""Lifts paths of the gripper to the joints of an arm: followed in the shelf, on free ways outside of it."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Iterator
from itertools import cycle, islice
from typing import TYPE_CHECKING

import numpy as np

from phframe.arms.articulated_options import ArticulatedOptions
from phframe.arms.coal_ import CollisionModel
from phframe.arms.follow import Follower
from phframe.arms.joint_path import joint_path, require_planner
from phframe.arms.posture import Posture
from phframe.arms.route import Route, Router
from phframe.arms.schedule import Scheduler
from phframe.arms.skin import Skin
from phframe.arms.stretch import free_way, legs_of
from phframe.arms.track import Tracker
from phframe.arms.waypoints import Waypoints, waypoints
from phframe.core import (
    FloatArray,
    GripperPath,
    JointTrajectory,
    MotionPlanner,
    Mount,
    Scene,
    State,
    Unreachable,
    compose,
    inverse,
    planar_pose,
    yaw_of,
)

if TYPE_CHECKING:
    from phframe.arms.articulated import ArticulatedArm

SAME_POSITION, SAME_YAW = 5e-3, 0.03
"""A path that begins no farther than this (m, rad) from where the gripper is goes on from there."""
ALIKE = 0.2
"""Postures that differ by less than this in every joint (rad or m) are tried once."""
IMPROVEMENTS = 20
"""Of a posture before it is tried."""
DESCENTS = 15
"""Random starting points for every posture that may be tried."""
WIDE = 0.01
"""A route on which the arm is wider than described by no more than this (m) is taken at once."""
RESOLUTION = 0.03
"""Most that a joint moves between two configurations of a free way that are looked at (rad or m)."""

ROUGHLY = 3
"""Every how many of its poses a route is looked at before it is made."""
YAW_STEPS = tuple(math.radians(degrees) for degrees in (5.0, 10.0, 15.0))
"""How far the gripper may be turned against a path in the shelf, for want of a route at the path's own yaw (rad)."""
TURNED = 3
"""Of so many postures, those that went farthest."""
OUT_OF_REACH = Unreachable(0.0, "no posture has the gripper on the path", 0)
UNAPPROACHABLE = Unreachable(0.0, "no free way leads to where the path goes in", 0)

Anchored = tuple[FloatArray, int]
"""Joint values ``(dof,)``, and the row of the pose that they stand for."""


class ArticulatedMotionPlanner(MotionPlanner[ArticulatedOptions]):
    """Follows paths with any arm that is given by a URDF and a description.

    In the shelf, joints follow the path at constant height, continuously and in a posture that is as narrow behind the
    gripper as can be; the gripper turns away from the path's yaw only where the fingers are less than 5 cm in the shelf.
    From where the arm is to where its way in begins, OMPL plans.

    Raises:
        UnknownNameError: If there is no such planner.
        NotInstalledError: If OMPL is not installed.
    """

    options_type = ArticulatedOptions

    def __init__(self, scene: Scene, arm: ArticulatedArm, mount: Mount, options: ArticulatedOptions) -> None:
        super().__init__(scene, arm, mount, options)
        require_planner(options.motion_planner)
        self._described, self._kinematics = arm.description, arm.kinematics
        skin = Skin(self._kinematics, arm.robot, self._described.joints, arm.tip_link, mount, scene.shelf.depth)
        self._posture = Posture(self._kinematics, skin, self._described.behind, scene.shelf)
        self._follower = Follower(self._kinematics, self._posture)
        names, apart = self._described.joints, self._described.overlapping
        self._collisions = CollisionModel(arm.urdf(), names, self._described.fingers, apart, scene, mount)
        self._tracker = Tracker(self._follower, self._collisions, mount, arm, scene)
        self._scheduler = Scheduler(arm, mount, options)

    def plan(
        self, path: GripperPath, state: State, *, attempts: int, seconds: float, rng: np.random.Generator
    ) -> JointTrajectory | Unreachable:
        """Lift a path.

        Postures are tried until one is narrow enough, the least wide of them is taken after so many attempts.
        """
        self._tracker.place(state)
        begin, opening = self._where(state)
        line = waypoints(path)
        router = Router(path, line, self._tracker)
        if self._goes_on(begin, path):
            route = router.onwards(begin)
            if isinstance(route, Unreachable):
                return route
            return self._scheduler.trajectory([*legs_of(route, path, opening)])
        return self._approached(path, router, line, begin, opening, attempts, time.monotonic() + seconds, rng)

    def _where(self, state: State) -> tuple[FloatArray, float]:
        """Joint values ``(dof,)`` and commanded opening (m)."""
        if state.arm is None:
            return self.arm.home, self.arm.shape.min_opening
        joints = state.arm.joints
        if joints is None:
            found = self.arm.inverse(self._in_base(state.arm.gripper), self.arm.home)
            joints = self.arm.home if found is None else found
        return joints, state.arm.commanded_opening

    def _goes_on(self, begin: FloatArray, path: GripperPath) -> bool:
        """Whether a path begins where the gripper is."""
        pose = compose(self.mount.pose, self.arm.forward(begin))
        x, y, yaw = path.poses[0].tolist()
        near = np.hypot(pose[0] - x, pose[1] - y) < SAME_POSITION
        return bool(near and abs(np.remainder(yaw_of(pose) - yaw + np.pi, 2.0 * np.pi) - np.pi) < SAME_YAW)

    def _approached(
        self,
        path: GripperPath,
        router: Router,
        line: Waypoints,
        begin: FloatArray,
        opening: float,
        attempts: int,
        until: float,
        rng: np.random.Generator,
    ) -> JointTrajectory | Unreachable:
        """The way to where a path's route begins, and the route: the first that is narrow, else the narrowest."""
        best: tuple[float, FloatArray, Route] | None = None
        failed: list[tuple[Unreachable, Anchored]] = []
        for stage in (
            lambda: self._routes(router, self._known_postures(router, line, begin), failed),
            lambda: self._turned_routes(router, failed),
            lambda: self._routes(router, islice(self._chance_postures(router, line, attempts, rng), attempts), failed),
        ):
            for route, anchored in stage():
                excess = self._excess(route)
                if best is not None and excess >= best[0]:
                    continue
                way = self._free_way(begin, route.joints[0], rng)
                if way is None:
                    failed.append((UNAPPROACHABLE, anchored))
                    continue
                best = excess, way, route
                if excess <= WIDE or time.monotonic() > until:
                    break
            if best is not None or time.monotonic() > until:
                break
        if best is None:
            return max((end for end, _ in failed), key=lambda end: end.where, default=OUT_OF_REACH)
        first = path.rules[path.phases[0]].opening
        return self._scheduler.trajectory([*free_way(best[1], opening, first), *legs_of(best[2], path, first)])

    def _routes(
        self, router: Router, postures: Iterable[Anchored], failed: list[tuple[Unreachable, Anchored]]
    ) -> Iterator[tuple[Route, Anchored]]:
        """Routes through different postures, at the path's own yaw."""
        for anchored in postures:
            route = self._route(router, anchored, 0.0)
            if isinstance(route, Unreachable):
                failed.append((route, anchored))
            else:
                yield route, anchored

    def _turned_routes(
        self, router: Router, failed: list[tuple[Unreachable, Anchored]]
    ) -> Iterator[tuple[Route, Anchored]]:
        """Routes turned against the path, through the postures that got farthest without that."""
        for ending, anchored in sorted(failed, key=lambda one: -one[0].where)[:TURNED]:
            for yaw in _turns(ending):
                route = self._route(router, anchored, yaw)
                if isinstance(route, Route):
                    yield route, anchored

    def _route(self, router: Router, anchored: Anchored, yaw: float) -> Route | Unreachable:
        """The route through a posture, looked at roughly before it is made."""
        q, row = anchored
        rough = router.through(q, row, yaw, ROUGHLY)
        return rough if isinstance(rough, Unreachable) else router.through(q, row, yaw, 1)

    def _known_postures(self, router: Router, line: Waypoints, begin: FloatArray) -> Iterator[Anchored]:
        """At the gate: near the described ones, where the arm is, and home."""
        seeds = [*map(np.array, self._described.postures), begin, self.arm.home]
        return self._postures(line, ((seed, router.gate) for seed in seeds))

    def _chance_postures(
        self, router: Router, line: Waypoints, attempts: int, rng: np.random.Generator
    ) -> Iterator[Anchored]:
        """By chance, at the gate and where the path is deepest."""
        rows = cycle((router.deepest, router.gate))
        lower, upper = self._kinematics.lower, self._kinematics.upper
        return self._postures(line, ((rng.uniform(lower, upper), next(rows)) for _ in range(DESCENTS * attempts)))

    def _postures(self, line: Waypoints, seeds: Iterable[Anchored]) -> Iterator[Anchored]:
        """Different postures for poses of the line, by descent from seeds, at their best."""
        found: list[Anchored] = []
        for seed, row in seeds:
            pose = line.poses[row]
            q = self._kinematics.descend(self._in_base(pose), seed)
            if q is None or any(at == row and float(np.abs(q - other).max()) < ALIKE for other, at in found):
                continue
            found.append((q, row))
            improved = self._follower.improved(q, self._tracker.target(pose), pose, IMPROVEMENTS)
            if improved is not None:
                yield improved, row

    def _free_way(self, begin: FloatArray, end: FloatArray, rng: np.random.Generator) -> FloatArray | None:
        """Corners ``(k, dof)`` of a way on which nothing is touched but what is touched at its begin."""
        self._collisions.allow([])
        with self._collisions.tolerating(begin):
            return joint_path(
                begin,
                end[None],
                lower=self._kinematics.lower,
                upper=self._kinematics.upper,
                valid=self._collisions.is_free,
                planner=self.options.motion_planner,
                resolution=RESOLUTION,
                iterations=self.options.search,
                rng=rng,
            )

    def _excess(self, route: Route) -> float:
        """The most by which the arm is wider on a route than it is described (m)."""
        every = zip(route.joints[::4], route.poses[::4], strict=True)
        return max(self._posture.excess(q, pose) for q, pose in every)

    def _in_base(self, gripper: FloatArray) -> FloatArray:
        x, y, yaw = gripper.tolist()
        return compose(inverse(self.mount.pose), planar_pose(x, y, self.arm.shape.height, yaw))


def _turns(ending: Unreachable) -> Iterator[float]:
    """Yaws to try where a route ends (rad), least first: away from a wall."""
    signs = (1.0,) if "north wall" in ending.bodies else (-1.0,) if "south wall" in ending.bodies else (1.0, -1.0)
    for step in YAW_STEPS:
        yield from (sign * step for sign in signs)
