"""Names with options in brackets, ``phia[sweeps=paper]``: a part with these options, told as a thing of its own."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

from phframe.core.errors import OptionError

_LONGEST = 40
"""Characters of a value that are shown in a name; of a longer one, its beginning and a digest that tells it from others."""


def variant_name(name: str, options: Mapping[str, Any]) -> str:
    """A part and its options as one name, the same however the options are ordered.

    Args:
        name: Of the part.
        options: Values by key; those at their default are left out by whoever calls.

    Returns:
        What ``split_variant`` reads again, unless a value is so long that it is shortened.
    """
    texts = [f"{key}={_shortened(value_text(value))}" for key, value in sorted(options.items())]
    return f"{name}[{','.join(texts)}]" if texts else name


def split_variant(text: str) -> tuple[str, dict[str, str]]:
    """The name and the options, as text, of a name with options in brackets; of any other text itself and none.

    Commas and brackets within brackets belong to a value, as in ``[radii=[0.1,0.2]]``.

    Raises:
        OptionError: If what is in the brackets is not ``key=value,...``.
    """
    name, bracket, inside = text.partition("[")
    if not bracket or not text.endswith("]"):
        return text, {}
    options: dict[str, str] = {}
    for each in _pieces(inside[:-1]):
        key, equals, value = (piece.strip() for piece in each.partition("="))
        if not equals or not key or key in options:
            wrong = "gives an option twice" if key in options else f"has {each.strip()!r} in its brackets"
            raise OptionError(f"{text!r} {wrong}: write name[key=value,key=value], such as phia[sweeps=paper]")
        options[key] = value
    return type(text)(name), options


def merged_options(text: str, given: Mapping[str, Any]) -> tuple[str, dict[str, Any]]:
    """The name of a part, and the options given in its brackets and beside it.

    Raises:
        OptionError: If the brackets cannot be read, or an option is given in both places.
    """
    name, options = split_variant(text)
    for key in options:
        if key in given:
            raise OptionError(f"option {key!r} is given in {text!r} and beside it, as {given[key]!r}: keep one")
    return name, {**options, **given}


def _pieces(inside: str) -> list[str]:
    """What stands between the commas that are in no bracket."""
    pieces, depth = [""], 0
    for letter in inside:
        depth += (letter in "[({") - (letter in "])}")
        if letter == "," and depth == 0:
            pieces.append("")
        else:
            pieces[-1] += letter
    return pieces


def _shortened(text: str) -> str:
    if len(text) <= _LONGEST:
        return text
    return f"{text[: _LONGEST // 2]}...{hashlib.sha256(text.encode()).hexdigest()[:8]}"


def value_text(value: Any) -> str:
    """The value of an option as it is typed, whole and exact."""
    if isinstance(value, list | tuple):
        return f"[{','.join(value_text(each) for each in value)}]"
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) and float(f"{value:g}") == value else str(value)
