"""How much the suites of fault injection try, and a count of it, by class, over all processes of the tests."""

from __future__ import annotations

import os
from collections import Counter
from pathlib import Path

TIMES = int(os.environ.get("PHFRAME_TEST_TIMES", "1"))
"""How many times as much is tried as usual; see ``make trials``."""
NOTES = "PHFRAME_TEST_TRIALS"
"""Environment variable with the path of the file that takes notes."""


def many(number: int) -> int:
    """How many are to be tried, of what is usually tried so many times."""
    return number * TIMES


def tried(kind: str, number: int = 1) -> None:
    """Note that something of a class was tried: an input, a process, a signal.

    Args:
        kind: The class, such as "inputs: scene files".
        number: How many.
    """
    if path := os.environ.get(NOTES):
        with Path(path).open("a", encoding="utf-8") as notes:
            notes.write(f"{number} {kind}\n")


def counted(path: Path) -> Counter[str]:
    """What was tried of each class, according to the notes."""
    counts: Counter[str] = Counter()
    for line in path.read_text(encoding="utf-8").splitlines():
        number, _, kind = line.partition(" ")
        counts[kind] += int(number)
    return counts
