from __future__ import annotations

import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import pytest

from phframe.core import InputError, Planner, PluginError, UnknownNameError
from phframe.registry import Kind, create, load
from tests.registry.conftest import STRAIGHT


@pytest.fixture
def mine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A file with a planner in the current folder."""
    path = tmp_path / "mine.py"
    path.write_text(STRAIGHT, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    before = set(sys.modules)
    yield path
    for name in set(sys.modules) - before:
        if name.startswith("phframe_file_"):
            del sys.modules[name]


@pytest.mark.parametrize("spec", ["mine.py:Straight", "./mine.py:Straight", "{path}:Straight"])
def test_a_class_is_loaded_from_a_file(mine: Path, spec: str) -> None:
    loaded = load(Kind.PLANNER, spec.format(path=mine))
    assert issubclass(loaded, Planner)
    assert loaded is load(Kind.PLANNER, "mine.py:Straight")
    assert loaded.__module__ not in ("mine", "__main__")


def test_files_of_the_same_name_do_not_mix(mine: Path) -> None:
    other = mine.parent / "other"
    other.mkdir()
    (other / "mine.py").write_text(STRAIGHT, encoding="utf-8")
    assert load(Kind.PLANNER, "mine.py:Straight") is not load(Kind.PLANNER, "other/mine.py:Straight")


def test_an_edited_file_is_loaded_anew(mine: Path) -> None:
    assert create(Kind.PLANNER, "mine.py:Straight").options.tries == 3
    mine.write_text(STRAIGHT.replace("= 3", "= 5"), encoding="utf-8")
    assert create(Kind.PLANNER, "mine.py:Straight").options.tries == 5


def test_nothing_is_left_beside_the_file(mine: Path) -> None:
    load(Kind.PLANNER, "mine.py:Straight")
    assert list(mine.parent.iterdir()) == [mine]


def test_a_dataclass_in_a_file_finds_its_module(mine: Path) -> None:
    lines = "from __future__ import annotations\nfrom dataclasses import dataclass\n"
    lines += "@dataclass\nclass Node:\n    depth: int\n"
    mine.write_text(lines + STRAIGHT, encoding="utf-8")
    assert load(Kind.PLANNER, "mine.py:Straight").__name__ == "Straight"


def test_no_such_file(mine: Path) -> None:
    with pytest.raises(InputError, match=r"cannot read yours\.py: no such file or directory"):
        load(Kind.PLANNER, "./yours.py:Straight")
    (mine.parent / "folder.py").mkdir()
    with pytest.raises(InputError, match=r"cannot read folder\.py: is a directory"):
        load(Kind.PLANNER, "folder.py:Straight")


@pytest.mark.usefixtures("mine")
def test_no_such_class_lists_those_that_would_do() -> None:
    with pytest.raises(UnknownNameError) as caught:
        load(Kind.PLANNER, "mine.py:Strait")
    assert str(caught.value) == ("no Planner in mine.py named 'Strait'. Did you mean 'Straight'? There is: Straight.")
    with pytest.raises(UnknownNameError, match=r"There is no ArmModel in mine\.py at all"):
        load(Kind.ARM, "mine.py:Strait")


@pytest.mark.usefixtures("mine")
@pytest.mark.parametrize("spec", ["mine.py", "mine.py:"])
def test_a_file_alone_is_not_enough(spec: str) -> None:
    with pytest.raises(InputError, match=r"say which class of mine\.py is meant, such as mine\.py:Straight"):
        load(Kind.PLANNER, spec)


@pytest.mark.usefixtures("mine")
def test_the_class_must_be_of_the_right_kind() -> None:
    with pytest.raises(PluginError, match=r"'mine\.py:Choice' is not a subclass of phframe\.core\.Planner"):
        load(Kind.PLANNER, "mine.py:Choice")


@pytest.mark.parametrize(
    ("source", "error"),
    [
        ("x = 1\ndef f(:\n", r"mine\.py, line 2: invalid syntax"),
        ("x = 1\n\nimport no_such\n", r"mine\.py, line 3: ModuleNotFoundError: No module named 'no_such'"),
        ("def f():\n    return 1 / 0\nf()\n", r"mine\.py, line 2: ZeroDivisionError"),
        ("raise SystemExit(2)\n", r"mine\.py, line 1: SystemExit: 2"),
        ("x = '\0'\n", r"mine\.py.*null bytes"),
    ],
)
def test_a_file_that_does_not_run_is_reported_with_its_line(mine: Path, source: str, error: str) -> None:
    mine.write_text(source, encoding="utf-8")
    before = set(sys.modules)
    with pytest.raises(PluginError, match=error):
        load(Kind.PLANNER, "mine.py:Straight")
    assert {name for name in set(sys.modules) - before if name.startswith("phframe_file_")} == set()


def options_of(spec: str) -> dict[str, int]:
    """What a worker makes of a spec."""
    return dict(create(Kind.PLANNER, spec).options)


def test_a_spec_is_all_that_a_worker_process_needs(mine: Path) -> None:
    made = create(Kind.PLANNER, "mine.py:Straight")
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as workers:
        assert workers.submit(options_of, f"{mine}:Straight").result() == dict(made.options) == {"tries": 3}
