"""What the process of a trial does: isolate itself, carry the run out, send what was measured."""

from __future__ import annotations

import json
import os
import traceback
from multiprocessing.connection import Connection
from typing import Any

from phframe.bench.isolation import isolate, lift_memory_limit, peak_memory
from phframe.bench.judge import carry_out
from phframe.bench.trial_result import TrialEnd
from phframe.core import PhframeError, RunSpec

FAULT = "fault"
"""Key of what is sent beside the fields of a result: a traceback."""
_LONGEST = 4000
"""Characters of a reason."""


def main(spec: RunSpec, memory: int, results: Connection, output: Connection) -> None:
    """Carry out one trial and end this process.

    Args:
        spec: The run.
        memory: Address space that it may have (MB).
        results: Where the result goes, as JSON: fields of a ``TrialResult``, and ``fault``.
        output: Where all that is printed goes.
    """
    own = os.getpid()
    isolate(output, memory)
    content = _carried_out(spec)
    if os.getpid() == own:  # and not one that the planner forked
        _send(results, json.dumps({**content, "peak_memory": peak_memory()}).encode())
    os._exit(0)


def _carried_out(spec: RunSpec) -> dict[str, Any]:
    """The fields of the result, whatever the planner and the engine do."""
    try:
        return {"end": TrialEnd.FINISHED, **carry_out(spec)}
    except MemoryError:
        lift_memory_limit()
        return _failed(TrialEnd.MEMORY, "it asked for more memory than it may have")
    except SystemExit as error:
        return _failed(TrialEnd.CRASHED, f"the code in it asked to exit, with {error.code!r}")
    except BaseException as error:  # noqa: BLE001 - it is told, not hidden
        return _failed(TrialEnd.ERROR, described(error))


def _failed(end: TrialEnd, reason: str) -> dict[str, Any]:
    return {"end": end, "reason": " ".join(reason.split())[:_LONGEST], FAULT: traceback.format_exc()}


def described(error: BaseException) -> str:
    """An error in words, and where it arose if it is none of phframe's own."""
    if isinstance(error, PhframeError):
        return str(error)
    frames = traceback.extract_tb(error.__traceback__)
    where = f" (line {frames[-1].lineno} of {os.path.basename(frames[-1].filename)})" if frames else ""  # noqa: PTH119
    return f"{type(error).__name__}: {error}{where}"


def _send(results: Connection, content: bytes) -> None:
    """Write it all; there is room for it in the pipe, or the bench reads."""
    view = memoryview(content)
    while view:
        view = view[os.write(results.fileno(), view) :]
