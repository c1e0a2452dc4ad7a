"""pydantic's errors as sentences for the author of a scene file: line, place, what is there, what is expected."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from phframe.scenes.model import SHAPES, ScenePart, ShelfPart
from phframe.yaml.tree import Path, YamlTree
from phframe.yaml.wording import did_you_mean, place, shortened, shown

_EXPECTED = {
    "float_type": "a number",
    "string_type": "text",
    "list_type": "a list",
    "tuple_type": "a list of numbers",
    "dict_type": "a mapping",
    "model_type": "a mapping",
    "model_attributes_type": "a mapping",
    "finite_number": "a finite number",
    "greater_than": "a number above {gt:g}",
    "greater_than_equal": "a number of {ge:g} or more",
    "string_too_short": "text that is not empty",
    "string_too_long": "at most {max_length} characters",
    "too_short": "at least one object",
    "union_tag_invalid": "one of: {expected_tags}",
    "literal_error": "{expected}",
}


def complaints(error: ValidationError, tree: YamlTree) -> list[str]:
    """One sentence for each thing wrong with a file's keys, types and ranges, in the file's order."""
    found = sorted(
        ((tree.line(path), text) for path, text in _sentences(error, tree.content)), key=lambda item: item[0]
    )
    return shortened(f"line {line}: {text}" for line, text in found)


def _sentences(error: ValidationError, content: Any) -> Iterator[tuple[Path, str]]:
    for detail in error.errors(include_url=False):
        path = _path(detail)
        yield path, _sentence(detail, path, content)


def _sentence(detail: ErrorDetails, path: Path, content: Any) -> str:
    kind, context = detail["type"], detail.get("ctx", {})
    if kind == "extra_forbidden":
        known = _model_at(path[:-1], content).model_fields
        where = f" in {place(path[:-1])}" if path[1:] else ""
        return f"unknown key {shown(path[-1])}{where}{did_you_mean(str(path[-1]), known)}; known: {', '.join(known)}"
    if kind in ("missing", "union_tag_not_found"):
        return f"{place(path)} is missing: {_model_at(path[:-1], content).model_fields[str(path[-1])].description}"
    template = _EXPECTED.get(kind)
    expected = f"expected {template.format(**context)}" if template else detail["msg"]
    return f"{place(path)} is {_described(_at(path, content), kind)}; {expected}"


def _described(value: Any, kind: str) -> str:
    return f"the text {shown(value)}" if kind == "float_type" and isinstance(value, str) else shown(value)


def _path(detail: ErrorDetails) -> Path:
    """Where in the file an error is: pydantic's location without the shape's name, which is no key of the file."""
    location = [part for part in detail["loc"] if part != "[key]"]
    if detail["type"].startswith("union_tag"):
        location.append("shape")
    if location[:1] == ["objects"] and location[2:] and location[2] in SHAPES and len(location) > 3:
        del location[2]
    return tuple(location)


def _at(path: Path, content: Any) -> Any:
    for part in path:
        content = content[part]
    return content


def _model_at(path: Path, content: Any) -> type[BaseModel]:
    """The model of the mapping at ``path``; an object of a shape not known counts as the first one."""
    if path[:1] == ("shelf",):
        return ShelfPart
    if path[:1] == ("objects",):
        item = _at(path, content)
        shape = item.get("shape") if isinstance(item, Mapping) else None
        return SHAPES.get(shape if isinstance(shape, str) else "", next(iter(SHAPES.values())))
    return ScenePart
