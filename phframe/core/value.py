"""Immutable values that hold arrays: equality field by field, bit by bit, and how they are written as JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import PlainSerializer, PlainValidator

FloatArray = NDArray[np.float64]
IntArray = NDArray[np.int64]


def frozen_floats(values: ArrayLike) -> FloatArray:
    """A read-only float64 copy of ``values``."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


def frozen_ints(values: ArrayLike) -> IntArray:
    """A read-only int64 copy of ``values``."""
    array = np.array(values, dtype=np.int64)
    array.setflags(write=False)
    return array


def _to_json(array: NDArray[Any]) -> Any:
    """Nested lists; infinite values as the text ``inf``, since JSON has no number for them."""
    if np.isfinite(array).all():
        return array.tolist()
    return [_to_json(row) for row in array] if array.ndim > 1 else [v if np.isfinite(v) else str(v) for v in array]


Floats = Annotated[
    FloatArray, PlainValidator(frozen_floats, json_schema_input_type=list[Any]), PlainSerializer(_to_json)
]
Ints = Annotated[IntArray, PlainValidator(frozen_ints, json_schema_input_type=list[Any]), PlainSerializer(_to_json)]


class Value:
    """Base of the frozen dataclasses: equal when every field is, arrays bit by bit; hashable by content."""

    __slots__ = ()

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(_equal(a, b) for a, b in zip(_contents(self), _contents(other), strict=True))

    def __hash__(self) -> int:
        return hash(tuple(_hashable(content) for content in _contents(self)))

    def __reduce__(self) -> tuple[type[Value], tuple[Any, ...]]:
        """Through the constructor, which freezes the arrays: numpy forgets that they were read-only."""
        return type(self), tuple(getattr(self, field.name) for field in fields(self))  # type: ignore[arg-type]

    def __init_subclass__(cls) -> None:
        if "__repr__" not in vars(cls):
            cls.__repr__ = short_repr  # type: ignore[method-assign] # in its own namespace: dataclass leaves that alone

    def _freeze(self, *names: str) -> None:
        """Replace the named array fields by read-only float copies; for use in ``__post_init__``."""
        for name in names:
            object.__setattr__(self, name, frozen_floats(getattr(self, name)))


_LONGEST, _LONGEST_PART = 300, 80
"""Characters of a representation, and of what it shows of one field."""


def short_repr(value: Any) -> str:
    """A dataclass in a line: the fields that hold anything, arrays as their shape, many items as their number."""
    contents = ((each.name, getattr(value, each.name)) for each in fields(value) if each.repr)
    text = ", ".join(f"{name}={_shown(content)}" for name, content in contents if not _is_empty(content))
    return f"{type(value).__name__}({text if len(text) <= _LONGEST else f'{text[:_LONGEST]}...'})"


def _is_empty(content: Any) -> bool:
    return content is None or (isinstance(content, str | tuple | list | Mapping) and not content)


def _shown(content: Any) -> str:
    if isinstance(content, np.ndarray):
        return f"<{content.dtype}{list(content.shape)}>"
    if isinstance(content, type):
        return content.__name__
    if is_dataclass(content):
        return f"{type(content).__name__}(...)"
    if isinstance(content, float):
        return f"{content:.6g}"
    if isinstance(content, tuple | list | Mapping):
        items = content.values() if isinstance(content, Mapping) else content
        text = "" if any(map(is_dataclass, items)) else repr(content)
        return text if 0 < len(text) <= _LONGEST_PART else f"<{len(content)} items>"
    text = repr(str(content) if isinstance(content, str) else content)
    return text if len(text) <= _LONGEST_PART else f"{text[:_LONGEST_PART]}..."


def _contents(value: Any) -> tuple[Any, ...]:
    return tuple(getattr(value, field.name) for field in fields(value) if field.compare)


def _equal(a: Any, b: Any) -> bool:
    if isinstance(a, np.ndarray) or isinstance(b, np.ndarray):
        return (
            isinstance(a, np.ndarray)
            and isinstance(b, np.ndarray)
            and a.shape == b.shape
            and a.tobytes() == b.tobytes()
        )
    return bool(a == b)


def _hashable(content: Any) -> Any:
    if isinstance(content, np.ndarray):
        return content.shape, content.tobytes()
    if isinstance(content, Mapping):
        return tuple(sorted((key, _hashable(item)) for key, item in content.items()))
    return content
