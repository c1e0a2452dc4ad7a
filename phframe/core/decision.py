"""Why an action was chosen: in words, and as data of a planning method's own type."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from functools import cache
from typing import Annotated, Any, ClassVar

from pydantic import PlainSerializer, PlainValidator, TypeAdapter, ValidationError

from phframe.core.advisor import Hint
from phframe.core.value import Value

_KINDS: dict[str, type[Decision]] = {}
"""Every type of decision that has been defined, by its ``kind``; what a file says names one of these, never code."""


@dataclass(frozen=True, slots=True, eq=False)
class Decision(Value):
    """Why an action was chosen. A planning method adds its data by a frozen subclass with a ``kind`` of its own.

    Attributes:
        why: In words, for people.
        deviations: Which deviations were used, where the published method leaves something open, by name.
    """

    kind: ClassVar[str] = "decision"
    """What the type is called in files; unique."""

    why: str = ""
    deviations: tuple[str, ...] = ()

    @property
    def hint(self) -> Hint | None:
        """What was answered when the planner asked what to do, where this is why; repeating the run needs it.

        A type of decision that has one holds it in a field of this name, so that it is found in files whatever the type.
        """
        return None

    def __init_subclass__(cls) -> None:
        super(Decision, cls).__init_subclass__()  # by name: slots make the class anew
        _KINDS[cls.kind] = cls


@dataclass(frozen=True, slots=True, eq=False)
class UnknownDecision(Decision):
    """A decision read from a file, of a type that is not installed here: kept as it was written.

    Attributes:
        written: What the file says of it, its kind included.
    """

    kind: ClassVar[str] = "unknown"

    written: Mapping[str, Any] = field(default_factory=dict)

    @property
    def hint(self) -> Hint | None:
        """The hint in what is written, if there is one."""
        try:
            return TypeAdapter(Hint | None).validate_python(self.written.get("hint"))
        except ValidationError:
            return None


_KINDS[Decision.kind] = Decision


@cache
def _adapter(kind: str) -> TypeAdapter[Decision]:
    return TypeAdapter(_KINDS[kind])


def _dump(decision: Decision) -> dict[str, Any]:
    if isinstance(decision, UnknownDecision):
        return dict(decision.written)
    return {"kind": decision.kind, **_adapter(decision.kind).dump_python(decision, mode="json")}


def _load(value: Any) -> Decision:
    if isinstance(value, Decision):
        return value
    if not isinstance(value, Mapping):
        raise ValueError(f"a decision is an object with a kind, not {value!r:.80}")
    cls = _KINDS.get(str(value.get("kind")))
    if cls is None or cls is UnknownDecision:
        return UnknownDecision(str(value.get("why", "")), tuple(map(str, value.get("deviations", ()))), dict(value))
    names = {each.name for each in fields(cls)}
    return _adapter(cls.kind).validate_python({key: each for key, each in value.items() if key in names})


AnyDecision = Annotated[Decision, PlainSerializer(_dump), PlainValidator(_load, json_schema_input_type=dict[str, Any])]
"""A decision of any type, as files hold it: an object with its ``kind``."""
