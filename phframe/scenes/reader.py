"""Scene files (YAML, format 1): text to ``Scene``. Whatever is wrong with a file is one clear error."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from phframe.core import BasePose, Cylinder, DocumentError, Scene, SceneError, SceneObject, Shelf
from phframe.core.paths import path_shown
from phframe.scenes.complaints import complaints
from phframe.scenes.model import FORMAT, CylinderPart, ObjectPart, ScenePart
from phframe.yaml.file import read_text, refuse_size
from phframe.yaml.tree import YamlTree, parse_yaml
from phframe.yaml.wording import shown

_WHAT = "scene file"


def read_scene(path: str | Path) -> Scene:
    """The scene in a file.

    Args:
        path: A YAML file of format 1 (``docs/scene.schema.json`` describes it).

    Raises:
        InputError: If the file cannot be read.
        SceneError: If it is no scene of format 1, or a scene that cannot be. Every problem is named.
    """
    with _of_scenes():
        text = read_text(path, _WHAT)
    return parse_scene(text, path_shown(path))


def parse_scene(text: str, source: str = "scene") -> Scene:
    """The scene in a text.

    Args:
        text: YAML of format 1.
        source: Where it comes from, for the error.

    Raises:
        SceneError: If it is no scene of format 1, or a scene that cannot be. Every problem is named.
    """
    with _of_scenes():
        refuse_size(len(text), source, _WHAT)
        tree = parse_yaml(text, source)
    _check_format(tree, source)
    try:
        part = ScenePart.model_validate(tree.content)
    except ValidationError as error:
        raise SceneError(complaints(error, tree), source) from None
    return _scene(part, source)


@contextmanager
def _of_scenes() -> Iterator[None]:
    """What is wrong with a document is wrong with a scene."""
    try:
        yield
    except DocumentError as error:
        raise SceneError(error.problems, error.source) from error.__cause__


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
        raise SceneError(error.problems, source) from None


def _object(part: ObjectPart) -> SceneObject:
    return SceneObject(part.id, _shape(part), part.position, part.yaw, part.mass, part.friction)


def _shape(part: Any) -> Cylinder:
    match part:
        case CylinderPart():
            return Cylinder(part.radius, part.height)
        case _:
            raise SceneError(f"no geometry for the shape of {part.id!r}")
