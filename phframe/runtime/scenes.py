"""From what a user calls a scene to the scene."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from phframe.core import InputError, PluginError, Scene, SceneSuite, UnknownNameError
from phframe.core.paths import user_path
from phframe.registry import Kind, catalogue, create, look_up
from phframe.registry.foreign import foreign_code
from phframe.scenes.reader import read_scene
from phframe.scenes.spec import is_file_spec


def find_scene(spec: str | Path | Scene, options: Mapping[str, Any] | None = None) -> Scene:
    """The scene that a spec stands for.

    Args:
        spec: ``suite/name``, a file, or a scene already.
        options: Of the suite, by key.

    Raises:
        UnknownNameError: If there is no such suite or scene.
        SceneError: If the scene cannot be.
        InputError: If the file cannot be read.
        PluginError: If the suite is a plugin's and does not work.
    """
    if isinstance(spec, Scene):
        return spec
    if not isinstance(spec, str | Path):
        raise InputError(f"a scene is 'suite/name', a file or a Scene, not {spec!r}")
    if isinstance(spec, Path) or is_file_spec(spec):
        if options:
            raise InputError(f"a scene file takes no options, but there is: {', '.join(options)}")
        return read_scene(user_path(spec))
    suite_name, _, name = (type(spec)(piece) for piece in spec.partition("/"))
    if ":" not in suite_name and look_up(Kind.SCENES, suite_name) is None:
        known = [entry.name for entry in catalogue().extensions(Kind.SCENES)]
        raise UnknownNameError("suite of scenes", suite_name, known, "A scene file ends in .yaml.")
    suite: SceneSuite[Any] = create(Kind.SCENES, suite_name, options)
    with foreign_code(f"the suite of scenes {suite_name!r} does not work"):
        if not name:
            raise UnknownNameError("scene", str(spec), [f"{suite_name}/{known}" for known in suite.names()])
        scene: Any = suite.load(name)
    if not isinstance(scene, Scene):
        raise PluginError(f"the suite of scenes {suite_name!r} has a {type(scene).__name__} for {name!r}, not a Scene")
    return scene


def scene_names() -> tuple[str, ...]:
    """Every scene that has a name, as ``suite/name``; of generators, a few examples."""
    suites = [entry.name for entry in catalogue().extensions(Kind.SCENES)]
    return tuple(f"{suite}/{name}" for suite in suites for name in create(Kind.SCENES, suite).names())
