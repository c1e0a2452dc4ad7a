"""``phframe bench --scheduler``: what is wrong is told before anything is made."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Invoke

COMMAND = ("bench", "vieira/basic", "--scheduler", "tcp://127.0.0.1:1", "--out", "results")


def test_without_dask_the_line_that_installs_it_is_told(
    invoke: Invoke, workplace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    result = invoke(*COMMAND)
    assert (result.exit_code, result.stdout) == (3, "")
    assert "a bench on a cluster needs distributed, which is not installed. " in result.stderr
    assert list(workplace.iterdir()) == []


@pytest.mark.needs_cluster
def test_workers_of_this_machine_are_none_of_a_clusters(invoke: Invoke, workplace: Path) -> None:
    pytest.importorskip("distributed")
    result = invoke(*COMMAND, "--workers", "2")
    assert result.exit_code == 2
    assert "--workers is for this machine" in result.stderr
    assert list(workplace.iterdir()) == []
