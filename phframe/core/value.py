"""Immutable values that hold arrays: equality field by field, bit by bit, and how they are written as JSON."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
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

    def _freeze(self, *names: str) -> None:
        """Replace the named array fields by read-only float copies; for use in ``__post_init__``."""
        for name in names:
            object.__setattr__(self, name, frozen_floats(getattr(self, name)))


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
