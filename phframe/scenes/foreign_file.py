"""Reads scene files of other programs in a process of its own: what their libraries do with a file is not trusted."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from pydantic import TypeAdapter

from phframe.core import InputError, SceneError
from phframe.core.bounded_process import ProcessEndedError, ProcessLimits, answer_of
from phframe.core.paths import path_shown, user_path
from phframe.scenes.foreign import ForeignScene

READER = "phframe.scenes.mujoco_"
"""The module that reads MuJoCo XML when it is run."""
OUT_OF_MEMORY = "allocate memory", "unknown exception"
"""In what MuJoCo says of a file that wants more memory than there is."""


@dataclass(frozen=True, slots=True)
class ForeignReading:
    """What came of reading a file: one of three.

    Attributes:
        scene: What is in it.
        problems: What is wrong with it.
        unreadable: Why it cannot be read at all.
    """

    scene: ForeignScene | None = None
    problems: tuple[str, ...] = ()
    unreadable: str = ""

    def to_json(self) -> bytes:
        """As the process that reads answers it."""
        return TypeAdapter(ForeignReading).dump_json(self)


def read_foreign(path: str | Path, limits: ProcessLimits | None = None) -> ForeignScene:
    """What is in a MuJoCo XML file.

    Args:
        path: The file.
        limits: What reading it may take; None: as much as a large room needs.

    Raises:
        InputError: If the file cannot be read.
        SceneError: If MuJoCo cannot make a model of it, or takes too much for it.
    """
    source, file, limits = path_shown(path), user_path(path), limits or ProcessLimits()
    try:
        answer = answer_of(READER, json.dumps([str(file.absolute()), source]).encode(), limits)
    except ProcessEndedError as error:
        raise SceneError(f"MuJoCo cannot make a model of it: {error}", source) from None
    reading = TypeAdapter(ForeignReading).validate_json(answer)
    if reading.scene is not None:
        return reading.scene
    if reading.unreadable:
        raise InputError(reading.unreadable)
    raise SceneError([_with_its_limit(problem, limits) for problem in reading.problems], source)


def _with_its_limit(problem: str, limits: ProcessLimits) -> str:
    """What MuJoCo says, and where that may mean that it got no more memory, how much it may have."""
    about_memory = any(words in problem for words in OUT_OF_MEMORY)
    return f"{problem} (it may take {limits.memory} MB of memory)" if about_memory else problem
