"""What a bench runs, as a value: it decides which trials there are, and with them what is stored."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import Any, ClassVar

from pydantic import ConfigDict, TypeAdapter, ValidationError

from phframe.core import InputError, Loop, Value
from phframe.core.run_spec import first_fault
from phframe.core.stored_json import parse_json

FORMAT = 1
"""Of settings as JSON: what changes the meaning of a field gets a new one."""
MEMORY_LIMIT = 4096
"""MB of address space that a trial may have, where nothing else is said; the engines map a good part of 1 GB unused."""
MOST_SEEDS, MOST_MEMORY = 1_000_000, 2**30
"""Of a bench, and of a trial (MB)."""
GRACE = 60.0
"""Seconds that a trial may take beyond one and a half times its planning: loading, carrying out, looking."""


@dataclass(frozen=True, slots=True, eq=False)
class BenchSettings(Value):
    """All trials of a bench: every planner on every problem with every seed.

    Attributes:
        suites: Names of suites, or of problems in them with wildcards and ranges, as in ``random/0..99``.
        planners: Their names with options, as in ``phia[sweeps=paper]``, or classes in files.
        backend: What carries the plans out.
        arm: The arm that does.
        plan_backend: What to plan in; None: as in ``RunSpec``.
        plan_arm: The arm to plan with; None: as in ``RunSpec``.
        topology: Computes persistence diagrams.
        goal: What is to be achieved.
        options: Of the parts, by part and key, beside those in the planners' brackets.
        seeds: How many: 0, 1 and so on.
        loop: How the loop is closed; its ``time_limit`` is that of planning.
        noise: Of what the planner believes, by key.
        memory_limit: Address space of a trial (MB).
        trial_limit: Wall time of a whole trial, at which it is killed (s).

    Raises:
        InputError: If a number is out of range, or there is no suite or planner.
    """

    __pydantic_config__: ClassVar = ConfigDict(extra="forbid")

    suites: tuple[str, ...]
    planners: tuple[str, ...] = ("phia",)
    backend: str = "pymunk"
    arm: str = "planar"
    plan_backend: str | None = None
    plan_arm: str | None = None
    topology: str = "ripser"
    goal: str = "retrieve"
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    seeds: int = 1
    loop: Loop = field(default_factory=Loop)
    noise: Mapping[str, float] = field(default_factory=dict)
    memory_limit: int = MEMORY_LIMIT
    trial_limit: float | None = None

    def __post_init__(self) -> None:
        for name in ("suites", "planners"):
            if not getattr(self, name):
                raise InputError(f"a bench without {name} has nothing to run: name at least one")
        for name, most in (("seeds", MOST_SEEDS), ("memory_limit", MOST_MEMORY)):
            if not 1 <= getattr(self, name) <= most:
                raise InputError(f"{name.replace('_', ' ')} must be from 1 to {most}, not {getattr(self, name)!r}")
        if self.trial_limit is not None and not 0 < self.trial_limit < float("inf"):
            raise InputError(f"a trial limit of {self.trial_limit!r} s is none: give a number above 0")
        object.__setattr__(self, "options", {part: dict(given) for part, given in self.options.items() if given})

    @property
    def kill_after(self) -> float:
        """Wall time at which a trial is killed (s): the trial limit, or what follows from the planning's."""
        return 1.5 * self.loop.time_limit + GRACE if self.trial_limit is None else self.trial_limit

    def to_json(self) -> str:
        """The settings as JSON."""
        contents = {each.name: getattr(self, each.name) for each in fields(self)}
        return json.dumps({"format": FORMAT, **contents, "loop": asdict(self.loop)}, allow_nan=False, sort_keys=True)

    @staticmethod
    def from_json(text: str) -> BenchSettings:
        """Settings from JSON.

        Raises:
            InputError: If they are none, or of another format.
        """
        try:
            content = parse_json(text)
            if content.pop("format") != FORMAT:
                raise ValueError("they are of another format")
            settings = _SETTINGS.validate_python(content)
            settings.to_json()  # refuses numbers that are none, wherever they are
            return settings
        except ValidationError as error:
            raise InputError(f"these are no settings of a bench: {first_fault(error)}") from None
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError) as error:
            raise InputError(f"these are no settings of a bench: {error}") from None


_SETTINGS = TypeAdapter(BenchSettings)
