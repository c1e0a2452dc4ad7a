"""The commands of each document run, in order, in a clean folder."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from importlib import metadata
from pathlib import Path

import pytest

from tests.markdown import PAGES, ROOT, blocks, marks_of, named

LEFT_OUT = (
    "make ",  # what tests are run by
    "python -m pip ",  # changes the environment
    "python -m phframe.bench.meters calibrate",  # three minutes
    "python -m phframe.bench.meters ensemble",  # the same
    "python -m phframe.bench.meters certainty",  # the same
    "phframe report runs/paper",  # of a bench that is only listed here
)
"""Beginnings of the commands that are not run, and why."""
WITHOUT = ("--view", "--video baxter.mp4")
"""What commands are run without: a viewer needs a screen, and that video takes minutes."""
LISTED = ("phframe bench paper ", "phframe bench vieira papallas ", "phframe bench vieira/basic vieira/example-02 ")
"""Beginnings of the benches of which only the trials are listed: they take minutes."""


def commands(page: Path) -> list[str]:
    """The commands of a page, in order."""
    lines = [line[2:] for block in blocks("console") if block.page == page for line in block.text.splitlines()]
    run = [line.partition("  #")[0].strip() for line in lines if not line.startswith(LEFT_OUT)]
    return [f"{line} --list" if line.startswith(LISTED) else line for line in run]


def marks(page: Path) -> list[pytest.MarkDecorator]:
    """The extras that the commands of a page need."""
    words = [word for line in commands(page) for word in shlex.split(line)]
    extras = {"--video": "video", "import": "mujoco"}
    needed = [getattr(pytest.mark, f"needs_{extra}") for word, extra in extras.items() if word in words]
    return [pytest.mark.slow, *marks_of(words), *needed]


TOLD = [pytest.param(page, marks=marks(page), id=named(page)) for page in PAGES if commands(page)]


@pytest.mark.parametrize("page", TOLD)
def test_the_commands_of_a_document_run_in_order_in_a_clean_folder(page: Path, tmp_path: Path) -> None:
    if "lookahead" in "".join(commands(page)) and not _is_installed("phframe-lookahead"):
        pytest.skip("phframe-lookahead is not installed")
    for name in ("docs", "phframe"):
        (tmp_path / name).symlink_to(ROOT / name)
    for line in commands(page):
        done = _run(line, tmp_path)
        assert done.returncode == 0, f"{line}\n{done.stdout}\n{done.stderr}"
        assert not done.stderr.startswith("error")


def test_all_console_lines_are_commands_and_nothing_left_out_has_gone() -> None:
    lines = [line for block in blocks("console") for line in block.text.splitlines()]
    assert all(line.startswith("$ ") for line in lines)
    everything = "\n".join(line[2:] for line in lines)
    assert all(re.search(rf"^{re.escape(each)}", everything, re.MULTILINE) for each in LEFT_OUT)
    assert all(each in everything for each in (*WITHOUT, *LISTED))
    assert len(TOLD) >= 5


def _run(line: str, folder: Path) -> subprocess.CompletedProcess[str]:
    for each in WITHOUT:
        line = line.replace(f" {each}", "")
    words = shlex.split(line)
    settings = {}
    while re.match(r"[A-Z_]+=", words[0]):
        name, _, value = words.pop(0).partition("=")
        settings[name] = value
    assert words[0] == "phframe", f"how is this run? {line}"
    path = os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH")]))
    return subprocess.run(
        [sys.executable, "-m", *words],
        cwd=folder, env={**os.environ, "PYTHONPATH": path, **settings}, capture_output=True, text=True, check=False,
    )  # fmt: skip


def _is_installed(distribution: str) -> bool:
    try:
        return bool(metadata.version(distribution))
    except metadata.PackageNotFoundError:
        return False
