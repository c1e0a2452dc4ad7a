"""``Scene`` to a scene file of format 1, such that reading it gives the same scene."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from phframe.core import Scene, SceneObject
from phframe.core.files import write_file
from phframe.core.paths import user_path
from phframe.scenes.model import FORMAT, ScenePart
from phframe.scenes.shapes import figures_of
from phframe.yaml.scalars import plain_scalar

_PLAIN = re.compile(r"[A-Za-z_][A-Za-z0-9_./-]*")


def scene_to_yaml(scene: Scene) -> str:
    """The text of a scene file; what has its default value is left out."""
    part = ScenePart.model_validate(scene_content(scene))
    return "\n".join(_lines(part.model_dump(exclude_defaults=True))) + "\n"


def write_scene(scene: Scene, path: str | Path) -> None:
    """Write a scene file, whole or not at all, as ``phframe.core.files`` does.

    Raises:
        InputError: If the file cannot be written.
    """
    write_file(user_path(path), scene_to_yaml(scene))


def scene_content(scene: Scene) -> dict[str, Any]:
    """The scene as the mappings and lists of its file, nothing left out. Plain floats: a scene may hold numpy's."""
    shelf = scene.shelf
    names = ("depth", "width", "height", "board_friction", "wall_friction")
    return {
        "phframe": FORMAT,
        "name": scene.name,
        "shelf": {name: float(getattr(shelf, name)) for name in names},
        "target": scene.target,
        "objects": [_object(item) for item in scene.objects],
        "mount": {arm: [float(v) for v in (m.x, m.y, m.z, m.yaw)] for arm, m in scene.base_poses.items()},
    }


def _object(item: SceneObject) -> dict[str, Any]:
    return {
        "id": item.id,
        **figures_of(item.shape),
        "position": [float(v) for v in item.position],
        "yaw": float(item.yaw),
        "mass": float(item.mass),
        "friction": None if item.friction is None else float(item.friction),
    }


_ORDER = ("id", "shape", "radius", "height", "position", "yaw", "mass", "friction")


def _lines(content: Mapping[str, Any]) -> Iterator[str]:
    yield f"phframe: {FORMAT}"
    yield f"name: {_flow(content['name'])}"
    yield f"shelf: {_flow(content['shelf'])}"
    if content.get("mount"):
        yield f"mount: {_flow(content['mount'])}"
    yield f"target: {_flow(content['target'])}"
    yield "objects:"
    for item in content["objects"]:
        yield "  - " + _flow({key: item[key] for key in _ORDER if key in item})


def _flow(value: Any) -> str:
    """A value on one line; numbers in the fewest digits that give the same number again."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_flow(key)}: {_flow(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(_flow(item) for item in value) + "]"
    return _text(value) if isinstance(value, str) else repr(value)


def _text(text: str) -> str:
    plain = _PLAIN.fullmatch(text) and plain_scalar(text) == text
    return text if plain else json.dumps(text, ensure_ascii=False)
