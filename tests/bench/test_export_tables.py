"""What is exported as CSV, JSON and Parquet is read back as the same results."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.bench.export.columns import COLUMNS, ColumnKind
from phframe.bench.export.content import ExportContent
from phframe.bench.export.parquet_ import GROUP, HEADER, write_parquet
from phframe.bench.export.text import csv_lines, json_lines
from phframe.bench.trial_result import TrialEnd, TrialResult
from tests.bench.synthetic import ENVIRONMENT, SETTINGS, any_result, hostile_result, synthetic_result, synthetic_results

MANY = st.lists(any_result(), max_size=3)


def content(results: Iterable[TrialResult]) -> ExportContent:
    return ExportContent(results, SETTINGS, {ENVIRONMENT.id: ENVIRONMENT})


def read_back(row: Mapping[str, Any]) -> TrialResult:
    """The result of a row whose values have their types."""
    return TrialResult(**{**row, "end": TrialEnd(row["end"]), "deviations": dict(row["deviations"])})


def from_csv(text: str) -> list[TrialResult]:
    read: dict[ColumnKind, Any] = {
        ColumnKind.TEXT: str,
        ColumnKind.BOOLEAN: json.loads,
        ColumnKind.INTEGER: int,
        ColumnKind.NUMBER: lambda cell: float(cell) if cell else None,
        ColumnKind.COUNTS: json.loads,
    }
    rows = csv.DictReader(io.StringIO(text, newline=""), strict=True)
    return [read_back({each.name: read[each.kind](row[each.name]) for each in COLUMNS}) for row in rows]


def from_json(text: str) -> list[TrialResult]:
    rows = json.loads(text, parse_constant=pytest.fail)["results"]
    numbers = [each.name for each in COLUMNS if each.kind is ColumnKind.NUMBER]
    return [read_back({**row, **{name: row[name] and float(row[name]) for name in numbers}}) for row in rows]


def from_parquet(path: Path) -> list[TrialResult]:
    from pyarrow.parquet import read_table

    return [read_back(row) for row in read_table(path).to_pylist()]


def joined(lines: Iterable[str]) -> str:
    return "".join(f"{line}\n" for line in lines)


@given(MANY)
def test_csv_is_read_back(results: list[TrialResult]) -> None:
    text = joined(csv_lines(content(results)))
    assert text.encode().decode() == text
    assert from_csv(text) == results


@given(MANY)
def test_json_is_read_back(results: list[TrialResult]) -> None:
    text = joined(json_lines(content(results)))
    assert text.isascii()
    assert from_json(text) == results


@pytest.mark.needs_parquet
@given(MANY)
def test_parquet_is_read_back(tmp_path_factory: pytest.TempPathFactory, results: list[TrialResult]) -> None:
    path = tmp_path_factory.mktemp("parquet") / "a.parquet"
    write_parquet(content(results), path)
    assert from_parquet(path) == results


@pytest.mark.parametrize("results", [[], [hostile_result()], [synthetic_result(0), hostile_result()]], ids=len)
def test_none_and_one_and_hostile_ones_are_read_back(results: list[TrialResult]) -> None:
    assert from_csv(joined(csv_lines(content(results)))) == results
    assert from_json(joined(json_lines(content(results)))) == results


@pytest.mark.needs_parquet
@pytest.mark.parametrize("count", [0, 1, GROUP + 1])
def test_parquet_of_any_length_tells_units_and_where_it_ran(tmp_path: Path, count: int) -> None:
    from pyarrow.parquet import ParquetFile

    write_parquet(content(synthetic_results(count)), tmp_path / "a.parquet")
    assert from_parquet(tmp_path / "a.parquet") == list(synthetic_results(count))
    with ParquetFile(tmp_path / "a.parquet") as file:
        assert file.num_row_groups == -(-count // GROUP)
        told = {field.name: field.metadata[b"unit"].decode() for field in file.schema_arrow}
        assert told == {column.name: column.unit for column in COLUMNS}
        header = json.loads(file.schema_arrow.metadata[HEADER])
    assert header["environments"][ENVIRONMENT.id]["cpu"] == ENVIRONMENT.cpu
    assert header["settings"]["loop"]["time_limit"] == SETTINGS.loop.time_limit


def test_a_text_that_cannot_be_written_is_escaped_and_no_other() -> None:
    assert hostile_result().reason == (
        "two\nlines\r, a \"quote\", 'another', a comma, \ttabs\\n, ünï¢ödé, NUL \\x00, half a surrogate \\udc80 \u2028 <b>"
    )
    assert "\\x00" in next(iter(hostile_result().deviations))


def test_every_column_is_a_field_with_a_meaning_and_every_quantity_has_a_unit() -> None:
    assert [column.name for column in COLUMNS] == [each.name for each in fields(TrialResult)]
    for column in COLUMNS:
        assert column.meaning, column.name
        assert bool(column.unit) == (column.kind is ColumnKind.NUMBER or column.name == "peak_memory"), column.name
        assert not column.unit or column.unit == "s" or not column.name.endswith("_time"), column.name
