"""Results as rows of a table: one column per field, the values as SQLite has them."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import fields
from typing import Any, get_type_hints

from phframe.bench.trial_result import TrialEnd, TrialResult

_TEXT, _INTEGER, _REAL = "TEXT NOT NULL", "INTEGER NOT NULL", "REAL NOT NULL"
_KINDS: Mapping[Any, tuple[str, Callable[[Any], Any]]] = {
    str: (_TEXT, str),
    TrialEnd: (_TEXT, TrialEnd),
    int: (_INTEGER, int),
    bool: (_INTEGER, bool),
    float: (_REAL, float),
    float | None: ("REAL", lambda value: value),
    Mapping[str, int]: (_TEXT, json.loads),
}
"""Of each type of field, its column and how it is read from there."""

_TYPES = get_type_hints(TrialResult)
COLUMNS: tuple[str, ...] = tuple(field.name for field in fields(TrialResult))
"""In the order of the fields."""
DECLARED = ", ".join(f"{name} {_KINDS[_TYPES[name]][0]}" for name in COLUMNS if name != "key")
"""All columns but ``key``, for CREATE TABLE."""
_READ = tuple(_KINDS[_TYPES[name]][1] for name in COLUMNS)


def to_row(result: TrialResult) -> tuple[Any, ...]:
    """The values of a result, in the order of ``COLUMNS``."""
    return tuple(_stored(getattr(result, name)) for name in COLUMNS)


def from_row(row: tuple[Any, ...]) -> TrialResult:
    """The result of which these are the values.

    Raises:
        ValueError: If one is not of its column's type.
    """
    return TrialResult(*(read(value) for read, value in zip(_READ, row, strict=True)))


def _stored(value: Any) -> Any:
    return json.dumps(dict(value), sort_keys=True) if isinstance(value, Mapping) else value
