"""JSON that comes from files."""

from __future__ import annotations

import json
import re
from typing import Any

_SURROGATE = re.compile("\\\\u[dD][89a-fA-F]|[\ud800-\udfff]")
"""Where there may be half of a character; whole ones beyond the 16-bit ones are written as two halves."""


def parse_json(text: str) -> Any:
    """What a text says, all of which can be written again.

    Raises:
        ValueError: If it is not JSON, or holds halves of characters.
        RecursionError: If it is nested too deeply.
    """
    content = json.loads(text)
    if _SURROGATE.search(text):
        try:
            json.dumps(content, ensure_ascii=False).encode()
        except UnicodeEncodeError:
            raise ValueError("it holds half of a character (a lone surrogate)") from None
    return content
