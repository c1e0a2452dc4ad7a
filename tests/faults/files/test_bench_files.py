"""Benches whose file says anything: results that can be reported and exported, or one line that names the file."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from phframe.bench.environment import Environment
from phframe.bench.export.content import ExportContent
from phframe.bench.export.text import csv_lines, json_lines
from phframe.bench.report.data import BenchSource, gather
from phframe.bench.rows import COLUMNS, from_row, to_row
from phframe.bench.settings import BenchSettings
from phframe.bench.trial_result import spec_of
from phframe.core import InputError
from tests.bench.synthetic import ENVIRONMENT, SETTINGS, synthetic_result
from tests.faults.files.spoiling import a_line, spoilt
from tests.trials import many, tried

RESULT = synthetic_result(0)
ROW = dict(zip(COLUMNS, to_row(RESULT), strict=True))


def _spoilt_json(text: str) -> st.SearchStrategy[str]:
    return spoilt(json.loads(text)).map(json.dumps)


ROWS = st.one_of(
    spoilt(ROW),
    st.builds(
        lambda name, held: {**ROW, name: held}, st.sampled_from(COLUMNS), st.sampled_from((b"", b"\xff\0", b"1"))
    ),
    _spoilt_json(RESULT.spec).map(lambda spec: {**ROW, "spec": spec}),
)
"""Rows of the table of results."""


def whole(rows: list[Any]) -> None:
    """See that all can be made of results that is made of them."""
    source = BenchSource("bench", tuple(rows), SETTINGS, {ENVIRONMENT.id: ENVIRONMENT})
    for row in rows:
        assert from_row(to_row(row)) == row
    content = ExportContent(rows, SETTINGS, {ENVIRONMENT.id: ENVIRONMENT})
    json.loads("".join(json_lines(content)))
    "".join(csv_lines(content)).encode()
    gather([source])
    for row in rows:
        spec_of(row).key()


def _kept(value: Any) -> Any:
    """What SQLite has of a value: it knows no numbers that are none."""
    return None if isinstance(value, float) and math.isnan(value) else value


def judged(row: Any) -> Any:
    """The result in a row, of which all can be made; or what is wrong with it, a line."""
    if not isinstance(row, dict) or set(row) != set(COLUMNS):
        return "no row"
    try:
        result = from_row(tuple(_kept(row[name]) for name in COLUMNS))
    except ValueError as error:
        return a_line(error)
    try:
        whole([result])
    except InputError as error:
        return a_line(error)
    return result


@settings(max_examples=many(60), deadline=None)
@given(row=ROWS)
def test_whatever_a_row_says_it_is_a_result_or_one_line(row: Any) -> None:
    tried("inputs: rows of a bench that say something else")
    judged(row)


@pytest.mark.parametrize(
    ("column", "held"),
    [("largest_prediction_error", "nan"), ("planning_time", "nan"), ("spec", '"\\ud800"'), ("seed", b"x")],
)
def test_rows_that_went_wrong_once_are_one_line(column: str, held: object) -> None:
    assert isinstance(judged({**ROW, column: held}), str)


def test_settings_with_a_limit_that_is_no_number_are_one_line() -> None:
    with pytest.raises(InputError, match="no settings of a bench"):
        BenchSettings.from_json(SETTINGS.to_json().replace("30.0", "Infinity"))


@settings(max_examples=many(30), deadline=None)
@given(text=_spoilt_json(SETTINGS.to_json()) | _spoilt_json(ENVIRONMENT.to_json()))
def test_whatever_a_bench_says_of_itself_it_is_read_or_one_line(text: str) -> None:
    tried("inputs: settings and environments of a bench that say something else")
    for kind in (BenchSettings, Environment):
        try:
            read = kind.from_json(text)
        except InputError as error:
            a_line(error)
        else:
            assert kind.from_json(read.to_json()) == read
            read.to_json().encode()
