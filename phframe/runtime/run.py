"""Carries out a run: from a ``RunSpec`` to an ``Episode``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from typing import Any

from phframe.core import (
    NOBODY,
    Advisor,
    Episode,
    Goal,
    JointTrajectory,
    Options,
    Planner,
    RunSpec,
    Scene,
    TopologyEngine,
)
from phframe.core.run_spec import PARTS
from phframe.registry import Kind, create, identify, load, refuse_stored_code
from phframe.runtime.aids import Aids
from phframe.runtime.confirmation import Confirmation
from phframe.runtime.episode import run_episode
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.mounting import Told, mounted
from phframe.runtime.noise import Noise
from phframe.runtime.observer import Observer
from phframe.runtime.particles import Particles
from phframe.runtime.plan_backend import FITTED, default_plan_backend
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.sensor import Sensor
from phframe.runtime.world import WorldSpec


def run(
    spec: RunSpec,
    observers: Sequence[Observer] = (),
    advisor: Advisor = NOBODY,
) -> Episode:
    """Carry out a run: plan, execute, observe, replan, until the goal is met or there is no reason to try again.

    Args:
        spec: What is run.
        observers: Who looks on; they are closed at the end, also when it is interrupted.
        advisor: Whom the planner may ask; its answers are kept in the episode's decisions.

    Raises:
        PhframeError: If a name, an option or the scene cannot be used. What cannot be planned is a status, not an error.
    """
    with ExitStack() as stack:
        for observer in observers:
            stack.callback(observer.close)
        ready = prepare(mounted(spec, _teller(observers)))
        planning = stack.enter_context(PlanningWorld(ready.plan_world, spec.workers))
        execution = stack.enter_context(ExecutionWorld(ready.world))
        shape = execution.arm.shape
        sensor = Sensor(ready.noise, ready.scene, shape, spec.seed)
        believed, particles = replace(ready.world, scene=ready.plan_world.scene), None
        confirmation = None if believed == ready.plan_world else stack.enter_context(Confirmation(believed))
        if ready.noise != Noise():
            particles = stack.enter_context(Particles(ready.plan_world, ready.noise, shape, spec.seed))
        return run_episode(
            ready.planner,
            ready.topology,
            planning,
            execution,
            ready.goal,
            ready.spec,
            observers,
            sensor,
            Aids(advisor, confirmation, particles),
        )


def _teller(observers: Sequence[Observer]) -> Told:
    def told(done: int, of: int) -> None:
        for observer in observers:
            observer.mounting(done, of)

    return told


@dataclass(frozen=True, slots=True)
class Prepared:
    """A run whose names and options have been looked up.

    Attributes:
        spec: The same run, with registered names wherever there are, both of what to plan with, and as options the values
            that differ from what they would be without: what an episode keeps, and whose ``key`` tells runs apart.
        scene: The scene.
        noise: The figures of what the planner believes against what is true.
        planner: Makes the plans.
        topology: For the planner.
        goal: What is to be achieved.
        world: Where plans are carried out.
        plan_world: Where they are made.
    """

    spec: RunSpec
    scene: Scene
    noise: Noise
    planner: Planner[Any]
    topology: TopologyEngine[Any]
    goal: Goal[Any]
    world: WorldSpec
    plan_world: WorldSpec


def prepare(spec: RunSpec) -> Prepared:
    """Look up all that a run names. Nothing is simulated, and no engine is started.

    Raises:
        PhframeError: If a name, an option or the scene cannot be used.
    """
    scene, noise = find_scene(spec.scene, spec.options.get("scenes")), Noise.of(spec.noise)
    parts = _identified(spec)
    made = {part: create(_kind(part), *parts[part]) for part in ("planner", "topology", "goal")}
    made["planner"].check(scene)
    world = WorldSpec(scene, parts["backend"][0], parts["arm"][0], parts["backend"][1], parts["arm"][1])
    plan_world, inherited = _plan_world(world, parts)
    stored = {part: _differing(_kind(part), *parts[part], {}) for part in PARTS if not part.startswith("plan_")}
    if plan_world != world:
        given = {"plan_backend": plan_world.backend_options, "plan_arm": plan_world.arm_options}
        names = {"plan_backend": plan_world.backend, "plan_arm": plan_world.arm}
        stored |= {part: _differing(_kind(part), names[part], given[part], inherited[part]) for part in given}
    if isinstance(spec.scene, str) and "scenes" in spec.options:
        stored["scenes"] = _differing(Kind.SCENES, spec.scene.partition("/")[0], spec.options["scenes"], {})
    resolved = replace(
        spec,
        **{part: parts[part][0] for part in PARTS if not part.startswith("plan_")},
        plan_backend=plan_world.backend,
        plan_arm=plan_world.arm,
        options=stored,
        noise=noise.model_dump(exclude_defaults=True),
    )
    believed = replace(plan_world, scene=noise.believed(scene, spec.seed))
    return Prepared(resolved, scene, noise, world=world, plan_world=believed, **made)


def _kind(part: str) -> Kind:
    return Kind(part.removeprefix("plan_"))


def _identified(spec: RunSpec) -> dict[str, tuple[Any, Mapping[str, Any]]]:
    """What each part is, and its options as given; None: not given."""
    found = {}
    for part in PARTS:
        value, options = getattr(spec, part), spec.options.get(part, {})
        refuse_stored_code(part, value)
        found[part] = (None, options) if value is None else identify(_kind(part), value, options)
    return found


def _plan_world(
    world: WorldSpec, parts: Mapping[str, tuple[Any, Mapping[str, Any]]]
) -> tuple[WorldSpec, dict[str, Mapping[str, Any]]]:
    """What to plan in, and its options before those given for it: as in execution, where backend or arm is the same."""
    drives_joints = load(Kind.BACKEND, world.backend).executes is JointTrajectory
    backend = parts["plan_backend"][0] or (default_plan_backend() if drives_joints else world.backend)
    arm = parts["plan_arm"][0] or world.arm
    fitted = FITTED.get(backend, {}) if drives_joints and isinstance(backend, str) else {}
    inherited = {
        "plan_backend": world.backend_options if backend == world.backend else fitted,
        "plan_arm": world.arm_options if arm == world.arm else {},
    }
    given = {part: {**inherited[part], **parts[part][1]} for part in inherited}
    planned = replace(
        world, backend=backend, arm=arm, backend_options=given["plan_backend"], arm_options=given["plan_arm"]
    )
    return planned, inherited


def _differing(kind: Kind, part: Any, given: Mapping[str, Any], inherited: Mapping[str, Any]) -> dict[str, Any]:
    """The options of a part that differ from the defaults, or from those that it would have without being given any."""
    loaded = load(kind, part)
    if not isinstance(part, str | type):
        return {}  # an object holds its own
    name = part if isinstance(part, str) else part.__name__
    options, before = (_parsed(loaded.options_type, each, f"{kind} {name}") for each in (given, inherited))
    default = loaded.options_type().model_dump(mode="json")
    return {key: value for key, value in options.items() if value != default[key] or value != before[key]}


def _parsed(options: type[Options], given: Mapping[str, Any], owner: str) -> dict[str, Any]:
    return options.parse(given, owner).model_dump(mode="json")
