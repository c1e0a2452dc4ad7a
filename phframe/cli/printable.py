"""Text that does to a terminal nothing but show: names come from files and plugins, and may hold what moves its cursor."""

from __future__ import annotations

import re
import unicodedata

LONGEST_WORD, KEPT_OF_WORD = 300, (150, 50)
"""Characters of a word in a message, and how many are shown of its beginning and end where it has more."""
LONGEST_MESSAGE = 4000
"""Characters of a message."""
_LAYOUT = "\n\t"


def printable(text: str) -> str:
    """A text with everything escaped that is no visible character: controls, and what turns the direction of writing.

    Line breaks and tabs stay.
    """
    if text.replace("\n", "").isprintable():
        return text
    return "".join(letter if _is_shown(letter) else _escaped(letter) for letter in text)


def abridged(text: str) -> str:
    """A message without the middle of endless words and without the end of what nobody reads."""
    text = re.sub(rf"\S{{{LONGEST_WORD + 1},}}", _abridged_word, text)
    return text if len(text) <= LONGEST_MESSAGE else f"{text[:LONGEST_MESSAGE]}..."


def _is_shown(letter: str) -> bool:
    """Whether it is a letter, mark, number, sign or space: not of the categories Cc, Cf, Cs, Co, Cn, Zl, Zp of Unicode."""
    kind = unicodedata.category(letter)
    return letter in _LAYOUT or (kind[0] != "C" and kind not in ("Zl", "Zp"))


def _escaped(letter: str) -> str:
    return letter.encode("unicode_escape").decode() if not "\ud800" <= letter <= "\udfff" else f"\\u{ord(letter):04x}"


def _abridged_word(found: re.Match[str]) -> str:
    beginning, end = KEPT_OF_WORD
    word = found[0]
    return f"{word[:beginning]}...{word[-end:]}"
