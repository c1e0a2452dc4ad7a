"""The formats that results are written in."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from phframe.bench.export.content import ExportContent
from phframe.bench.export.parquet_ import write_parquet
from phframe.bench.export.plannerarena import write_plannerarena
from phframe.bench.export.text import csv_lines, json_lines


@dataclass(frozen=True, slots=True)
class ResultFormat:
    """One format: text, by its lines, or a file that is no text.

    Attributes:
        name: What it is asked for by.
        what: What it is.
        suffix: Of files that are meant to be of it.
        lines: The lines of a text without their ends; None: it is no text.
        write: What writes it into an empty file; None: it is text.
        extra: Of phframe, that brings the library ``module``; empty: it needs none.
        module: The library.
    """

    name: str
    what: str
    suffix: str
    lines: Callable[[ExportContent], Iterator[str]] | None = None
    write: Callable[[ExportContent, Path], None] | None = None
    extra: str = ""
    module: str = ""


_ALL = (
    ResultFormat("csv", "a table with one row per trial", ".csv", csv_lines),
    ResultFormat("json", "settings, environments and all results", ".json", json_lines),
    ResultFormat("parquet", "the table with types and units", ".parquet", None, write_parquet, "parquet", "pyarrow"),
    ResultFormat("plannerarena", "a database for OMPL's Planner Arena", ".db", None, write_plannerarena),
)
RESULT_FORMATS: Mapping[str, ResultFormat] = MappingProxyType({each.name: each for each in _ALL})
"""All formats, by name."""
