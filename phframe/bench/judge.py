"""Carries out the run of a trial and measures the episode. It works in the trial's own process."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from phframe.bench.guarded_planner import GuardedPlanner
from phframe.core import Condition, Episode, FloatArray, RunSpec
from phframe.registry import Kind, create
from phframe.runtime.run import run


def carry_out(spec: RunSpec) -> dict[str, Any]:
    """Carry out a run and measure it.

    Returns:
        The measured fields of a ``TrialResult``, by name.

    Raises:
        PhframeError: If something named cannot be used, or the planner does not keep to its interface.
    """
    planner = GuardedPlanner(create(Kind.PLANNER, spec.planner, spec.options.get("planner")))
    options = {part: given for part, given in spec.options.items() if part != "planner"}
    episode = run(replace(spec, planner=planner, options=options))
    return {**measured(episode), "first_solution_time": planner.first_solution_time}


def measured(episode: Episode) -> dict[str, Any]:
    """What a ``TrialResult`` says of an episode, by the names of its fields; without the time of the first solution."""
    return {**_outcome(episode), **_costs(episode), **_motions(episode), **_displacements(episode)}


def _outcome(episode: Episode) -> dict[str, Any]:
    return {
        "claimed": str(episode.plans[-1].status) if episode.plans else "",
        "status": str(episode.status),
        "reason": episode.reason,
        "retrieved": episode.status.is_success,
        "clean": episode.clean,
        "pushes": episode.pushes,
        "replans": episode.replans,
        "rejections": len(episode.rejections),
        "deviations": {str(name): count for name, count in sorted(episode.deviations.items())},
    }


def _costs(episode: Episode) -> dict[str, Any]:
    cost = episode.cost
    return {
        "simulations": cost.simulated_actions,
        "planning_time": cost.total,
        "topology_time": cost.topology,
        "simulation_time": cost.simulation,
        "motion_planning_time": cost.motion_planning,
        "execution_time": episode.execution_time,
    }


def _motions(episode: Episode) -> dict[str, Any]:
    errors = episode.prediction_errors
    return {
        "wall_contact": episode.wall_contact,
        "largest_force": max((step.motion.largest_force for step in episode.steps), default=0.0),
        "tracking_error": episode.tracking_error,
        "prediction_error": float(np.median(errors)) if len(errors) else None,
        "largest_prediction_error": float(errors.max()) if len(errors) else None,
        "target_moved": episode.target_moved,
    }


def _displacements(episode: Episode) -> Mapping[str, Any]:
    """Of the objects other than the target: how far each is from where it stood, and in which condition."""
    others = [row for row in range(len(episode.scene.objects)) if row != episode.scene.target_index]
    start, final = episode.scene.initial_state(), episode.final_state
    moved: FloatArray = np.linalg.norm(final.poses[others, :3] - start.poses[others, :3], axis=1)
    conditions = [final.conditions[row] for row in others]
    return {
        "displacement": float(moved.sum()),
        "largest_displacement": float(moved.max(initial=0.0)),
        "toppled": conditions.count(Condition.TOPPLED),
        "spilled": conditions.count(Condition.SPILLED),
    }
