"""Results as rows of a table: one column per field, the values as SQLite has them."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import fields
from typing import Any, get_type_hints

from pydantic import TypeAdapter, ValidationError

from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core.run_spec import first_fault

_TEXT, _INTEGER, _REAL = "TEXT NOT NULL", "INTEGER NOT NULL", "REAL NOT NULL"
_KINDS: Mapping[Any, str] = {
    str: _TEXT,
    TrialEnd: _TEXT,
    int: _INTEGER,
    bool: _INTEGER,
    float: _REAL,
    float | None: "REAL",
    Mapping[str, int]: _TEXT,
}
"""Of each type of field, its column."""

_TYPES = get_type_hints(TrialResult)
COLUMNS: tuple[str, ...] = tuple(field.name for field in fields(TrialResult))
"""In the order of the fields."""
DECLARED = ", ".join(f"{name} {_KINDS[_TYPES[name]]}" for name in COLUMNS if name != "key")
"""All columns but ``key``, for CREATE TABLE."""
_RESULT = TypeAdapter(TrialResult)
_OBJECTS = tuple(name for name in COLUMNS if _TYPES[name] == Mapping[str, int])
"""Columns that hold JSON."""
_FIGURES = tuple(name for name in COLUMNS if _KINDS[_TYPES[name]].startswith("REAL"))
"""Columns that hold numbers; a file that somebody wrote may have the text ``nan`` there."""


def to_row(result: TrialResult) -> tuple[Any, ...]:
    """The values of a result, in the order of ``COLUMNS``."""
    return tuple(_stored(getattr(result, name)) for name in COLUMNS)


def from_row(row: tuple[Any, ...]) -> TrialResult:
    """The result of which these are the values.

    Raises:
        ValueError: If one is not of its column's type.
    """
    values = dict(zip(COLUMNS, row, strict=True))
    try:
        values.update({name: json.loads(values[name]) for name in _OBJECTS})
        result = _RESULT.validate_python(values)
    except ValidationError as error:
        raise ValueError(first_fault(error)) from None
    except (TypeError, ValueError, RecursionError) as error:
        raise ValueError(f"{' and '.join(_OBJECTS)}: {error}") from None
    if strange := [name for name in _FIGURES if math.isnan(getattr(result, name) or 0.0)]:
        raise ValueError(f"{strange[0]}: it is not a number")
    return result


def _stored(value: Any) -> Any:
    return json.dumps(dict(value), sort_keys=True) if isinstance(value, Mapping) else value
