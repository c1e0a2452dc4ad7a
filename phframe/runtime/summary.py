"""An episode in one flat object, for machines: format 1 of ``phframe solve --json``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from phframe.core import Episode, RunSpec

FORMAT = 1


def summarize(episode: Episode, recording: Path | None = None) -> dict[str, Any]:
    """The episode's outcome; keys and units are fixed by the format number.

    ``variant`` is the planner with the options that are not the default, as in ``phia[sweeps=paper]``. ``actions``
    counts pushes (the paper's number of actions), ``planning_time`` is wall time with all replans (s),
    ``execution_time`` simulated time (s), ``target_moved`` before the grasp (m), ``spilled`` leaves a retrieved target out.
    ``motion_planning_time`` is wall time of planning joint trajectories (s), ``tracking_error`` the fingertip's worst (m),
    ``prediction_error`` of the objects that actions moved (m), or null where nothing was predicted or moved; ``noise`` is
    that of what the planner believed, empty where it was told the truth.
    """
    spec, cost = episode.spec, episode.cost
    return {
        "format": FORMAT,
        "scene": episode.scene.name,
        "planner": spec.name_of("planner"),
        "variant": spec.variant_of("planner"),
        "backend": spec.name_of("backend"),
        "arm": spec.name_of("arm"),
        "plan_backend": _planned_with(spec, "backend"),
        "plan_arm": _planned_with(spec, "arm"),
        "topology": spec.name_of("topology"),
        "goal": spec.name_of("goal"),
        "seed": spec.seed,
        "noise": dict(spec.noise),
        "status": str(episode.status),
        "reason": episode.reason,
        "actions": episode.pushes,
        "planning_time": cost.total,
        "motion_planning_time": episode.motion_planning_time,
        "execution_time": episode.execution_time,
        "simulated_actions": cost.simulated_actions,
        "replans": episode.replans,
        "toppled": list(episode.toppled),
        "spilled": list(episode.spilled),
        "target_moved": episode.target_moved,
        "tracking_error": episode.tracking_error,
        "prediction_error": _prediction_error(episode),
        "wall_contact": episode.wall_contact,
        "clean": episode.clean,
        "recording": None if recording is None else str(recording),
        "versions": dict(episode.versions),
    }


def _planned_with(spec: RunSpec, part: str) -> str:
    return spec.name_of(part if getattr(spec, f"plan_{part}") is None else f"plan_{part}")


def _prediction_error(episode: Episode) -> dict[str, float] | None:
    """How far objects were from where the plan had them after each action."""
    errors = episode.prediction_errors
    return {"median": float(np.median(errors)), "worst": float(errors.max())} if len(errors) else None
