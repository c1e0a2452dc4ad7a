"""Results as a Parquet file, by pyarrow."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from itertools import islice
from pathlib import Path
from typing import Any

from phframe.bench.export.columns import COLUMNS, ColumnKind, ResultColumn, plain_value
from phframe.bench.export.content import ExportContent
from phframe.bench.trial_result import TrialResult
from phframe.core import NotInstalledError

GROUP = 4096
"""Rows in memory at a time, which make a row group of the file."""
HEADER = b"phframe"
"""What the header of the content is called in the file's metadata."""


def write_parquet(content: ExportContent, path: Path) -> None:
    """Write a table with one row per result; each field's metadata tell its ``unit`` and ``meaning``.

    The file's metadata hold, as JSON under ``phframe``, the format, the settings and the environments.

    Raises:
        NotInstalledError: If pyarrow is not installed.
        OSError: If the file cannot be written.
    """
    try:
        import pyarrow
        from pyarrow.parquet import ParquetWriter
    except ImportError as error:
        raise NotInstalledError("the format 'parquet'", "pyarrow", 'pip install "phframe[parquet]"') from error
    fields = [_field(pyarrow, column) for column in COLUMNS]
    schema = pyarrow.schema(fields, metadata={HEADER: json.dumps(content.header(), allow_nan=False).encode()})
    with ParquetWriter(path, schema) as writer:
        for group in _groups(content.results):
            columns = [
                pyarrow.array([_value(column, result) for result in group], field.type)
                for column, field in zip(COLUMNS, fields, strict=True)
            ]
            writer.write_table(pyarrow.Table.from_arrays(columns, schema=schema))


def _groups(results: Iterable[TrialResult]) -> Iterator[list[TrialResult]]:
    rest = iter(results)
    while group := list(islice(rest, GROUP)):
        yield group


def _field(pyarrow: Any, column: ResultColumn) -> Any:
    types = {
        ColumnKind.TEXT: pyarrow.string(),
        ColumnKind.BOOLEAN: pyarrow.bool_(),
        ColumnKind.INTEGER: pyarrow.int64(),
        ColumnKind.NUMBER: pyarrow.float64(),
        ColumnKind.COUNTS: pyarrow.map_(pyarrow.string(), pyarrow.int64()),
    }
    told = {"unit": column.unit, "meaning": column.meaning}
    return pyarrow.field(column.name, types[column.kind], nullable=column.optional, metadata=told)


def _value(column: ResultColumn, result: TrialResult) -> Any:
    value = plain_value(column, result)
    return list(value.items()) if column.kind is ColumnKind.COUNTS else value
