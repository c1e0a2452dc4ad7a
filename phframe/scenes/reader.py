"""Scene files (YAML, format 1): text to ``Scene``. Whatever is wrong with a file is one clear error."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from pydantic import ValidationError

from phframe.core import BasePose, Cylinder, InputError, Scene, SceneError, SceneObject, Shelf
from phframe.core.paths import path_shown, user_path
from phframe.scenes.complaints import complaints
from phframe.scenes.model import FORMAT, CylinderPart, ObjectPart, ScenePart
from phframe.scenes.wording import shortened, shown
from phframe.scenes.yaml_tree import YamlTree, parse_yaml

MAX_BYTES = 1_000_000
"""Larger files are refused unread: a scene of a thousand objects has a tenth of that."""


def read_scene(path: str | Path) -> Scene:
    """The scene in a file.

    Args:
        path: A YAML file of format 1 (``docs/scene.schema.json`` describes it).

    Raises:
        InputError: If the file cannot be read.
        SceneError: If it is no scene of format 1, or a scene that cannot be. Every problem is named.
    """
    source = path_shown(path)
    return parse_scene(_decoded(_content(user_path(path), source), source), source)


def parse_scene(text: str, source: str = "scene") -> Scene:
    """The scene in a text.

    Args:
        text: YAML of format 1.
        source: Where it comes from, for the error.

    Raises:
        SceneError: If it is no scene of format 1, or a scene that cannot be. Every problem is named.
    """
    if len(text) > MAX_BYTES:
        raise _too_large(source)
    tree = parse_yaml(text, source)
    _check_format(tree, source)
    try:
        part = ScenePart.model_validate(tree.content)
    except ValidationError as error:
        raise SceneError(complaints(error, tree), source) from None
    return _scene(part, source)


def _content(path: Path, source: str) -> bytes:
    try:
        with path.open("rb") as file:
            content = file.read(MAX_BYTES + 1)
    except (OSError, ValueError) as error:  # ValueError: a path with a zero byte
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(f"cannot read the scene file {source}: {reason[:1].lower()}{reason[1:]}") from None
    if len(content) > MAX_BYTES:
        raise _too_large(source)
    return content


def _too_large(source: str) -> SceneError:
    return SceneError(f"larger than {MAX_BYTES // 1_000_000} MB; that is no scene file", source)


def _decoded(content: bytes, source: str) -> str:
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        raise SceneError(f"line {line}: not UTF-8 text (byte 0x{content[error.start]:02x})", source) from None


def _check_format(tree: YamlTree, source: str) -> None:
    """The format comes first: nothing else can be said about a file of a newer one."""
    if tree.content is None:
        raise SceneError(f"the file is empty; expected a mapping that begins with 'phframe: {FORMAT}'", source)
    if not isinstance(tree.content, dict):
        raise SceneError(f"the file holds {shown(tree.content)}; expected a mapping with the keys of a scene", source)
    number, line = tree.content.get("phframe", FORMAT), tree.line(("phframe",))
    if isinstance(number, bool) or not isinstance(number, int) or number < 1:
        raise SceneError(f"line {line}: phframe is {shown(number)}; expected the file's format, {FORMAT}", source)
    if number > FORMAT:
        newer = f"this file is format {number}; this phframe reads format {FORMAT}: upgrade phframe"
        raise SceneError(f"line {line}: {newer}", source)


def _scene(part: ScenePart, source: str) -> Scene:
    base_poses = {arm: BasePose(*base) for arm, base in part.mount.items()}
    shelf = Shelf(**part.shelf.model_dump())
    try:
        return Scene(part.name, shelf, tuple(_object(item) for item in part.objects), part.target, base_poses)
    except SceneError as error:
        raise SceneError(shortened(error.problems), source) from None


def _object(part: ObjectPart) -> SceneObject:
    return SceneObject(part.id, _shape(part), part.position, part.yaw, part.mass, part.friction)


def _shape(part: Any) -> Cylinder:
    match part:
        case CylinderPart():
            return Cylinder(part.radius, part.height)
        case _:
            raise SceneError(f"no geometry for the shape of {part.id!r}")
