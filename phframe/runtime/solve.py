"""One call from a scene to an episode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from phframe.core import NOBODY, Advisor, Episode, Loop, RunSpec, Scene
from phframe.runtime.noise import Noise
from phframe.runtime.observer import Observer
from phframe.runtime.run import run


def solve(
    scene: str | Path | Scene = "vieira/basic",
    *,
    planner: Any = "phia",
    backend: Any = "pymunk",
    arm: Any = "planar",
    topology: Any = "ripser",
    goal: Any = "retrieve",
    seed: int = 0,
    options: Mapping[str, Mapping[str, Any]] | None = None,
    time_limit: float = 300.0,
    max_replans: int = 30,
    tolerance: float = 0.01,
    simulations: int | None = None,
    workers: int = 1,
    plan_backend: Any = None,
    plan_arm: Any = None,
    noise: str | Mapping[str, Any] | None = None,
    observers: Sequence[Observer] = (),
    advisor: Advisor = NOBODY,
) -> Episode:
    """Take the target out of a shelf: plan, carry out, observe, replan, grasp, withdraw.

    The arguments are the fields of a ``RunSpec``, those of its ``Loop`` among them; the same with ``run``.

    Args:
        scene: ``suite/name``, a scene file, or a scene.
        planner: Registered name, a file and a class (``./mine.py:Mine``), a class, or an object.
        backend: What executes, as ``planner``, but for objects.
        arm: What executes, as ``planner``.
        topology: For persistence diagrams, as ``planner``.
        goal: What is to be achieved, as ``planner``.
        seed: Of everything random; the same seed gives the same episode.
        options: By ``planner``, ``backend``, ``arm``, ``plan_backend``, ``plan_arm``, ``topology``, ``goal`` and
            ``scenes``, then by key; values or their text.
        time_limit: Wall time for planning, replans included (s); looked at between simulations.
        max_replans: How often to plan again where reality differs, or an action cannot be carried out.
        tolerance: What counts as differing (m).
        simulations: Simulated actions for planning, replans included; None: no limit.
        workers: Processes for planners that try many actions at once.
        plan_backend: Where to plan; None: where ``backend`` drives joints in ``fast`` if installed, else in pymunk; for others in
            ``backend``.
        plan_arm: The arm to plan with; None: ``arm``.
        noise: By how much what the planner believes differs from what is true: ``position`` (m) and ``friction``
            (relative), standard deviations, as a mapping or as text such as ``position=0.005,friction=0.3``.
        observers: Who looks on; they are closed at the end, also when it is interrupted.
        advisor: Whom the planner may ask, if it is one that asks.

    Raises:
        PhframeError: If a name, an option or the scene cannot be used. What cannot be planned is a status, not an error.
    """
    try:
        spec = RunSpec(
            scene,
            planner,
            backend,
            arm,
            plan_backend,
            plan_arm,
            topology,
            goal,
            {} if options is None else options,
            seed,
            Loop(max_replans, tolerance, time_limit, simulations),
            Noise.of(noise).model_dump(exclude_defaults=True),
            workers,
        )
    except BaseException:
        for observer in observers:
            observer.close()
        raise
    return run(spec, observers, advisor)
