"""The world that plans are carried out in: it goes on from where it is, as a real robot does."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from phframe.core import Action, Motion, State, Trajectory, Unreachable, Watch
from phframe.runtime.world import World


class ExecutionWorld(World):
    """Executes one trajectory after another."""

    def start(self) -> State:
        """Put the world in the scene's initial state."""
        return self.physics.restore(self.scene.initial_state())

    def execute(self, trajectory: Trajectory, watch: Watch | None = None) -> Motion:
        """Follow a trajectory from where the world is."""
        return self.follow(trajectory, watch)

    def plan_trajectory(self, state: State, action: Action) -> Trajectory | Unreachable:
        """As every world; where no motion planner says so, once the arm is known to reach each of the path's poses."""
        if self.by_joints:
            return super().plan_trajectory(state, action)
        return self._refuse_pose(action) or super().plan_trajectory(state, action)

    def unreachable(self, state: State, action: Action) -> Unreachable | None:
        """Why the arm cannot carry out an action from a state; None: it can."""
        planned = self.plan_trajectory(state, action)
        return planned if isinstance(planned, Unreachable) else None

    def out_of_reach(self, state: State, object_id: str) -> Unreachable | None:
        """Why joints that are driven can have an object grasped where it stands at no yaw, even in an empty shelf."""
        if not self.by_joints:
            return None
        found = self.arm.out_of_reach(self.scene, state, self.base_pose, object_id)
        if found is None:
            return None
        remedy = (
            ""
            if self.arm.mount is not None
            else "; with --option arm.mount=auto the base stands where it can, if anywhere"
        )
        why = f"arm {self.spec.arm!r} gets there at no yaw, even in an empty shelf ({found.why}){remedy}"
        return replace(found, why=why)

    def _refuse_pose(self, action: Action) -> Unreachable | None:
        """Where the arm's joints cannot take the fingertip, if anywhere."""
        way, seed = 0.0, self.arm.home
        for leg, pose in enumerate(action.path.poses):
            if leg:
                way += float(np.hypot(*(action.path.poses[leg, :2] - action.path.poses[leg - 1, :2])))
            joints = self.arm.inverse(self.arm.fingertip_pose(pose, self.base_pose), seed)
            if joints is None:
                x, y, yaw = pose.tolist()
                where = f"({x:.3f}, {y:.3f}) m, yaw {np.degrees(yaw):.0f} degrees"
                return Unreachable(way, f"arm {self.spec.arm!r} does not reach {where}", leg)
            seed = joints
        return None

    def observe(self) -> State:
        """The world as it is now."""
        return self.physics.observe()
