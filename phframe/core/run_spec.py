"""One run as a value: what is solved, with which parts and options, and how the loop is closed."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from numbers import Integral
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, JsonValue, PlainSerializer, PlainValidator, ValidationError

from phframe.core.errors import InputError, OptionError
from phframe.core.names import name_fault, name_shown
from phframe.core.scene import Scene
from phframe.core.stored_json import parse_json
from phframe.core.stored_name import StoredName
from phframe.core.value import Value
from phframe.core.variant import variant_name

FORMAT = 1
"""Of a run as JSON, and of its key: what changes the meaning of a field gets a new one."""
PARTS = ("planner", "backend", "arm", "plan_backend", "plan_arm", "topology", "goal")
"""The exchangeable parts of a run."""
OPTION_GROUPS = (*PARTS, "scenes")
"""What has options."""
_LONGEST = 300
"""Characters of what is told of a fault."""
KEY_LENGTH = 32
"""Hexadecimal digits of a key."""


@dataclass(frozen=True, slots=True)
class Loop:
    """How an episode closes the loop.

    Attributes:
        max_replans: How often the planner may be asked again, whatever for.
        tolerance: An object farther than this (m) from where it was expected calls for a replan.
        time_limit: Wall time for all planning together (s).
        simulations: Simulated actions for all planning together; None: no limit.

    Raises:
        InputError: If a figure is negative or not a number.
    """

    max_replans: int = 30
    tolerance: float = 0.01
    time_limit: float = 300.0
    simulations: int | None = None

    def __post_init__(self) -> None:
        for name in ("max_replans", "tolerance", "time_limit", "simulations"):
            figure = getattr(self, name)
            if figure is not None and not figure >= 0:
                raise InputError(f"{name} must be 0 or more, not {figure!r}")


@dataclass(frozen=True, slots=True, eq=False)
class RunSpec(Value):
    """All it takes to run an episode, and to run it again: what the command line, ``solve``, an episode and a bench share.

    A part is a registered name, a class in a file as ``./mine.py:Mine``, a class or, but for backends, an object. Only
    what consists of names can be stored.

    Attributes:
        scene: ``suite/name``, a scene file, or a scene.
        planner: Makes the plans.
        backend: The physics engine that carries them out.
        arm: The arm that carries them out.
        plan_backend: The physics engine to plan in; None: where ``backend`` drives joints ``fast`` if installed, else pymunk;
            for others ``backend``.
        plan_arm: The arm to plan with; None: ``arm``.
        topology: Computes persistence diagrams.
        goal: What is to be achieved.
        options: Of the parts, and as ``scenes`` of the suite of scenes, by key; values or their text.
        seed: Of everything random; the same seed gives the same episode.
        loop: How the loop is closed, and the limits.
        noise: By how much what the planner believes differs from what is true, by key; empty: not at all.
        workers: Processes for planners that try many actions at once. They change no result, so neither the key nor
            whether two runs are equal.

    Raises:
        InputError: If a field is not of its type, or a figure is out of range.
    """

    scene: str | Path | Scene = "vieira/basic"
    planner: Any = "phia"
    backend: Any = "pymunk"
    arm: Any = "planar"
    plan_backend: Any = None
    plan_arm: Any = None
    topology: Any = "ripser"
    goal: Any = "retrieve"
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    seed: int = 0
    loop: Loop = Loop()
    noise: Mapping[str, float] = field(default_factory=dict)
    workers: int = field(default=1, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "scene", _scene(self.scene))
        if not _is_whole(self.seed, 0):
            raise OptionError(f"a seed is a whole number of 0 or more, not {self.seed!r}")
        if not _is_whole(self.workers, 1):
            raise OptionError(f"workers must be a whole number of 1 or more, not {self.workers!r}")
        for name, value in (("seed", int(self.seed)), ("options", _by_group(self.options))):
            object.__setattr__(self, name, value)

    def name_of(self, part: str) -> str:
        """What a part is called: its name, or its class's."""
        value = getattr(self, part)
        return value if isinstance(value, str) else (value if isinstance(value, type) else type(value)).__name__

    def variant_of(self, part: str) -> str:
        """What a part is called with its options, as in ``phia[sweeps=paper]``; of a run prepared, those not the default."""
        return variant_name(self.name_of(part), self.options.get(part, {}))

    def to_json(self) -> str:
        """The run as JSON.

        Raises:
            InputError: If a part is an object, or an option no value of JSON.
        """
        return json.dumps(_dump(self), allow_nan=False)

    @staticmethod
    def from_json(text: str) -> RunSpec:
        """A run from JSON. Its names are ``StoredName``: they are looked up among what is registered, only.

        Raises:
            InputError: If it is no such JSON.
        """
        try:
            return _load(parse_json(text))
        except (ValueError, RecursionError) as error:
            raise InputError(f"no run: {error}") from None

    def key(self) -> str:
        """A name for all that changes the result: equal runs have equal keys, on every machine and in every process.

        A scene by its name, or a file's, counts as the name; the spec of an ``Episode`` has options as values.

        Raises:
            InputError: As ``to_json``.
        """
        content = {name: _canonical(value) for name, value in _dump(self).items() if name != "workers"}
        text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()[:KEY_LENGTH]


class _Stored(BaseModel):
    """The fields of a run as files hold them; what a later phframe of the same format adds is passed over."""

    model_config = ConfigDict(allow_inf_nan=False)

    scene: str | Scene
    planner: str
    backend: str
    arm: str
    topology: str
    goal: str
    options: dict[str, dict[str, JsonValue]]
    seed: int
    loop: Loop
    noise: dict[str, float]
    plan_backend: str | None = None
    plan_arm: str | None = None
    workers: int = 1


def _dump(spec: RunSpec) -> dict[str, Any]:
    for part in PARTS:
        if not isinstance(getattr(spec, part), str | None):
            raise InputError(
                f"the {part} is an object, {spec.name_of(part)}, so this run cannot be stored: register its class, or "
                f"give it as a text, as in {part}='./file.py:{spec.name_of(part)}'"
            )
    try:
        stored = _Stored.model_validate({each.name: getattr(spec, each.name) for each in fields(spec)})
        return {"format": FORMAT, **stored.model_dump(mode="json")}
    except ValidationError as error:
        raise InputError(f"this run cannot be stored: {first_fault(error)}") from None


def _load(content: Any) -> RunSpec:
    if isinstance(content, RunSpec):
        return content
    if not isinstance(content, Mapping) or content.get("format") != FORMAT:
        found = content.get("format") if isinstance(content, Mapping) else None
        raise ValueError(f"a run is an object of format {FORMAT}, not {found!r:.40}")
    try:
        stored = _Stored.model_validate(content)
    except ValidationError as error:
        raise ValueError(first_fault(error)) from None
    read = {name: getattr(stored, name) for name in _Stored.model_fields}
    names = {name: StoredName(value) for name, value in read.items() if isinstance(value, str)}
    return RunSpec(**{**read, **names})


AnyRunSpec = Annotated[RunSpec, PlainSerializer(_dump), PlainValidator(_load, json_schema_input_type=dict[str, Any])]
"""A run as files hold it."""


def first_fault(error: ValidationError) -> str:
    """The first thing that is wrong, and where, in a line of bounded length."""
    first = error.errors(include_url=False)[0]
    what = " ".join(first["msg"][:_LONGEST].split())
    return f"{'.'.join(_step_shown(step) for step in first['loc'])}: {what}"


def _step_shown(step: int | str) -> str:
    text = str(step)
    return text if not name_fault(text) else name_shown(text)


def _canonical(value: Any) -> Any:
    """Numbers that are equal written alike: 1 and 1.0."""
    if isinstance(value, Mapping):
        return {key: _canonical(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_canonical(each) for each in value]
    return int(value) if isinstance(value, float) and value.is_integer() else value


def _scene(given: Any) -> str | Scene:
    """A scene, or its name; a path as text that can only be one."""
    if isinstance(given, Path):
        return str(given) if given.is_absolute() or str(given).startswith("~") else os.path.join(".", given)  # noqa: PTH118
    if not isinstance(given, str | Scene):
        raise InputError(f"a scene is 'suite/name', a file or a Scene, not {given!r:.80}")
    return given


def _is_whole(value: Any, least: int) -> bool:
    return isinstance(value, Integral) and int(value) >= least


def _by_group(options: Any) -> dict[str, dict[str, Any]]:
    """The options of each group that has any, as they were given.

    Raises:
        OptionError: If they are not mappings from text, or a group does not exist.
    """
    groups = {"": options, **options} if isinstance(options, Mapping) else {"": options}
    for group, given in groups.items():
        if not (isinstance(given, Mapping) and all(isinstance(key, str) for key in given)):
            raise OptionError(f"options{f' of {group!r}' if group else ''} must be a mapping by name, not {given!r}")
        if group and group not in OPTION_GROUPS:
            raise OptionError(f"there are no options of {group!r}; there are those of: {', '.join(OPTION_GROUPS)}")
    return {group: dict(options[group]) for group in OPTION_GROUPS if options.get(group)}
