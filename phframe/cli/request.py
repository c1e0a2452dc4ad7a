"""What ``phframe solve`` was asked for."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Request:
    """What ``phframe solve`` was asked for.

    Attributes:
        scene: A name such as ``vieira/basic``, or a file.
        planner: A name, or a class in a file.
        backend: As ``planner``.
        arm: As ``planner``.
        plan_backend: As ``planner``; None: what suits the backend.
        plan_arm: As ``planner``; None: the arm.
        topology: As ``planner``.
        seed: Of everything random.
        noise: As text; None: there is none.
        options: As text, by part and key.
        time_limit: Longest planning time (s).
        max_replans: How often to plan anew.
        tolerance: How far an object may be from where it was expected (m).
        out: Directory for the files; None: a new one.
        record: Whether to write a recording; None: if the recorder is installed.
        video: The file of a video to make; None: none.
        view: Whether to open the viewer.
        as_json: Whether to print JSON.
        quiet: Whether to print errors only.
    """

    scene: str
    planner: str
    backend: str
    arm: str
    plan_backend: str | None
    plan_arm: str | None
    topology: str
    seed: int
    noise: str | None
    options: Mapping[str, Mapping[str, str]]
    time_limit: float
    max_replans: int
    tolerance: float
    out: Path | None
    record: bool | None
    video: Path | None
    view: bool
    as_json: bool
    quiet: bool
