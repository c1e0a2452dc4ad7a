"""The tables of a report as Markdown, for documents, and as JSON, for programs."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from phframe.bench.report.document import Cell, Column, ReportSection, Table
from phframe.bench.statistics import Estimate

FORMAT = 1
"""Of the tables as JSON."""
_LEFT_OUT = ("failures",)
"""Sections whose tables Markdown has the first of, only: the others list single trials."""


def as_markdown(title: str, sections: Sequence[ReportSection]) -> str:
    """All tables but those that list single trials."""
    parts = [f"# {_escaped(title)}"]
    for section in sections:
        tables = section.tables[:1] if section.name in _LEFT_OUT else section.tables
        if tables:
            parts += [f"## {section.title}", _escaped(section.about), *map(_markdown, tables)]
    return "\n\n".join(parts) + "\n"


def _markdown(table: Table) -> str:
    head = " | ".join(_escaped(column.heading) for column in table.columns)
    rule = " | ".join("--:" if column.kind in ("number", "p") else "---" for column in table.columns)
    rows = [" | ".join(map(_cell, table.columns, row)) for row in table.rows]
    return "\n".join([f"{_escaped(table.title)}\n", *(f"| {line} |" for line in (head, rule, *rows))])


def _cell(column: Column, cell: Cell) -> str:
    text, interval = column.text(cell), column.interval(cell)
    if column.kind == "command" and text.startswith("phframe "):
        return f"`{text.replace('|', chr(92) + '|')}`"
    return f"{_escaped(text)} ({interval})" if interval else _escaped(text)


def _escaped(text: str) -> str:
    """Text that Markdown shows as it is."""
    return re.sub(r"([\\`*_|<>\[\]])", r"\\\1", " ".join(text.split()))


def as_json(title: str, sections: Sequence[ReportSection]) -> str:
    """All tables, their figures in SI units as they are, by section."""
    content = {section.name: [_object(table) for table in section.tables] for section in sections if section.tables}
    return json.dumps({"format": FORMAT, "title": title, "sections": content}, allow_nan=False)


def _object(table: Table) -> dict[str, Any]:
    keys = [column.key for column in table.columns]
    rows = [dict(zip(keys, map(_plain, table.columns, row), strict=True)) for row in table.rows]
    return {"title": table.title, "rows": rows}


def _plain(column: Column, cell: Cell) -> Any:
    """In the unit of the column's heading, of which its key is made."""
    if isinstance(cell, Estimate):
        scaled = {name: _plain(column, getattr(cell, name)) for name in ("value", "low", "high")}
        return {**asdict(cell), **scaled}
    if isinstance(cell, float):
        return cell * column.scale if math.isfinite(cell) else str(cell)
    return cell
