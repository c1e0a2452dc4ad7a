"""Ways in which a file goes wrong: what it says is changed, or the text of it, at a few places that hypothesis picks."""

from __future__ import annotations

import copy
import re
from collections.abc import Callable
from typing import Any

from hypothesis import strategies as st

Draw = Callable[[st.SearchStrategy[Any]], Any]

TEXTS = (
    "", " ", "x", "nan", "inf", "-inf", "1e5", "true", "null", "0", "-1", "a b", "a,b", "a:b", "a/b", "..", "~", "cylinder",
    "\n", "a\nb", "\t", "\x00", "\x1b[2J", "\x7f", "\x85", "\u2028", "\u202e", "\u200b", "\ufeff", "\ud800", "\udfff\ud800",
    "é", "e\u0301", "日本", "😀", "٣", "%s", "{0}", "$HOME", "<b>&amp;", "]]>", "--", "'", '"', "\\", "#", "- ", "a" * 101,
    "a" * 5000, "__class__", "./x.py:Cls", "x.py:Cls", "os:system", "!!python/name:os.system", "phia[a=", "-" * 40,
)  # fmt: skip
NUMBERS = (
    0, -0.0, 1, -1, 2, 7, 1000, 1.5, 0.03, 1e-3, 1e-9, 5e-324, -1e-12, 1e5, 1e20, 1e300, 1.7976931348623157e308, -1e308,
    2**31, 2**53 + 1, 2**63, 2**64, -(2**63), 10**400, float("nan"), float("inf"), float("-inf"),
)  # fmt: skip
ODDITIES: tuple[Any, ...] = (
    None,
    True,
    False,
    [],
    {},
    [[]],
    [None],
    {"": 0},
    {"x": {}},
    [0.1, 0.2],
    [1, [2]],
    [0.0] * 7,
)
JUNK = st.sampled_from((*TEXTS, *NUMBERS, *ODDITIES))
FACTORS = (-1, 0, 2, 10, 0.5, 1.001, 1e-3, 1e3, 1e-300, 1e300)
DEEP = 30
MANY = 1200


@st.composite
def spoilt(draw: Draw, document: Any) -> Any:
    """A copy of what a document says, changed at one to three places."""
    root = [copy.deepcopy(document)]
    for _ in range(draw(st.sampled_from((1, 1, 1, 2, 3)))):
        parent, key = _place(draw, root)
        draw(st.sampled_from(CHANGES))(draw, root, parent, key)
    return root[0]


def _place(draw: Draw, root: list[Any]) -> tuple[Any, Any]:
    """Somewhere in a document: found from its root on, so that what there is much of is not all that is picked."""
    parent: Any = root
    key: Any = 0
    while isinstance(value := parent[key], dict | list) and value and draw(st.integers(0, 7)):
        parent, key = value, draw(st.sampled_from(list(value) if isinstance(value, dict) else range(len(value))))
    return parent, key


def _junk(draw: Draw, _: list[Any], parent: Any, key: Any) -> None:
    parent[key] = copy.deepcopy(draw(JUNK))


def _like(draw: Draw, _: list[Any], parent: Any, key: Any) -> None:
    """Another value of the same type: what only its meaning betrays."""
    value = parent[key]
    kinds = {str: TEXTS, int: NUMBERS, float: NUMBERS, bool: (not value,)}
    parent[key] = copy.deepcopy(draw(st.sampled_from(kinds.get(type(value), ODDITIES))))


def _gone(_: Draw, root: list[Any], parent: Any, key: Any) -> None:
    if parent is not root:
        del parent[key]


def _scaled(draw: Draw, _: list[Any], parent: Any, key: Any) -> None:
    value = parent[key]
    if isinstance(value, int | float) and abs(value) < 1e300:
        parent[key] = value * draw(st.sampled_from(FACTORS))
    elif isinstance(value, str):
        parent[key] = f"{value}{draw(st.sampled_from(TEXTS))}"


def _twice(draw: Draw, _: list[Any], parent: Any, key: Any) -> None:
    if isinstance(parent, list):
        parent.insert(key, copy.deepcopy(parent[key]))
    else:
        parent[draw(st.sampled_from(TEXTS))] = copy.deepcopy(parent[key])


def _renamed(draw: Draw, _: list[Any], parent: Any, key: Any) -> None:
    if isinstance(parent, dict):
        parent[draw(st.sampled_from((*TEXTS, *parent)))] = parent.pop(key)


def _from_elsewhere(draw: Draw, root: list[Any], parent: Any, key: Any) -> None:
    other, there = _place(draw, root)
    parent[key] = copy.deepcopy(other[there])


def _wrapped(draw: Draw, __: list[Any], parent: Any, key: Any) -> None:
    for _ in range(draw(st.sampled_from((1, 2, DEEP)))):
        parent[key] = draw(st.sampled_from(([parent[key]], {"x": parent[key]})))


def _many(_: Draw, __: list[Any], parent: Any, key: Any) -> None:
    value = parent[key]
    if isinstance(value, list) and 0 < len(value) < MANY and len(str(value[0])) < 300:
        parent[key] = [copy.deepcopy(value[n % len(value)]) for n in range(MANY)]
    elif isinstance(value, str) and 0 < len(value) < MANY:
        parent[key] = value * (MANY // len(value) + 1)


def _turned(_: Draw, __: list[Any], parent: Any, key: Any) -> None:
    value = parent[key]
    if isinstance(value, list):
        parent[key] = value[::-1]
    elif isinstance(value, dict):
        parent[key] = list(value.values())


CHANGES = (
    *(_like, _like, _like, _like, _junk, _junk, _gone, _scaled, _scaled, _twice),
    *(_renamed, _from_elsewhere, _from_elsewhere, _wrapped, _many, _turned),
)


@st.composite
def spoilt_text(draw: Draw, text: str, pieces: tuple[str, ...], word: str = r"[^\s,:=<>\[\]{}\"]+") -> str:
    """A text with one to three of its words, lines or letters changed.

    Args:
        text: The text.
        pieces: What is put into it.
        word: Regular expression of what counts as a word.
    """
    for _ in range(draw(st.integers(1, 3))):
        start, end = _span(draw, text, word)
        text = draw(st.sampled_from(CUTS))(draw, text, start, end, pieces)
    return text


def _span(draw: Draw, text: str, word: str) -> tuple[int, int]:
    """Of a word, a line, or of nothing somewhere."""
    at = draw(st.integers(0, len(text)))
    if not draw(st.integers(0, 3)):
        return text.rfind("\n", 0, at) + 1, text.find("\n", at) + 1 or len(text)
    found = re.compile(word).search(text, at)
    return found.span() if found else (at, at)


def _piece(draw: Draw, pieces: tuple[str, ...]) -> str:
    return str(draw(st.sampled_from(pieces)))


def _replaced(draw: Draw, text: str, start: int, end: int, pieces: tuple[str, ...]) -> str:
    return text[:start] + _piece(draw, pieces) + text[end:]


def _before(draw: Draw, text: str, start: int, _: int, pieces: tuple[str, ...]) -> str:
    return text[:start] + _piece(draw, pieces) + text[start:]


def _after(draw: Draw, text: str, _: int, end: int, pieces: tuple[str, ...]) -> str:
    return text[:end] + _piece(draw, pieces) + text[end:]


def _cut_out(_: Draw, text: str, start: int, end: int, __: tuple[str, ...]) -> str:
    return text[:start] + text[end:]


def _again(_: Draw, text: str, start: int, end: int, __: tuple[str, ...]) -> str:
    return text[:end] + text[start:]


def _cut_off(_: Draw, text: str, start: int, __: int, ___: tuple[str, ...]) -> str:
    return text[:start]


def _letter(draw: Draw, text: str, start: int, _: int, __: tuple[str, ...]) -> str:
    return f"{text[:start]}{draw(st.characters())}{text[start + 1 :]}"


CUTS = (_replaced, _replaced, _replaced, _replaced, _before, _after, _cut_out, _again, _cut_off, _letter)


def a_line(error: BaseException, longest: int = 1000) -> str:
    """What an error says, which must be one line that a terminal shows."""
    told = str(error)
    assert told, repr(error)
    assert "\n" not in told, told
    assert len(told) <= longest, f"{len(told)} characters: {told[:200]}"
    return told
