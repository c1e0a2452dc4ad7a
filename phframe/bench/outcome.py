"""From how a trial's process ended, and what it sent, to its result. What it sent is not taken on trust."""

from __future__ import annotations

import json
import math
import signal
from collections.abc import Iterator, Mapping
from dataclasses import fields
from typing import Any

from pydantic import TypeAdapter, ValidationError

from phframe.bench.child import FAULT
from phframe.bench.limits import TrialLimits
from phframe.bench.trial import Trial
from phframe.bench.trial_process import Ending
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import Status
from phframe.core.run_spec import first_fault

_OURS = frozenset(
    ("key", "suite", "problem", "planner", "backend", "arm", "plan_backend", "plan_arm", "seed", "spec")
) | {"wall_time", "started", "environment"}
"""What the bench knows itself: a trial has no say in it."""
_THEIRS = frozenset(field.name for field in fields(TrialResult)) - _OURS
_LONGEST, _LONGEST_FAULT = 4000, 16000
"""Characters of a text, and of a fault."""
_NO_MEMORY = ("bad_alloc", "MemoryError", "Cannot allocate memory")


def result_of(trial: Trial, ending: Ending, limits: TrialLimits, environment: str = "") -> tuple[TrialResult, str]:
    """The result of a trial, and what helps to find out why it went wrong.

    Args:
        trial: The trial.
        ending: How its process ended.
        limits: What it was allowed.
        environment: Id of where it ran.
    """
    content = _read(ending.message)
    fault = "\n".join(filter(None, [str(content.pop(FAULT, "")), ending.output]))[-_LONGEST_FAULT:].strip()
    if "end" not in content or ending.code != 0:
        content = _death(ending, limits)
    ours = {**_identity(trial), "wall_time": ending.wall_time, "started": ending.started, "environment": environment}
    try:
        result = _checked({**content, **ours})
    except (ValidationError, ValueError) as error:
        result = _checked({**ours, "end": TrialEnd.ERROR, "reason": f"what it sent is no result: {_first(error)}"})
    return result, "" if result.end is TrialEnd.FINISHED else fault


def _identity(trial: Trial) -> dict[str, Any]:
    spec = trial.spec
    names = {part: spec.name_of(part) for part in ("backend", "arm", "plan_backend", "plan_arm")}
    whole = {"key": trial.key, "suite": trial.suite, "problem": trial.problem, "planner": trial.planner}
    return {**whole, **names, "seed": spec.seed, "spec": spec.to_json()}


def _read(message: bytes) -> dict[str, Any]:
    """What a trial sent, as far as it may; nothing where it is no object of JSON."""
    try:
        content = json.loads(message)
    except (ValueError, RecursionError):
        return {}
    return {name: content[name] for name in (*_THEIRS, FAULT) if name in content} if isinstance(content, dict) else {}


def _death(ending: Ending, limits: TrialLimits) -> dict[str, Any]:
    """What there is to say of a process that ended without a result."""
    if ending.overdue:
        return {"end": TrialEnd.KILLED, "reason": f"it ran longer than {limits.seconds:g} s and was killed"}
    if any(sign in ending.output for sign in _NO_MEMORY):
        return {"end": TrialEnd.MEMORY, "reason": f"it asked for more than the {limits.memory} MB that it may have"}
    last = [line.strip() for line in ending.output.splitlines() if line.strip()]
    where = next((line for line in last if line.startswith("File ")), "") if ending.code < 0 else "".join(last[-1:])
    said = f"; the last it said: {where}" if where and ending.code >= 0 else f" in {where}" if where else ""
    return {"end": TrialEnd.CRASHED, "reason": f"its process {_exit(ending.code)}{said}"[:_LONGEST]}


def _exit(code: int) -> str:
    if code >= 0:
        return f"ended with exit code {code} before there was a result"
    return f"was ended by signal {-code} ({signal.strsignal(-code) or 'unknown'})"


def _checked(content: Mapping[str, Any]) -> TrialResult:
    """The result, if it is one.

    Raises:
        ValueError: If it is none, or it contradicts itself.
    """
    result = _RESULT.validate_python({"end": TrialEnd.FINISHED, **content})
    if wrong := next(_contradictions(result), ""):
        raise ValueError(wrong)
    return result


_RESULT = TypeAdapter(TrialResult)


def _contradictions(result: TrialResult) -> Iterator[str]:
    """What cannot be of the measured figures."""
    for name in sorted(_THEIRS):
        value = getattr(result, name)
        if isinstance(value, int | float) and not (value >= 0 and math.isfinite(value)):
            yield f"{name} is {value!r}"
        if isinstance(value, str) and len(value) > _LONGEST:
            yield f"{name} is {len(value)} characters long"
    for name, status in (("status", result.status), ("claimed", result.claimed)):
        if status not in ("", *Status):
            yield f"{name} is {status!r}, which is no status"
    yield from _inconsistent(result)


def _inconsistent(result: TrialResult) -> Iterator[str]:
    if (result.end is TrialEnd.FINISHED) is not bool(result.status):
        yield f"it ended {result.end} with the status {result.status!r}"
    elif result.retrieved is not (bool(result.status) and Status(result.status).is_success):
        yield f"retrieved is {result.retrieved} with the status {result.status!r}"
    elif result.clean and not result.retrieved:
        yield "it is clean and not retrieved"


def _first(error: Exception) -> str:
    return first_fault(error) if isinstance(error, ValidationError) else str(error)
