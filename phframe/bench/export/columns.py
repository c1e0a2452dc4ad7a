"""What a result holds, column by column: the one table that all formats and their documentation are made from."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import StrEnum
from typing import Any, get_type_hints

from phframe.bench.trial_result import TrialEnd, TrialResult


class ColumnKind(StrEnum):
    """What the values of a column are."""

    TEXT = "text"
    BOOLEAN = "boolean"
    INTEGER = "integer"
    NUMBER = "number"
    COUNTS = "object"
    """Integers by name."""


@dataclass(frozen=True, slots=True)
class ResultColumn:
    """One column.

    Attributes:
        name: Of the field of ``TrialResult``.
        kind: What its values are.
        optional: Whether there may be none.
        unit: Of its values; empty where they have none.
        meaning: What the docstring of ``TrialResult`` says; empty where Python was told to leave docstrings out.
    """

    name: str
    kind: ColumnKind
    optional: bool
    unit: str
    meaning: str


_KINDS: Mapping[Any, tuple[ColumnKind, bool]] = {
    str: (ColumnKind.TEXT, False),
    TrialEnd: (ColumnKind.TEXT, False),
    bool: (ColumnKind.BOOLEAN, False),
    int: (ColumnKind.INTEGER, False),
    float: (ColumnKind.NUMBER, False),
    float | None: (ColumnKind.NUMBER, True),
    Mapping[str, int]: (ColumnKind.COUNTS, False),
}
_UNITS: Mapping[str, str] = {
    **dict.fromkeys(("planning_time", "topology_time", "simulation_time", "motion_planning_time"), "s"),
    **dict.fromkeys(("first_solution_time", "execution_time", "wall_time"), "s"),
    **dict.fromkeys(("displacement", "largest_displacement", "target_moved", "tracking_error"), "m"),
    **dict.fromkeys(("prediction_error", "largest_prediction_error"), "m"),
    "largest_force": "N",
    "peak_memory": "bytes",
}


def plain_value(column: ResultColumn, result: TrialResult) -> Any:
    """What a result holds in a column, as Python's own text, bool, int, float, dict or None."""
    value = getattr(result, column.name)
    return None if value is None else _PLAIN[column.kind](value)


_PLAIN: Mapping[ColumnKind, Any] = {
    ColumnKind.TEXT: str,
    ColumnKind.BOOLEAN: bool,
    ColumnKind.INTEGER: int,
    ColumnKind.NUMBER: float,
    ColumnKind.COUNTS: lambda counts: {name: int(count) for name, count in sorted(counts.items())},
}


def _columns() -> tuple[ResultColumn, ...]:
    types, meanings = get_type_hints(TrialResult), _meanings(TrialResult.__doc__ or "")
    names = [each.name for each in fields(TrialResult)]
    return tuple(
        ResultColumn(name, *_KINDS[types[name]], _UNITS.get(name, ""), meanings.get(name, "")) for name in names
    )


def _meanings(docstring: str) -> dict[str, str]:
    """What a docstring says of each attribute, on one line."""
    found = re.findall(r"^ {8}(\w+): (.+(?:\n {12}.+)*)", docstring, flags=re.MULTILINE)
    return {name: " ".join(text.split()) for name, text in found}


COLUMNS: tuple[ResultColumn, ...] = _columns()
"""All columns, in the order of the fields of ``TrialResult``."""
