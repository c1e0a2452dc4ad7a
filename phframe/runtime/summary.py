"""An episode in one flat object, for machines: format 1 of ``phframe solve --json``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from phframe.core import Episode

FORMAT = 1


def summarize(episode: Episode, recording: Path | None = None) -> dict[str, Any]:
    """The episode's outcome; keys and units are fixed by the format number.

    ``actions`` counts pushes (the paper's number of actions), ``planning_time`` is wall time with all replans (s),
    ``execution_time`` simulated time (s), ``target_moved`` before the grasp (m), ``spilled`` leaves a retrieved target out.
    """
    setup, cost = episode.setup, episode.cost
    return {
        "format": FORMAT,
        "scene": episode.scene.name,
        "planner": setup.planner,
        "backend": setup.backend,
        "arm": setup.arm,
        "topology": setup.topology,
        "seed": setup.seed,
        "status": str(episode.status),
        "reason": episode.reason,
        "actions": episode.pushes,
        "planning_time": cost.total,
        "execution_time": episode.execution_time,
        "simulated_actions": cost.simulated_actions,
        "replans": episode.replans,
        "toppled": list(episode.toppled),
        "spilled": list(episode.spilled),
        "target_moved": episode.target_moved,
        "wall_contact": episode.wall_contact,
        "clean": episode.clean,
        "recording": None if recording is None else str(recording),
        "versions": dict(setup.versions),
    }
