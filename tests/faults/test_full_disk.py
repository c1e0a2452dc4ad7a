"""The n-th time that something is written fails, for every n: nothing is lost unsaid, nothing half is left."""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from phframe.cli.main import app
from phframe.core import Episode
from phframe.runtime.files import load
from tests.trials import tried

pytestmark = pytest.mark.slow
COMMAND = ("solve", "vieira/simple-07", "--no-rerun", "--json", "--out", "out")
WRITES = ((os, "open"), (os, "replace"), (os, "mkdir"), (os, "fsync"), (os, "chmod"), (Path, "write_bytes"))
"""What a file takes to be written."""


class Failing:
    """Counts what is written, and has one of the times fail.

    Args:
        at: Which, counted from 0.
        code: How.
    """

    def __init__(self, at: int, code: int) -> None:
        self._at, self._code = at, code
        self.count = 0

    def wrap(self, function: Callable[..., Any]) -> Callable[..., Any]:
        def called(*args: Any, **named: Any) -> Any:
            if function is os.open and not args[1] & (os.O_WRONLY | os.O_RDWR):
                return function(*args, **named)
            self.count += 1
            if self.count - 1 == self._at:
                raise OSError(self._code, os.strerror(self._code))
            return function(*args, **named)

        return called


def solved(at: int, code: int, patch: pytest.MonkeyPatch) -> tuple[Result, int]:
    with patch.context() as patched:
        failing = Failing(at, code)
        for owner, name in WRITES:
            patched.setattr(owner, name, failing.wrap(getattr(owner, name)))
        result = CliRunner().invoke(app, COMMAND, prog_name="phframe")
    return result, failing.count


@pytest.fixture(autouse=True)
def workplace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def check(result: Result, folder: Path) -> None:
    """What holds whatever went wrong."""
    assert result.exit_code in (0, 2), result.output
    assert not list(folder.glob("**/.*.part"))
    if result.exit_code == 0:
        assert json.loads(result.stdout)["status"] == "retrieved"
        assert json.loads((folder / "summary.json").read_text())["status"] == "retrieved"
        assert isinstance(load(folder / "episode.json"), Episode)
        return
    assert result.stdout == ""
    [line] = result.stderr.splitlines()
    assert line.startswith("error: cannot write ")
    assert "internal" not in line
    if (folder / "episode.json").exists():
        assert isinstance(load(folder / "episode.json"), Episode)
        assert f"what was done until then is in {folder.name}" in line
    else:
        assert "what was done until then" not in line


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EIO], ids=["ENOSPC", "EIO"])
def test_whichever_write_fails(code: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    at, codes = 0, []
    while True:
        place = tmp_path / str(at)
        place.mkdir()
        monkeypatch.chdir(place)
        result, count = solved(at, code, monkeypatch)
        tried("inputs: a write that fails")
        check(result, place / "out")
        codes.append(result.exit_code)
        if count <= at:
            break
        at += 1
    assert at > 20
    assert codes[-1] == 0, "no write failed"
    assert 2 in codes
