"""What planning the joint trajectories of a plan takes with a real arm: for each action, and for the whole plan."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import Any

from phframe.bench.meters.tasks import retrieval_task
from phframe.core import ArmState, JointTrajectory, Plan, State, Unreachable
from phframe.registry import Kind, create
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec

ARM = "baxter"


@dataclass(frozen=True, slots=True)
class MotionPlanning:
    """Of one scene's plan.

    Attributes:
        scene: Its name.
        planning: Wall time of the planner (s).
        actions: Wall time of motion planning for each action, in order (s).
        unreachable: How many of them the arm cannot do.
    """

    scene: str
    planning: float
    actions: tuple[float, ...]
    unreachable: int

    @property
    def total(self) -> float:
        """Wall time of the plan and of all its trajectories (s)."""
        return self.planning + sum(self.actions)


def measure_motion_planning(name: str, backend: str) -> MotionPlanning:
    """Plan with PHIA in pymunk, then plan a joint trajectory for each action, from where the plan expects the world to be."""
    scene = find_scene(name)
    with PlanningWorld(WorldSpec(scene, "pymunk", ARM)) as planning:
        task = retrieval_task(planning)
        began = time.perf_counter()
        plan = create(Kind.PLANNER, "phia").plan(task)
        spent = time.perf_counter() - began
    with ExecutionWorld(WorldSpec(scene, backend, ARM)) as world:
        times, unreachable = _joint_trajectories(world, scene.initial_state(), plan)
    return MotionPlanning(name, spent, times, unreachable)


def _joint_trajectories(world: ExecutionWorld, state: State, plan: Plan) -> tuple[tuple[float, ...], int]:
    times, unreachable, arm = [], 0, None
    for action, expected in zip(plan.actions, plan.expected, strict=True):
        began = time.perf_counter()
        trajectory: Any = world.plan_trajectory(replace(state, held=None, arm=arm), action)
        times.append(time.perf_counter() - began)
        if isinstance(trajectory, Unreachable):
            unreachable += 1
        else:
            arm = _arm_after(trajectory)
        state = expected
    return tuple(times), unreachable


def _arm_after(trajectory: JointTrajectory) -> ArmState:
    gripper = trajectory.gripper
    opening = float(gripper.openings[-1])
    return ArmState(gripper.poses[-1], opening, opening, trajectory.positions[-1])
