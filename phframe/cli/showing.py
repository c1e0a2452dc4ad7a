"""What ``phframe scenes`` does."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from phframe.cli.console import emit, show
from phframe.cli.needs import require
from phframe.cli.output import STANDARD_OUTPUT, Output
from phframe.core import InputError, Scene
from phframe.core.paths import path_shown
from phframe.registry import Kind, look_up
from phframe.registry.from_file import is_file
from phframe.runtime.scenes import find_scene
from phframe.scenes.spec import is_file_spec

PICTURE, FILES = ".png", (".yaml", ".yml")
"""How the names of pictures and of scene files end."""


def run(name: str | None, out: str | None, options: Mapping[str, str], *, as_json: bool, force: bool) -> None:
    """List what there is, describe a suite, or show a scene.

    Args:
        name: Of a suite or a scene; or a file. None: everything is listed.
        out: The picture or scene file to write; None: a table is printed.
        options: Of the scene's suite, as text, by key.
        as_json: Whether to print JSON.
        force: Whether a file may be overwritten.

    Raises:
        PhframeError: If something asked for cannot be used; nothing was written then.
    """
    if name is not None and _is_scene(name):
        _show(name, out, options, as_json=as_json, force=force)
        return
    if out is not None or options:
        given = "--out" if out is not None else "--option"
        raise InputError(f"{given} goes with one scene: name it, such as vieira/basic")
    from phframe.cli.listings import print_listing

    print_listing("scenes", Kind.SCENES, name, as_json=as_json)


def _is_scene(name: str) -> bool:
    """Whether a scene is meant, and not a suite: by name, as ``distribution:name``, or as a class in a file."""
    if is_file(name):
        return False
    return "/" in name or (look_up(Kind.SCENES, name) is None and (is_file_spec(name) or ":" not in name))


def _show(name: str, out: str | None, options: Mapping[str, str], *, as_json: bool, force: bool) -> None:
    if as_json and out == STANDARD_OUTPUT:
        raise InputError(
            "--json and --out - both write to standard output: take one of them, or another path with --out"
        )
    output = None if out is None else _output(out, force=force)
    scene = find_scene(name, options)
    if output is not None and out is not None:
        output.write(_content(scene, out))
    if as_json or output is None:
        _describe(scene, as_json=as_json)


def _output(out: str, *, force: bool) -> Output:
    if out != STANDARD_OUTPUT and _ending(out) not in (PICTURE, *FILES):
        raise InputError(
            f"a scene is written as a picture or as a scene file, and {path_shown(out)!r} is no name of one: "
            f"give --out FILE{PICTURE} or FILE{FILES[0]}"
        )
    if _ending(out) == PICTURE:
        require("matplotlib", "the picture of a scene", "plots")
    return Output(out, force=force)


def _ending(out: str) -> str:
    return Path(out).suffix.lower()


def _content(scene: Scene, out: str) -> str | bytes:
    if _ending(out) == PICTURE:
        from phframe.recorders.scene_plot import scene_picture

        return scene_picture(scene)
    from phframe.scenes.writer import scene_to_yaml

    return scene_to_yaml(scene)


def _describe(scene: Scene, *, as_json: bool) -> None:
    from phframe.cli.scene_table import overview_as_json, overview_as_table
    from phframe.recorders.scene_overview import scene_overview

    overview = scene_overview(scene)
    if as_json:
        emit(json.dumps(overview_as_json(overview), allow_nan=False))
    else:
        show(overview_as_table(overview))
