"""What YAML takes that JSON does not."""

from __future__ import annotations

import json
import re
from typing import Any

YAML = (
    *("&a ", "*a", "!!str ", "!!float ", "!<x> ", "%YAML 1.1\n", "%TAG ! x:\n", "---\n", "...\n", "- ", "? ", ": "),
    *(
        "|\n",
        ">-\n",
        "'",
        '"',
        '"\\ud800"',
        '"\\u202e"',
        '"\\x1b[2J"',
        '"\\0"',
        "\\",
        "[",
        "]",
        "{",
        "}",
        ", ",
        "#",
        "\n",
    ),
    *(".nan", "-.inf", ".inf", "1e999", "1e-999", "-0", "0x7fffffffffffffff", "0o17", "1_000", "1:30", "9" * 400, "\t"),
    *(
        "~",
        "null",
        "yes",
        "[]",
        "{}",
        "'0.3'",
        "objects:",
        "shelf: {}",
        "phframe: 2",
        "mass: 5",
        "yaw: 700",
        "id: object_1",
    ),
    *("- {id: z, shape: cylinder, radius: 0.02, height: 0.1, position: [0.1, 0.1]}\n", "[" * 50, "- " * 50, "? " * 50),
    *("<<: *a", "0." + "3" * 40, "0.3e-0", "+.5", "1."),
)
"""Pieces of text."""
_NO_NUMBER = re.compile(r"(?<=[\[:, ])(-?)(NaN|Infinity)(?=[,}\]]|$)")


def as_yaml(content: Any) -> str:
    """A document in YAML's flow style, which is JSON but for what is no number."""
    return _NO_NUMBER.sub(lambda found: found[1] + (".nan" if found[2] == "NaN" else ".inf"), json.dumps(content))
