"""The published JSON Schema is the one the reader goes by."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from phframe.scenes.schema import scene_json_schema, schema_text

PUBLISHED = Path(__file__).parents[2] / "docs" / "scene.schema.json"


def test_the_published_schema_is_up_to_date() -> None:
    hint = "run: python -m phframe.scenes.schema > docs/scene.schema.json"
    assert json.loads(PUBLISHED.read_text(encoding="utf-8")) == json.loads(schema_text()), hint


def test_the_schema_says_what_the_reader_refuses() -> None:
    schema = scene_json_schema()
    assert schema["properties"]["phframe"]["const"] == 1
    assert schema["required"] == ["phframe", "name", "shelf", "target", "objects"]
    parts: list[dict[str, Any]] = [schema, *schema["$defs"].values()]
    assert all(part["additionalProperties"] is False for part in parts)
    cylinder = schema["$defs"]["CylinderPart"]["properties"]
    assert cylinder["radius"]["exclusiveMinimum"] == 0
    assert (cylinder["position"]["minItems"], cylinder["position"]["maxItems"]) == (2, 2)
    assert (cylinder["mass"]["default"], cylinder["yaw"]["default"]) == (0.3, 0.0)
    assert set(schema["properties"]["objects"]["items"]["discriminator"]["mapping"]) == {"cylinder"}
