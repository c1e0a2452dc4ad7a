"""Whatever names hold, a terminal shows it and does nothing."""

from __future__ import annotations

import io
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.table import Table

from phframe.cli.console import deliver, emit, note, show
from phframe.cli.printable import LONGEST_MESSAGE, abridged, printable
from phframe.cli.rich_console import PrintableConsole
from tests.cli.conftest import Invoke

HOSTILE = {
    "clear the screen": "\x1b[2J",
    "a title": "\x1b]0;root\x07",
    "one byte": "\x9b2J",
    "back": "good\rbad",
    "erase": "a\b\b",
    "right to left": "\u202egnp.exe",
    "isolate": "\u2066a\u2069",
    "a line of Unicode": "a\u2028b",
    "invisible": "a\u200bb\u00ad",
    "half": "\ud800",
    "delete": "\x7f",
    "nothing": "\x00",
}


@pytest.mark.parametrize("text", HOSTILE.values(), ids=HOSTILE)
def test_what_would_move_the_terminal_is_escaped_everywhere(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    table = Table(text)
    table.add_row(text)
    note(text)
    emit(text)
    show(table)
    for written in capsys.readouterr():
        assert written.replace("\n", "").isprintable()
        assert "\\" in written


def test_a_document_is_what_a_file_holds_unless_a_terminal_shows_it(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    text = "a\rb\x1b[2J\u2028"
    deliver(text)
    assert capsys.readouterr().out == f"{text}\n"
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    deliver(text)
    assert capsys.readouterr().out == "a\\rb\\x1b[2J\\u2028\n"


def test_progress_shows_and_does_not_obey() -> None:
    terminal = io.StringIO()
    console = PrintableConsole(file=terminal, force_terminal=True, highlight=False)
    with console.status("\x1b]0;root\x07"):
        console.print("\x1b[2J")
    assert "\x1b]" not in terminal.getvalue()
    assert "\x1b[2J" not in terminal.getvalue()
    assert "\x1b[" in terminal.getvalue(), "rich's own controls"


@given(st.text())
def test_any_text_becomes_printable_and_what_is_printable_stays(text: str) -> None:
    shown = printable(text)
    assert all(letter.isprintable() or letter in "\n\t" or letter.isspace() for letter in shown)
    assert printable(shown) == shown
    assert shown == text or not text.replace("\n", "").isprintable()


def test_letters_of_all_people_stay() -> None:
    for text in ("Müller", "物体", "œuvre", "مكتبة", "a\tb", "\N{NO-BREAK SPACE}"):
        assert printable(text) == text


def test_long_words_and_messages_are_shortened() -> None:
    text = abridged(f"no planner named {'x' * 10**6!r}. There is: phia")
    assert text.startswith("no planner named 'xxx")
    assert text.endswith("xxx'. There is: phia")
    assert len(text) < 300
    assert len(abridged("a b " * 10**5)) == LONGEST_MESSAGE + 3
    path = f"/home/{'directory/' * 20}"
    assert abridged(path) == path


@pytest.mark.parametrize(
    "arguments", [["solve"], ["scenes"], ["export"], ["replay"], ["scene", "import"], ["planners"]]
)
@pytest.mark.parametrize("name", ["\x1b[2J", "\u202e", "y" * 100_000, "a b" * 50_000])
def test_a_hostile_argument_is_one_short_printable_line(
    invoke: Invoke, workplace: Path, arguments: list[str], name: str
) -> None:
    result = invoke(*arguments, name)
    assert result.exit_code in (2, 3)
    assert result.stderr.startswith("error: ")
    assert result.stderr.removesuffix("\n").isprintable()
    assert len(result.stderr) < LONGEST_MESSAGE + 20
    assert list(workplace.iterdir()) == []
