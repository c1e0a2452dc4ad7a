"""One call from a scene to an episode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

from phframe.core import Episode, JointTrajectory, Loop, OptionError, Scene, Setup
from phframe.registry import Kind, create, load
from phframe.runtime.episode import run_episode
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.noise import Noise
from phframe.runtime.observer import Observer
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.sensor import Sensor
from phframe.runtime.versions import versions
from phframe.runtime.world import WorldSpec

PLAN_BACKEND = "pymunk"
"""Where plans are made that an engine of joints carries out: many times faster."""
PLAN_OPTIONS = {"standing_radius": 2.0 / 3.0, "arm_acceleration": 10.0}
"""Of that backend, where an engine in space carries the plans out; see docs/fidelity.md."""
OPTION_GROUPS = ("planner", "backend", "arm", "plan_backend", "plan_arm", "topology", "goal", "scenes")
"""Whose options ``solve`` takes."""


def solve(
    scene: str | Path | Scene = "vieira/basic",
    *,
    planner: str = "phia",
    backend: str = "pymunk",
    arm: str = "planar",
    topology: str = "ripser",
    goal: str = "retrieve",
    seed: int = 0,
    options: Mapping[str, Mapping[str, Any]] | None = None,
    time_limit: float = 300.0,
    max_replans: int = 30,
    tolerance: float = 0.01,
    simulations: int | None = None,
    workers: int = 1,
    plan_backend: str | None = None,
    plan_arm: str | None = None,
    noise: str | Mapping[str, Any] | None = None,
    observers: Sequence[Observer] = (),
) -> Episode:
    """Take the target out of a shelf: plan, carry out, observe, replan, grasp, withdraw.

    Args:
        scene: ``suite/name``, a scene file, or a scene.
        planner: Registered name, or a file and a class: ``./mine.py:Mine``.
        backend: Registered name of the physics engine to execute in.
        arm: Registered name of the arm that executes.
        topology: Registered name of the engine for persistence diagrams.
        goal: Registered name of what is to be achieved.
        seed: Of everything random; the same seed gives the same episode.
        options: By ``planner``, ``backend``, ``arm``, ``plan_backend``, ``plan_arm``, ``topology`` and ``scenes``, then
            by key; values or their text.
        time_limit: Wall time for planning, replans included (s); looked at between simulations.
        max_replans: How often to plan again where reality differs, or an action cannot be carried out.
        tolerance: What counts as differing (m).
        simulations: Simulated actions for planning, replans included; None: no limit.
        workers: Processes for planners that try many actions at once.
        plan_backend: Registered name of the physics engine to plan in; None: pymunk where ``backend`` drives joints,
            else ``backend``.
        plan_arm: Registered name of the arm to plan with; None: ``arm``.
        noise: By how much what the planner believes differs from what is true: ``position`` (m) and ``friction``
            (relative), standard deviations, as a mapping or as text such as ``position=0.005,friction=0.3``.
        observers: Who looks on; they are closed at the end, also when it is interrupted.

    Raises:
        PhframeError: If a name, an option or the scene cannot be used. What cannot be planned is a status, not an error.
    """
    with ExitStack() as stack:
        for observer in observers:
            stack.callback(observer.close)
        disturbance = Noise.of(noise)
        given, loop = _by_group(options or {}), Loop(max_replans, tolerance, time_limit, simulations)
        if not seed >= 0 or seed != int(seed):
            raise OptionError(f"a seed is a whole number of 0 or more, not {seed!r}")
        spec = WorldSpec(find_scene(scene, given["scenes"]), backend, arm, given["backend"], given["arm"])
        plan_spec = _plan_spec(spec, plan_backend, plan_arm, given)
        search = create(Kind.PLANNER, planner, given["planner"])
        engine = create(Kind.TOPOLOGY, topology, given["topology"])
        wanted = create(Kind.GOAL, goal, given["goal"])
        believed = replace(plan_spec, scene=disturbance.believed(spec.scene, seed))
        planning = stack.enter_context(PlanningWorld(believed, workers))
        execution = stack.enter_context(ExecutionWorld(spec))
        used = {
            "planner": search,
            "backend": execution.physics,
            "arm": execution.arm,
            "topology": engine,
            "goal": wanted,
        }
        if plan_spec != spec:
            used |= {"plan_backend": planning.physics, "plan_arm": planning.arm}
        setup = Setup(
            planner,
            backend,
            arm,
            topology,
            seed,
            _differing(used),
            loop,
            versions(backend, plan_spec.backend, topology),
            plan_spec.backend if plan_spec.backend != backend else None,
            plan_spec.arm if plan_spec.arm != arm else None,
            disturbance.model_dump(exclude_defaults=True),
        )
        sensor = Sensor(disturbance, spec.scene, execution.arm.shape, seed)
        return run_episode(search, engine, planning, execution, wanted, setup, loop, observers, sensor)


def _plan_spec(
    spec: WorldSpec, backend: str | None, arm: str | None, given: Mapping[str, Mapping[str, Any]]
) -> WorldSpec:
    """What to plan in. Where backend or arm is that of the execution, so are its options, unless others are given."""
    drives_joints = load(Kind.BACKEND, spec.backend).executes is JointTrajectory
    backend, arm = backend or (PLAN_BACKEND if drives_joints else spec.backend), arm or spec.arm
    fitted = PLAN_OPTIONS if drives_joints and backend == PLAN_BACKEND else {}
    return replace(
        spec,
        backend=backend,
        arm=arm,
        backend_options={**(spec.backend_options if backend == spec.backend else fitted), **given["plan_backend"]},
        arm_options={**(spec.arm_options if arm == spec.arm else {}), **given["plan_arm"]},
    )


def _differing(parts: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """The options of parts that differ from the defaults, by part and key."""
    dumped = {name: part.options.model_dump(mode="json", exclude_defaults=True) for name, part in parts.items()}
    return {name: options for name, options in dumped.items() if options}


def _by_group(options: Any) -> dict[str, dict[str, Any]]:
    """The options of each group, as they were given.

    Raises:
        OptionError: If they are not mappings from text, or a group does not exist.
    """
    groups = {"": options, **options} if isinstance(options, Mapping) else {"": options}
    for group, given in groups.items():
        if not (isinstance(given, Mapping) and all(isinstance(key, str) for key in given)):
            raise OptionError(f"options{f' of {group!r}' if group else ''} must be a mapping by name, not {given!r}")
        if group and group not in OPTION_GROUPS:
            raise OptionError(f"there are no options of {group!r}; there are those of: {', '.join(OPTION_GROUPS)}")
    return {group: dict(options.get(group, {})) for group in OPTION_GROUPS}
