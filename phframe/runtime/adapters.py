"""What writes values as JSON and reads them again, of any type."""

from __future__ import annotations

from functools import cache
from typing import Any

from pydantic import TypeAdapter


@cache
def adapter_of(kind: Any) -> TypeAdapter[Any]:
    """What writes and reads a kind; it takes tenths of a second to make."""
    return TypeAdapter(kind)
