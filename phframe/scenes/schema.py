"""The JSON Schema of scene files, for editors and other programs. ``python -m phframe.scenes.schema`` writes it out."""

from __future__ import annotations

import json
import sys
from typing import Any

from phframe.scenes.model import FORMAT, ScenePart


def scene_json_schema() -> dict[str, Any]:
    """The JSON Schema (draft 2020-12) of a scene file. Geometry (overlaps, walls, the target's id) is beyond it."""
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **ScenePart.model_json_schema(),
        "title": f"phframe scene file, format {FORMAT}",
    }


def schema_text() -> str:
    """The text of ``docs/scene.schema.json``."""
    return json.dumps(scene_json_schema(), indent=2) + "\n"


if __name__ == "__main__":
    sys.stdout.write(schema_text())
