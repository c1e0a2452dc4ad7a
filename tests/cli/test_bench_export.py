"""``phframe bench export``."""

from __future__ import annotations

import csv
import json
import resource
import signal
import sqlite3
import sys
from contextlib import closing
from pathlib import Path

import pytest

from phframe.bench.export.columns import COLUMNS
from tests.bench.synthetic import hostile_result, synthetic_results, written_store
from tests.cli.conftest import Invoke

COUNT = 1500
"""More than what is written at a time."""


@pytest.fixture
def bench(workplace: Path) -> str:
    written_store(workplace / "bench", [hostile_result(), *list(synthetic_results(COUNT))[8:]])
    return "bench"


def rows(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(text.splitlines(keepends=True), strict=True))


def test_a_table_on_standard_output(invoke: Invoke, bench: str) -> None:
    result = invoke("bench", "export", bench)
    assert (result.exit_code, result.stderr) == (0, "")
    found = rows(result.stdout)
    assert len(found) == COUNT - 7
    assert list(found[0]) == [column.name for column in COLUMNS]
    assert hostile_result().reason in [row["reason"] for row in found]


def test_json_on_standard_output_is_one_object(invoke: Invoke, bench: str) -> None:
    result = invoke("bench", "export", bench, "--format", "json")
    found = json.loads(result.stdout)
    assert list(found) == ["format", "settings", "environments", "results"]
    assert len(found["results"]) == COUNT - 7


@pytest.mark.parametrize(
    ("name", "begins"),
    [
        ("a.csv", b"key,suite,"),
        ("a.json", b'{"format": 1, "settings": '),
        ("a.db", b"SQLite format 3\0"),
        pytest.param("a.parquet", b"PAR1", marks=pytest.mark.needs_parquet),
    ],
)
def test_the_files_name_tells_the_format(invoke: Invoke, bench: str, name: str, begins: bytes) -> None:
    result = invoke("bench", "export", bench, "--out", name)
    assert (result.exit_code, result.stdout, result.stderr) == (0, "", f"wrote {name}\n")
    assert Path(name).read_bytes().startswith(begins)
    assert sorted(path.name for path in Path.cwd().iterdir()) == [name, "bench"]


def test_a_file_and_standard_output_say_the_same(invoke: Invoke, bench: str) -> None:
    printed = invoke("bench", "export", bench).stdout
    assert invoke("bench", "export", bench, "--out", "a.csv").exit_code == 0
    assert Path("a.csv").read_bytes().decode() == printed


def test_planner_arena_has_every_result(invoke: Invoke, bench: str) -> None:
    assert invoke("bench", "export", bench, "--format", "plannerarena", "--out", "arena").exit_code == 0
    with closing(sqlite3.connect("arena")) as database:
        assert database.execute("SELECT count(*) FROM runs").fetchone() == (COUNT - 7,)


def test_a_file_is_not_overwritten_unless_forced(invoke: Invoke, bench: str) -> None:
    Path("a.csv").write_text("years of work")
    refused = invoke("bench", "export", bench, "--out", "a.csv")
    assert refused.exit_code == 2
    assert "--force" in refused.stderr
    assert Path("a.csv").read_text() == "years of work"
    assert invoke("bench", "export", bench, "--out", "a.csv", "--force").exit_code == 0
    assert len(rows(Path("a.csv").read_text())) == COUNT - 7


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["nothing"], "nothing holds no bench"),
        (["bench", "--format", "cvs"], "Did you mean 'csv'?"),
        (["bench", "--format", "plannerarena"], "name a file with --out, such as results.db"),
        (["bench", "--out", "missing\0"], "not a path"),
    ],
)
def test_bad_input_is_told_in_a_line(invoke: Invoke, bench: str, arguments: list[str], told: str) -> None:
    assert bench == "bench"
    result = invoke("bench", "export", *arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert told in result.stderr
    assert len(result.stderr.splitlines()) == 1


def test_a_bench_without_results(invoke: Invoke, workplace: Path) -> None:
    written_store(workplace / "bench", [])
    assert rows(invoke("bench", "export", "bench").stdout) == []
    assert json.loads(invoke("bench", "export", "bench", "--format", "json").stdout)["results"] == []
    refused = invoke("bench", "export", "bench", "--out", "a.db")
    assert refused.exit_code == 2
    assert "no results yet" in refused.stderr
    assert [path.name for path in workplace.iterdir()] == ["bench"]


def test_a_damaged_bench_leaves_no_file(invoke: Invoke, bench: str, workplace: Path) -> None:
    file = workplace / bench / "results.sqlite"
    content = bytearray(file.read_bytes())
    content[len(content) // 2 :] = b"\xff" * (len(content) - len(content) // 2)
    file.write_bytes(content)
    for name in ("a.csv", "a.json", "a.db"):
        assert invoke("bench", "export", bench, "--out", name).exit_code == 2
    assert [path.name for path in workplace.iterdir()] == [bench]


def test_without_pyarrow_the_line_that_installs_it_is_told(
    invoke: Invoke, bench: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    result = invoke("bench", "export", bench, "--out", "a.parquet")
    assert result.exit_code == 3
    assert "pyarrow" in result.stderr
    assert not Path("a.parquet").exists()


def test_a_full_disk_is_told_and_leaves_nothing(invoke: Invoke, bench: str) -> None:
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    before = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, limits[1]))
    try:
        results = [invoke("bench", "export", bench, "--out", name) for name in ("a.csv", "a.json", "a.db")]
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, before)
    assert [result.exit_code for result in results] == [2] * 3
    assert all("cannot write a." in result.stderr for result in results)
    assert [path.name for path in Path.cwd().iterdir()] == [bench]
