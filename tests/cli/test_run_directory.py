from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier

import pytest

from phframe.cli.run_directory import RunDirectory
from phframe.core.errors import InputError


def test_it_is_made_only_when_asked_for() -> None:
    directory = RunDirectory(None)
    assert not Path("runs").exists()
    path = directory.make("vieira/basic", "./My Planner.py:Mine")
    assert path.is_dir()
    assert path.parent == Path("runs")
    assert path.name.endswith("-vieira-basic-my-planner-py-mine")


def test_runs_that_start_in_the_same_second_never_share_a_directory() -> None:
    with ThreadPoolExecutor(8) as pool:
        paths = list(pool.map(lambda _: RunDirectory(None).make("s", "p"), range(40)))
    assert len(set(paths)) == 40


def test_strange_and_long_names_become_a_plain_directory_below_runs() -> None:
    for name in ("../../etc", "", "日本", "x" * 5000, "a\0b"):
        path = RunDirectory(None).make(name, name)
        assert path.parent == Path("runs")
        assert len(path.name) < 120


def test_the_directory_asked_for_may_be_new_or_empty() -> None:
    assert RunDirectory(Path("a/b/c")).make() == Path("a/b/c")
    assert RunDirectory(Path("a/b/c")).make() == Path("a/b/c")
    Path("a/b/c/file").write_text("")
    with pytest.raises(InputError, match="not empty"):
        RunDirectory(Path("a/b/c"))


def test_a_directory_filled_since_it_was_checked_is_not_touched() -> None:
    directory = RunDirectory(Path("a"))
    Path("a").mkdir()
    Path("a/file").write_text("")
    with pytest.raises(InputError, match="not empty"):
        directory.make()


@pytest.mark.skipif(sys.platform == "win32", reason="which has no locks of directories")
def test_of_runs_that_are_given_one_directory_at_once_one_has_it(tmp_path: Path) -> None:
    for there in (False, True):
        place = tmp_path / str(there)
        if there:
            place.mkdir()
        runs = [RunDirectory(place) for _ in range(8)]
        start = Barrier(len(runs))

        def made(run: RunDirectory, start: Barrier = start) -> str:
            start.wait()
            try:
                run.make()
            except InputError as error:
                return str(error)
            return ""

        with ThreadPoolExecutor(len(runs)) as pool:
            said = sorted(pool.map(made, runs))
        assert said[0] == ""
        assert all("in use by another run" in each for each in said[1:])
        for run in runs:
            run.discard_if_empty()
        assert not place.exists()
        RunDirectory(place).make()


def test_only_an_empty_directory_is_discarded() -> None:
    directory = RunDirectory(Path("a"))
    path = directory.make()
    (path / "file").write_text("")
    directory.discard_if_empty()
    assert path.exists()
    (path / "file").unlink()
    directory.discard_if_empty()
    assert not path.exists()
    assert directory.path is None
