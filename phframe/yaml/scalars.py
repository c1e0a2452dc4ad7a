"""Plain scalars of YAML 1.2 (core schema): which text is a number, which is true, which is nothing."""

from __future__ import annotations

import re

Scalar = str | int | float | bool | None

_CONSTANTS: dict[str, Scalar] = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL")),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), float("inf")),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}
_INTEGER = re.compile(r"[-+]?[0-9]+")
_OTHER_BASE = re.compile(r"0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_EXACT_DIGITS = 18  # longer whole numbers become floats: no figure needs them, and huge ones are slow to convert


def plain_scalar(text: str) -> Scalar:
    """The value of a scalar written without quotes, as YAML 1.2 has it: ``3e-2`` is a number, ``yes`` is text."""
    if text in _CONSTANTS:
        return _CONSTANTS[text]
    if len(text) <= _EXACT_DIGITS and _INTEGER.fullmatch(text):
        return int(text)
    if len(text) <= _EXACT_DIGITS and _OTHER_BASE.fullmatch(text):
        return int(text, 0)
    return float(text) if _FLOAT.fullmatch(text) else text
