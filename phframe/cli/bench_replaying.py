"""What ``phframe bench replay`` does."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from phframe.bench.child import described
from phframe.bench.judge import measured
from phframe.bench.store import ResultStore
from phframe.bench.trial_result import TrialEnd, TrialResult, spec_of
from phframe.cli.console import emit, note
from phframe.cli.exit_codes import ExitCode
from phframe.cli.run import RunOutput, carry_out, show_recording
from phframe.cli.run_directory import RunDirectory
from phframe.core import InputError, RunSpec
from phframe.core.paths import path_shown

FORMAT = 1
"""Of the JSON object."""
_TIMES = frozenset(("planning_time", "topology_time", "simulation_time", "motion_planning_time"))
"""What differs from run to run."""


def run(bench: Path, words: Sequence[str], parts: Mapping[str, str | None], report: RunOutput) -> int:
    """Repeat a trial and print how the repetition compares.

    Args:
        bench: The directory of the bench.
        words: Which trial: the beginning of its key, or its problem, planner and seed.
        parts: Those that are classes in files, by what they are in a run; None: the trial's.
        report: What is to be left and printed.

    Returns:
        The exit code.

    Raises:
        PhframeError: If there is no such trial, or it cannot be repeated.
    """
    with ResultStore.open(bench) as store:
        before = _the_one(store.find(*words), bench, words)
        fault = store.fault(before.key)
    directory = RunDirectory(report.out)
    try:
        now = _again(_spec(before, parts), report, directory)
    except KeyboardInterrupt:
        return ExitCode.INTERRUPTED
    found = _compared(before, now, fault)
    if report.as_json:
        emit(json.dumps(found, allow_nan=False))
    else:
        _tell(found, directory)
    show_recording(report, directory)
    return ExitCode.SUCCESS if found["same"] else ExitCode.OTHER_OUTCOME


def _the_one(found: Sequence[TrialResult], bench: Path, words: Sequence[str]) -> TrialResult:
    what = f"trial {' '.join(words)!r}"
    if not found:
        raise InputError(
            f"{path_shown(bench)} has no result of a {what}; its results: phframe bench SUITE --out DIR --list"
        )
    if len(found) > 1:
        keys = ", ".join(each.key[:12] for each in found[:4])
        raise InputError(
            f"{len(found)} trials of {path_shown(bench)} are a {what}, such as {keys}: give more of the key"
        )
    return found[0]


def _spec(before: TrialResult, parts: Mapping[str, str | None]) -> RunSpec:
    """The trial's run; a part given takes the place of a class in a file of the same name only."""
    spec = spec_of(before)
    wanted: dict[str, Any] = {part: name for part, name in parts.items() if name is not None}
    for part, name in wanted.items():
        if name != (known := getattr(spec, part)):
            flag = f"--{part.replace('_', '-')}"
            raise InputError(f"{flag} {name} is not the {part.replace('_', ' ')} of the trial, which is {known}")
    return replace(spec, **wanted)


def _again(spec: RunSpec, report: RunOutput, directory: RunDirectory) -> dict[str, Any]:
    """What comes of it now, as the fields of a result."""
    try:
        carried = carry_out(spec, report, directory)
    except InputError:
        raise
    except Exception as error:  # noqa: BLE001 - it is what the trial is about
        return {"end": TrialEnd.ERROR, "reason": " ".join(described(error).split())}
    if carried is None:
        raise KeyboardInterrupt
    return {"end": TrialEnd.FINISHED, **measured(carried.episode)}


def _compared(before: TrialResult, now: Mapping[str, Any], fault: str) -> dict[str, Any]:
    pairs = {name: (getattr(before, name), value) for name, value in now.items() if name not in _TIMES}
    differences = {name: list(pair) for name, pair in pairs.items() if pair[0] != pair[1]}
    known = {"problem": before.problem, "planner": before.planner, "seed": before.seed}
    came = {"status": now.get("status", ""), "pushes": now.get("pushes", 0), "reason": now["reason"]}
    return {
        "format": FORMAT,
        "key": before.key,
        **known,
        "same": not differences,
        "differences": differences,
        "before": {"end": before.end, "status": before.status, "pushes": before.pushes, "reason": before.reason},
        "after": {"end": now["end"], **came},
        "fault": fault,
    }


def _tell(found: Mapping[str, Any], directory: RunDirectory) -> None:
    before, after = (_told(found[name]) for name in ("before", "after"))
    if found["same"]:
        emit(f"the same: {after}")
    else:
        emit(f"not the same: {after}; before: {before}")
        for name, (then, now) in found["differences"].items():
            emit(f"  {name} was {then}, is {now}")
    if directory.path is not None:
        note(f"files in {path_shown(directory.path)}")
    if found["fault"]:
        note(f"what the trial left when it went wrong:\n{found['fault']}")


def _told(came: Mapping[str, Any]) -> str:
    how = came["status"] or came["end"]
    reason = f" ({came['reason']})" if came["reason"] else ""
    return f"{how}{reason}, pushes {came['pushes']}"
