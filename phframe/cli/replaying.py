"""What ``phframe replay`` does."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from phframe.cli.console import emit
from phframe.cli.episodes import read_episode
from phframe.cli.exit_codes import ExitCode
from phframe.cli.run import RunOutput, carry_out, show_recording
from phframe.cli.run_directory import RunDirectory
from phframe.cli.supervised import WatchdogLink
from phframe.core import Episode
from phframe.core.run_spec import PARTS
from phframe.runtime.replay import StoredAdvice, differing_versions, first_difference, spec_of

FORMAT = 1
"""Of the JSON object."""


def run(
    episode: Path, parts: Mapping[str, str | None], out: Path | None, link: WatchdogLink, *, view: bool, as_json: bool
) -> int:
    """Repeat an episode and print how the repetition compares.

    Args:
        episode: A directory, or a file.
        parts: What to take instead of the episode's; None: the same.
        out: Directory for the files; None: none, or a new one.
        link: To the watchdog.
        view: Whether to open the viewer.
        as_json: Whether to print JSON.

    Returns:
        The exit code.

    Raises:
        PhframeError: If the episode cannot be read or repeated; nothing was written then.
    """
    before = read_episode(episode)
    spec = spec_of(before, **parts)
    kept = out is not None or view
    report = RunOutput(out, record=True if view else None if kept else False, view=view)
    directory = RunDirectory(out, keep=kept)
    same_planner = spec.planner == before.spec.planner
    carried = carry_out(spec, report, directory, StoredAdvice(before) if same_planner else None, link)
    if carried is None:
        return ExitCode.INTERRUPTED
    same_parts = all(getattr(spec, part) == getattr(before.spec, part) for part in PARTS)
    found = _compared(before, carried.episode, bits=same_parts)
    emit(json.dumps(found, allow_nan=False) if as_json else _sentence(found))
    if carried.failure is not None:
        raise carried.failure
    show_recording(report, directory)
    return ExitCode.SUCCESS if found["same"] else ExitCode.OTHER_OUTCOME


def _compared(before: Episode, after: Episode, *, bits: bool) -> dict[str, Any]:
    difference = first_difference(before, after) if bits else None
    versions = differing_versions(before)
    return {
        "format": FORMAT,
        "compared": "bits" if bits else "outcome",
        "same": difference is None if bits else before.status is after.status,
        "difference": None if difference is None else {**asdict(difference), "distance": _finite(difference.distance)},
        "sentence": "" if difference is None else str(difference),
        "versions": {name: list(pair) for name, pair in versions.items()},
        "before": _outcome(before),
        "after": _outcome(after),
    }


def _finite(distance: float | None) -> float | None:
    return None if distance is None or distance == float("inf") else distance


def _outcome(episode: Episode) -> dict[str, Any]:
    return {
        "status": str(episode.status),
        "reason": episode.reason,
        "actions": episode.pushes,
        "replans": episode.replans,
        "clean": episode.clean,
    }


def _sentence(found: dict[str, Any]) -> str:
    before, after = (
        f"{each['status']}, pushes {each['actions']}, replans {each['replans']}"
        for each in (found["before"], found["after"])
    )
    if found["compared"] == "outcome":
        return f"{'the same' if found['same'] else 'another'} outcome: {after}; before: {before}"
    if found["same"]:
        return f"the same, bit by bit: {after}"
    named = ", ".join(f"{name} {then}, here {now}" for name, (then, now) in found["versions"].items())
    return f"not the same: {found['sentence']}; {f'other versions: {named}' if named else 'all versions are the same'}"
