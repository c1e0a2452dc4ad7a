"""One call from a scene to an episode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from phframe.core import Episode, OptionError, Scene, Setup
from phframe.registry import Kind, create
from phframe.runtime.episode import Loop, run_episode
from phframe.runtime.execution_world import ExecutionWorld
from phframe.runtime.observer import Observer
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.versions import versions
from phframe.runtime.world import WorldSpec

OPTION_GROUPS = ("planner", "backend", "arm", "topology", "scenes")
"""Whose options ``solve`` takes."""


def solve(
    scene: str | Path | Scene = "vieira/basic",
    *,
    planner: str = "phia",
    backend: str = "pymunk",
    arm: str = "planar",
    topology: str = "ripser",
    seed: int = 0,
    options: Mapping[str, Mapping[str, Any]] | None = None,
    time_limit: float = 300.0,
    max_replans: int = 5,
    tolerance: float = 0.01,
    workers: int = 1,
    observers: Sequence[Observer] = (),
) -> Episode:
    """Take the target out of a shelf: plan, carry out, observe, replan, grasp, withdraw.

    Args:
        scene: ``suite/name``, a scene file, or a scene.
        planner: Registered name, or a file and a class: ``./mine.py:Mine``.
        backend: Registered name of the physics engine to plan and to execute in.
        arm: Registered name of the arm.
        topology: Registered name of the engine for persistence diagrams.
        seed: Of everything random; the same seed gives the same episode.
        options: By ``planner``, ``backend``, ``arm``, ``topology`` and ``scenes``, then by key; values or their text.
        time_limit: Wall time for planning, replans included (s).
        max_replans: How often to plan again where reality differs.
        tolerance: What counts as differing (m).
        workers: Processes for planners that try many actions at once.
        observers: Who looks on; they are closed at the end, also when it is interrupted.

    Raises:
        PhframeError: If a name, an option or the scene cannot be used. What cannot be planned is a status, not an error.
    """
    given = _by_group(options or {})
    chosen = find_scene(scene, given["scenes"])
    spec = WorldSpec(chosen, backend, arm, given["backend"], given["arm"])
    setup = Setup(
        planner, backend, arm, topology, seed, {k: v for k, v in given.items() if v}, versions(backend, topology)
    )
    with ExitStack() as stack:
        for observer in observers:
            stack.callback(observer.close)
        search = create(Kind.PLANNER, planner, given["planner"])
        engine = create(Kind.TOPOLOGY, topology, given["topology"])
        planning = stack.enter_context(PlanningWorld(spec, workers))
        execution = stack.enter_context(ExecutionWorld(spec))
        return run_episode(
            search, engine, planning, execution, setup, Loop(max_replans, tolerance, time_limit), observers
        )


def _by_group(options: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    for group in options:
        if group not in OPTION_GROUPS:
            raise OptionError(f"there are no options of {group!r}; there are those of: {', '.join(OPTION_GROUPS)}")
    return {group: dict(options.get(group, {})) for group in OPTION_GROUPS}
