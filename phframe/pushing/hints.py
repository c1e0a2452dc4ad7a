"""Hints in a file: which objects are to be pushed where, in order, so that scripts can guide a planner."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from pydantic import BaseModel, ConfigDict, Field

from phframe.core import DocumentError, Hint
from phframe.core.paths import path_shown
from phframe.yaml.file import read_text
from phframe.yaml.tree import YamlTree, parse_yaml
from phframe.yaml.wording import did_you_mean, shortened, shown

FORM: Final = "a list of hints such as '- {object: object_3, to: [0.30, 0.45]}'"


class HintOption(BaseModel):
    """One hint.

    Attributes:
        object: Id of the object.
        to: Where it is to stand: x, y in the shelf frame (m).
        where: It was written, for messages; it is not stored.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    object: str
    to: tuple[float, float]
    where: str = Field(default="", exclude=True)

    @property
    def hint(self) -> Hint:
        """What it says."""
        return Hint(self.object, self.to)


def read_hints(path: str | Path) -> list[dict[str, Any]]:
    """The hints in a YAML file, each with where it was written.

    Args:
        path: The file.

    Raises:
        InputError: If it cannot be read.
        DocumentError: If it is not a list of hints. Every problem is named, with its line.
    """
    source = path_shown(path)
    tree = parse_yaml(read_text(path, "hints file"), source)
    if not isinstance(tree.content, list):
        raise DocumentError(f"the file holds {shown(tree.content)}; expected {FORM}", source)
    problems = [problem for number in range(len(tree.content)) for problem in _problems(tree, number)]
    if problems:
        raise DocumentError(shortened(problems), source)
    return [{**hint, "where": f"{source}: line {tree.line((row,))}"} for row, hint in enumerate(tree.content)]


def _problems(tree: YamlTree, row: int) -> Iterator[str]:
    """What is wrong with one hint of a list."""
    hint = tree.content[row]
    if not isinstance(hint, dict):
        yield f"line {tree.line((row,))}: a hint is {shown(hint)}; expected {FORM}"
        return
    for key in hint:
        if key not in _KEYS:
            meant = did_you_mean(key, _KEYS)
            yield f"line {tree.line((row, key))}: unknown key {shown(key)} in a hint{meant}; known: {', '.join(_KEYS)}"
    for key, (expected, is_right) in _KEYS.items():
        if key not in hint:
            yield f"line {tree.line((row,))}: a hint lacks {key}: {expected}"
        elif not is_right(hint[key]):
            yield f"line {tree.line((row, key))}: {key} is {shown(hint[key])}; expected {expected}"


def _is_place(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 2 and all(map(_is_number, value))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


_KEYS: Final = {
    "object": ("the id of an object, as text", _is_text),
    "to": ("where it is to stand, [x, y] (m)", _is_place),
}
