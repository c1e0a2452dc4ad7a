"""Asking a person in the terminal what a planner is to do next."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager

from phframe.cli.console import error_console
from phframe.cli.shelf_picture import labels, shelf_picture
from phframe.core import NOBODY, Advisor, Hint, Question

FORM = "OBJECT X Y, such as"
BESIDE_PICTURE = 5
"""Lines and columns of the terminal that the picture leaves free."""
SMALLEST, LARGEST = (20, 8), (100, 40)
"""Columns and lines of the picture."""


def terminal_advisor(aside: Callable[[], AbstractContextManager[None]]) -> Advisor:
    """The person at the terminal, if there is one: where standard input and standard error both are terminals.

    Args:
        aside: Makes room on the screen for as long as it is entered.
    """
    there = all(stream is not None and stream.isatty() for stream in (sys.stdin, sys.stderr))  # None: closed
    return TerminalAdvisor(aside) if there else NOBODY


class TerminalAdvisor:
    """Shows the shelf on standard error and reads the answer from standard input.

    Args:
        aside: Makes room on the screen for as long as it is entered.
    """

    def __init__(self, aside: Callable[[], AbstractContextManager[None]]) -> None:
        self._aside, self._console = aside, error_console()

    def advise(self, question: Question) -> Hint | None:
        """Draw the shelf anew and read one answer; None: the input has ended."""
        with self._aside():
            self._draw(question)
            while line := self._read():
                hint = parse_hint(line, question)
                if isinstance(hint, Hint):
                    return hint
                self._say(hint)
            self._say("")
            return None

    def _draw(self, question: Question) -> None:
        console, (least, most) = self._console, (SMALLEST, LARGEST)
        columns, rows = (
            min(max(size - BESIDE_PICTURE, low), high)
            for size, low, high in zip((console.width - 20, console.height), least, most, strict=True)
        )
        console.clear()
        console.print(shelf_picture(question, columns, rows), soft_wrap=True)
        if question.refusal:
            self._say(f"That cannot be: {question.refusal.rstrip('.')}.")
        self._say(f"{question.blocker} (x) blocks the way to {question.scene.target} (*). What is to go where?")

    def _read(self) -> str:
        """A line that was typed; empty at the end of the input."""
        self._console.print("OBJECT X Y (m; Ctrl-D gives up): ", end="", markup=False)
        return sys.stdin.readline()

    def _say(self, text: str) -> None:
        self._console.print(text, markup=False, soft_wrap=True)


def parse_hint(line: str, question: Question) -> Hint | str:
    """The hint in what somebody typed, such as ``object_3 0.30 0.45``; what is wrong with it, where it is none.

    An object may be called by its label in the picture.
    """
    words = line.replace(",", " ").split()
    figures = [_figure(word) for word in words[1:]]
    if len(figures) != 2 or figures[0] is None or figures[1] is None:
        x, y = question.state.positions[question.scene.index(question.blocker)]
        return f"Expected {FORM}: {question.blocker} {x:.2f} {y:.2f}"
    ids = {label: name for name, label in labels(question.scene).items()}
    return Hint(words[0] if words[0] in question.scene.ids else ids.get(words[0], words[0]), (figures[0], figures[1]))


def _figure(word: str) -> float | None:
    try:
        value = float(word)
    except ValueError:
        return None
    return value if math.isfinite(value) else None
