"""What distributions answer is kept for as long as no file has changed that it comes from."""

from __future__ import annotations

import os
import shutil
from importlib import metadata
from pathlib import Path

import pytest

from phframe.core.errors import InputError
from phframe.registry import Catalogue, Kind, discover
from phframe.registry.answer import MOST_BYTES, Answer, from_json, to_json
from tests.registry.conftest import Install

pytestmark = pytest.mark.slow

SOURCE = """
import os
with open(os.environ["RAN"], "a") as file:
    file.write("x")
from plugin_helper import NAME

@hookimpl
def phframe_extensions():
    return [Extension(Kind.PLANNER, NAME, 'MODULE:Straight', 'A test', api_version=2)]
"""


class Answers:
    """One distribution, and how often it has been asked.

    Args:
        folder: Where everything is.
    """

    def __init__(self, folder: Path) -> None:
        self.site, self.cache, self.helper = folder / "site", folder / "cache" / "plugins", folder / "plugin_helper.py"
        self._ran = folder / "ran"
        self.help("one")

    def help(self, name: str) -> None:
        """Have the plugin take the name of its planner from another module."""
        self.helper.write_text(f"NAME = {name!r}\n")
        age(self.helper)

    def found(self) -> Catalogue:
        return discover(metadata.distributions(path=[str(self.site)]))

    def planner(self) -> str:
        """The name of its planner, or what is wrong with it."""
        found = self.found()
        return found.broken[0].error if found.broken else found.extensions(Kind.PLANNER)[-1].name

    @property
    def asked(self) -> int:
        """How often."""
        return len(self._ran.read_text()) if self._ran.exists() else 0


def age(path: Path) -> None:
    """Have a file be older than what is asked from now on, and not as old as it was."""
    age.before += 10**9  # type: ignore[attr-defined]
    os.utime(path, ns=(age.before, age.before))  # type: ignore[attr-defined]


age.before = 10**18  # type: ignore[attr-defined]


@pytest.fixture
def answers(tmp_path: Path, install: Install, monkeypatch: pytest.MonkeyPatch) -> Answers:
    monkeypatch.setenv("PHFRAME_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("RAN", str(tmp_path / "ran"))
    monkeypatch.syspath_prepend(str(tmp_path))
    install("one", SOURCE)
    for path in [*(tmp_path / "site").rglob("*"), tmp_path / "site"]:
        age(path)
    return Answers(tmp_path)


def test_a_distribution_is_asked_once(answers: Answers) -> None:
    assert [answers.planner() for _ in range(3)] == ["one"] * 3
    assert answers.asked == 1


def test_it_is_asked_again_when_a_module_that_it_imports_has_changed(answers: Answers) -> None:
    assert answers.planner() == "one"
    answers.help("two")
    assert answers.planner() == "two"
    assert answers.asked == 2


@pytest.mark.parametrize("name", ["METADATA", "entry_points.txt", "RECORD"])
def test_it_is_asked_again_when_it_has_been_installed_anew(answers: Answers, name: str) -> None:
    answers.planner()
    path = answers.site / "one-1.0.dist-info" / name
    path.touch()
    age(path)
    answers.planner()
    assert answers.asked == 2


def test_a_broken_one_is_asked_again_when_something_has_been_installed(answers: Answers) -> None:
    answers.helper.rename(answers.helper.with_suffix(".away"))
    assert "No module named 'plugin_helper'" in answers.planner()
    asked = answers.asked
    answers.helper.with_suffix(".away").rename(answers.helper)
    assert answers.planner() == "one"
    assert answers.asked == asked + 1


def test_one_that_took_too_long_is_kept_for_a_while_only(answers: Answers, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PHFRAME_PLUGINS_SECONDS", "0.001")
    assert "gave no answer within 0.001 s" in answers.planner()
    monkeypatch.delenv("PHFRAME_PLUGINS_SECONDS")
    for path in answers.cache.iterdir():
        os.utime(path, (0, 0))
    assert answers.planner() == "one"


@pytest.mark.parametrize(
    "content", [b"", b"{", b"[]", b"[" * 10**5, b"\xff", b'{"answer": 3, "state": []}', b"x" * MOST_BYTES]
)
def test_a_kept_answer_that_cannot_be_read_is_replaced(answers: Answers, content: bytes) -> None:
    answers.planner()
    (path,) = answers.cache.iterdir()
    path.write_bytes(content)
    assert [answers.planner() for _ in range(2)] == ["one"] * 2
    assert answers.asked == 2


def test_nothing_is_kept_where_others_may_write(answers: Answers) -> None:
    answers.cache.mkdir(parents=True)
    answers.cache.chmod(0o777)
    assert answers.planner() == "one"
    assert list(answers.cache.iterdir()) == []


def test_nothing_is_kept_where_that_is_not_wanted(answers: Answers, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PHFRAME_CACHE", "")
    assert [answers.planner() for _ in range(2)] == ["one"] * 2
    assert answers.asked == 2
    assert not answers.cache.exists()


def test_where_nothing_can_be_kept_it_works_too(answers: Answers) -> None:
    shutil.rmtree(answers.cache.parent, ignore_errors=True)
    answers.cache.parent.write_text("a file")
    assert answers.planner() == "one"


@pytest.mark.parametrize("seconds", ["", "soon", "0", "-1", "nan", "inf"])
def test_a_limit_that_is_none_is_an_error(answers: Answers, monkeypatch: pytest.MonkeyPatch, seconds: str) -> None:
    monkeypatch.setenv("PHFRAME_PLUGINS_SECONDS", seconds)
    with pytest.raises(InputError, match="PHFRAME_PLUGINS_SECONDS is a number of seconds above 0, not"):
        answers.found()


def test_an_answer_survives_as_json() -> None:
    answer = Answer(files=("a", "b"), names=("one", "two"))
    assert from_json(to_json(answer)) == answer
    assert from_json("x" * (MOST_BYTES + 1)).error == f"its answer is longer than {MOST_BYTES >> 10} KB"
