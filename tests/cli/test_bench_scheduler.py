"""``phframe bench --scheduler``: what is wrong is told before anything is made."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Invoke, Run

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
@pytest.mark.slow
@pytest.mark.parametrize(
    "address", ["localhost", "", " ", "tcp://10.0.0.1", "tcp://:8786", "foo://x:1", "tcp://x:0", "x:99999"]
)
def test_what_is_no_address_is_refused_before_anything_is_made(run: Run, workplace: Path, address: str) -> None:
    pytest.importorskip("distributed")
    result = run("bench", "vieira/basic", "--scheduler", address, "--out", "results")  # is ended after a minute
    assert (result.returncode, result.stdout, result.stderr.count("\n")) == (2, "", 1)
    assert f"no Dask scheduler at {address!r}: " in result.stderr
    assert list(workplace.iterdir()) == []


@pytest.mark.needs_cluster
def test_workers_of_this_machine_are_none_of_a_clusters(invoke: Invoke, workplace: Path) -> None:
    pytest.importorskip("distributed")
    result = invoke(*COMMAND, "--workers", "2")
    assert result.exit_code == 2
    assert "--workers is for this machine" in result.stderr
    assert list(workplace.iterdir()) == []
