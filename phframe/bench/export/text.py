"""Results as text, line by line: CSV (RFC 4180, with line feeds) and JSON."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator
from typing import Any

from phframe.bench.export.columns import COLUMNS, plain_value
from phframe.bench.export.content import ExportContent
from phframe.bench.trial_result import TrialResult

_QUOTED = re.compile(r'[",\r\n]|^\s|\s$')


def csv_lines(content: ExportContent) -> Iterator[str]:
    """A table with one row per result, without line ends.

    Nothing stands for None and for empty text, ``true`` and ``false`` for booleans, JSON for counts by name; floats have
    as many digits as give the same float again.
    """
    yield ",".join(column.name for column in COLUMNS)
    for result in content.results:
        yield ",".join(_cell(plain_value(column, result)) for column in COLUMNS)


def json_lines(content: ExportContent) -> Iterator[str]:
    """One JSON object, a line per result, without line ends; an infinite number is the text ``inf``, as elsewhere."""
    beginning = json.dumps(content.header(), allow_nan=False)
    line = f'{beginning[:-1]}, "results": ['
    for number, result in enumerate(content.results):
        yield line + ("," if number else "")
        line = json.dumps(_object(result), allow_nan=False)
    yield line
    yield "]}"


def _object(result: TrialResult) -> dict[str, Any]:
    return {column.name: _json_value(plain_value(column, result)) for column in COLUMNS}


def _json_value(value: Any) -> Any:
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, str | dict):
        text = value if isinstance(value, str) else json.dumps(value)
        return '"' + text.replace('"', '""') + '"' if _QUOTED.search(text) else text
    return json.dumps(value) if isinstance(value, bool) else repr(value)
