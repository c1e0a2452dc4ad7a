"""What ``phframe scene import`` does."""

from __future__ import annotations

from phframe.cli.console import note
from phframe.cli.needs import require
from phframe.cli.output import Output
from phframe.core.paths import path_shown
from phframe.scenes.foreign_file import read_foreign
from phframe.scenes.importer import to_scene
from phframe.scenes.writer import scene_to_yaml


def run(file: str, out: str, target: str | None, name: str | None, *, force: bool) -> None:
    """Write the scene that is in a MuJoCo XML file, and say what was decided and ignored.

    Raises:
        PhframeError: If the file cannot be read or holds no shelf; nothing was written then.
    """
    require("mujoco", "reading MuJoCo XML", "mujoco")
    output = Output(out, force=force)
    imported = to_scene(read_foreign(file), path_shown(file), target, name)
    text = scene_to_yaml(imported.scene)
    for line in imported.notes:
        note(line)
    output.write(text)
