"""The conformance checks over everything that is registered and installed here: one test for each check and extension."""

from __future__ import annotations

from functools import cache
from itertools import product
from typing import Any

import pytest

from phframe.core import (
    Cylinder,
    GripperTrajectory,
    IncompatibleError,
    JointTrajectory,
    NotInstalledError,
    Scene,
    SceneObject,
    Shelf,
    motion_planner_of,
)
from phframe.registry import Kind, catalogue, create, load
from phframe.testing import (
    ARM_CHECKS,
    GOAL_CHECKS,
    JOINTED,
    PHYSICS_CHECKS,
    PLANAR,
    PLANNER_CHECKS,
    SPATIAL,
    TOPOLOGY_CHECKS,
    ArmUnderTest,
    Check,
    EngineUnderTest,
    GoalUnderTest,
    NotApplicableError,
    PhysicsUnderTest,
    PlannerUnderTest,
    order_of_objects_does_not_matter,
    simulated_tasks,
)

DETERMINISTIC = ("phia", "ooa", "phis", "phim")
"""Planners that promise that the order of objects does not matter."""

BRIEFLY = {
    "grtc-kinodynamic": {"controls": 20, "reach_controls": 150, "attempts": 1},
    "kinodynamic-rrt": {"actions": 4, "max_iterations": 5},
}
"""Options with which planners that simulate by the thousand are checked, so that they end soon."""

NEEDS = {
    "grtc-kinodynamic": pytest.mark.needs_ompl,
    "fast": pytest.mark.needs_fast,
    "mujoco": pytest.mark.needs_mujoco,
    "pybullet": pytest.mark.needs_pybullet,
    "baxter": pytest.mark.needs_baxter,
    "articulated": pytest.mark.needs_baxter,
}
"""Backends and arms that come with an extra."""

ARMS_OF_JOINTS = ("baxter", "articulated")
UNSUITED = {
    ("baxter", "sliding_objects_stop_where_friction_says"): "its fingers do not close, and an object sits between them",
    (
        "baxter",
        "what_leaves_at_the_mouth_has_spilled",
    ): "with all joints straight to where it begins, a finger meets the board",
    (
        "baxter in fast",
        "sliding_objects_stop_where_friction_says",
    ): "an object sits between its fingers, and leaves them within a step or two of where it stops",
    (
        "baxter in pybullet",
        "a_load_too_heavy_stalls_the_arm",
    ): "pushed 0.10 m above the board, the load topples below the limit",
    (
        "articulated in mujoco",
        "sliding_objects_stop_where_friction_says",
    ): "it brakes with 3 m/s^2, less than friction does: it never lets go of the object",
}
"""What an arm cannot be checked on in space, and why; what it cannot reach, or not as fast, it says itself."""


SHELF_SCENE = Scene("shelf", Shelf(0.5, 0.6), (SceneObject("t", Cylinder(0.03), (0.3, 0.3)),), "t")


def names(kind: Kind) -> list[str]:
    return [entry.name for entry in catalogue().extensions(kind)]


def each_check(checks: tuple[Check[Any], ...]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("check", checks, ids=lambda check: check.name)


def run(check: Check[Any], subject: object) -> None:
    try:
        check(subject)
    except NotApplicableError as reason:
        pytest.skip(str(reason))


def made(kind: Kind, name: str) -> Any:
    try:
        return create(kind, name, BRIEFLY.get(name))
    except NotInstalledError as error:
        pytest.skip(str(error))


@cache
def physics(backend: str, arm: str) -> PhysicsUnderTest:
    loaded = load(Kind.BACKEND, backend)
    in_space = JOINTED if arm in ARMS_OF_JOINTS else SPATIAL
    tolerances = PLANAR if loaded.executes is GripperTrajectory else in_space
    options, model = loaded.options_type(), create(Kind.ARM, arm)
    if loaded.executes is JointTrajectory:  # says in one line which arms can, where this one cannot
        motion_planner_of(model, SHELF_SCENE, model.default_base_pose(SHELF_SCENE.shelf))
    return PhysicsUnderTest(
        lambda scene, carrier, base_pose: loaded(scene, carrier, base_pose, options),
        model,
        tolerances,
        name=backend,
    )


@each_check(PHYSICS_CHECKS)
@pytest.mark.parametrize(
    ("backend", "arm"),
    [
        pytest.param(backend, arm, marks=[NEEDS[name] for name in (backend, arm) if name in NEEDS])
        for backend, arm in product(names(Kind.BACKEND), names(Kind.ARM))
    ],
)
def test_physics(backend: str, arm: str, check: Check[PhysicsUnderTest]) -> None:
    for pair in ((arm, check.name), (f"{arm} in {backend}", check.name)):
        if pair in UNSUITED and (backend not in ("pymunk", "fast") or pair[0] != arm):
            pytest.skip(UNSUITED[pair])
    try:
        subject = physics(backend, arm)
    except (NotInstalledError, IncompatibleError) as error:
        pytest.skip(str(error))
    run(check, subject)


@each_check(ARM_CHECKS)
@pytest.mark.parametrize("arm", [pytest.param(arm, marks=NEEDS.get(arm, ())) for arm in names(Kind.ARM)])
def test_arm(arm: str, check: Check[ArmUnderTest]) -> None:
    run(check, ArmUnderTest(made(Kind.ARM, arm)))


@each_check(TOPOLOGY_CHECKS)
@pytest.mark.parametrize("engine", names(Kind.TOPOLOGY))
def test_topology(engine: str, check: Check[EngineUnderTest]) -> None:
    run(check, EngineUnderTest(made(Kind.TOPOLOGY, engine)))


@each_check(GOAL_CHECKS)
@pytest.mark.parametrize("goal", names(Kind.GOAL))
def test_goal(goal: str, check: Check[GoalUnderTest]) -> None:
    run(check, GoalUnderTest(made(Kind.GOAL, goal)))


@each_check(PLANNER_CHECKS)
@pytest.mark.parametrize("planner", [pytest.param(name, marks=NEEDS.get(name, ())) for name in names(Kind.PLANNER)])
def test_planner(planner: str, check: Check[PlannerUnderTest]) -> None:
    run(check, PlannerUnderTest(made(Kind.PLANNER, planner), simulated_tasks()))


@pytest.mark.parametrize("planner", DETERMINISTIC)
def test_the_order_of_objects_does_not_matter(planner: str) -> None:
    run(order_of_objects_does_not_matter, PlannerUnderTest(made(Kind.PLANNER, planner), simulated_tasks()))
