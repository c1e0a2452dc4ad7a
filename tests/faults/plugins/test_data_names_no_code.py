"""Names that are read from a bench lead to registered extensions, never to code in a file that they name.

Those of episodes are tested in ``tests/cli/test_replay.py``.
"""

from __future__ import annotations

import sqlite3

import pytest

from tests.faults.plugins.conftest import Bench

pytestmark = pytest.mark.slow

RUNS = "open(__import__('os').environ['RAN'] + '/foreign', 'w')\n"
SMALL = ("bench", "run", "vieira/simple-07", "--planner", "ooa", "--out", "own", "--quiet")


def test_of_a_bench(bench: Bench) -> None:
    name = "./x.py:Cls[a=1]"
    (bench.work / "x.py").write_text(RUNS)
    assert bench.run(*SMALL).returncode == 0
    with sqlite3.connect(bench.work / "own" / "results.sqlite") as store:
        (key,) = store.execute("SELECT key FROM results").fetchone()
        for table, column in (("bench", "settings"), ("results", "spec")):
            for word in ("ooa", "planar", "pymunk", "ripser", "retrieve"):
                change = f"UPDATE {table} SET {column} = replace({column}, ?, ?)"
                store.execute(change, (f'"{word}"', f'"{name}"'))
        store.execute("UPDATE results SET planner = ?, arm = ?, backend = ?", 3 * [name])
    for command, codes in (
        (("bench", "replay", "own", key, "--no-rerun"), {2}),
        (("bench", "export", "own", "--out", "-"), {0, 2}),
        (("report", "own", "--out", "page.html"), {0, 2, 3}),
    ):
        done = bench.run(*command)
        assert "Traceback" not in done.stderr
        assert done.returncode in codes
    assert bench.ran == set()
