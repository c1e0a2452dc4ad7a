"""The options of one registered thing, from the model that reads them."""

from __future__ import annotations

import inspect
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from phframe.cli.listing_data import FORMAT
from phframe.core import Options
from phframe.registry import Kind, create, load

_ATTRIBUTE = re.compile(r"^    (\w+): (.*(?:\n {8,}.*)*)", re.MULTILINE)
_BOUNDS = {"exclusiveMinimum": "> ", "minimum": ">= ", "exclusiveMaximum": "< ", "maximum": "<= "}


@dataclass(frozen=True, slots=True)
class OptionRow:
    """One option.

    Attributes:
        key: What ``--option`` calls it, without the part.
        values: What it may be, such as ``number > 0, <= 1``.
        default: Used where it is not given.
        description: What it is, with its unit.
    """

    key: str
    values: str
    default: Any
    description: str


@dataclass(frozen=True, slots=True)
class Description:
    """One registered thing in detail.

    Attributes:
        kind: What it is.
        name: What it is asked for by.
        text: What it does.
        options: Its options.
        scenes: Of a suite: its scenes, as ``suite/name``.
    """

    kind: str
    name: str
    text: str
    options: tuple[OptionRow, ...]
    scenes: tuple[str, ...] = ()

    def as_json(self) -> dict[str, Any]:
        """One object: ``format``, what it is, its ``options``, and of a suite its ``scenes``."""
        values = {**asdict(self), "options": [asdict(option) for option in self.options]}
        scenes = values.pop("scenes")
        return {"format": FORMAT, **values, **({"scenes": list(scenes)} if self.kind == Kind.SCENES else {})}


def describe(kind: Kind, spec: str) -> Description:
    """One registered thing in detail. It is imported.

    Args:
        kind: What it is.
        spec: Its name, or a class in a file.

    Raises:
        PhframeError: If there is no such thing, or it does not load.
    """
    loaded = load(kind, spec)
    rows = _rows(getattr(loaded, "options_type", Options))
    scenes = tuple(f"{spec}/{name}" for name in create(kind, spec).names()) if kind is Kind.SCENES else ()
    return Description(kind.value, spec, _plain(inspect.cleandoc(loaded.__doc__ or "").split("\n\n")[0]), rows, scenes)


def _rows(options_type: type[Options]) -> tuple[OptionRow, ...]:
    schema = options_type.model_json_schema()
    texts = _documented(options_type)
    return tuple(
        OptionRow(
            key,
            _values(part, schema.get("$defs", {})),
            part.get("default"),
            _plain(part.get("description") or texts.get(key, "")),
        )
        for key, part in schema.get("properties", {}).items()
    )


def _documented(options_type: type[Options]) -> dict[str, str]:
    """What the docstrings of the model and its bases say under ``Attributes:``."""
    texts: dict[str, str] = {}
    for each in reversed(options_type.__mro__):
        _, _, attributes = inspect.cleandoc(each.__doc__ or "").partition("Attributes:\n")
        texts.update(_ATTRIBUTE.findall(attributes))
    return texts


def _plain(text: str) -> str:
    """A docstring's text in one line, without its markup."""
    return " ".join(text.replace("``", "").split())


def _values(part: Mapping[str, Any], shared: Mapping[str, Any]) -> str:
    if "$ref" in part:
        return _values(shared.get(part["$ref"].rpartition("/")[2], {}), shared)
    if "anyOf" in part:
        return " or ".join(_values(each, shared) for each in part["anyOf"])
    if "const" in part or "enum" in part:
        return " or ".join(str(value) for value in part.get("enum", [part.get("const")]))
    bounds = [f"{sign}{part[name]:g}" for name, sign in _BOUNDS.items() if name in part]
    return " ".join([str(part.get("type", "any")), ", ".join(bounds)]).strip()
