"""Suites whose scenes are files in a package, and the two published ones."""

from __future__ import annotations

from dataclasses import replace
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import ClassVar

from phframe.core import Options, Scene, SceneSuite, UnknownNameError
from phframe.scenes.reader import parse_scene

_SUFFIX = ".yaml"


class FileSuite(SceneSuite[Options]):
    """A suite whose scenes are the YAML files of one folder of a package.

    A subclass says where they are; the scene in ``basic.yaml`` of the suite ``vieira`` is ``vieira/basic``.

    Attributes:
        name: The suite's name.
        package: The importable package that holds the files.
        folder: The folder within it, with forward slashes.
    """

    name: ClassVar[str]
    package: ClassVar[str]
    folder: ClassVar[str]

    def __init__(self, options: Options | None = None) -> None:
        super().__init__(options or Options())

    def names(self) -> tuple[str, ...]:
        """The names of its scenes, in alphabetical order."""
        found = (entry.name for entry in self._folder().iterdir())
        return tuple(sorted(name.removesuffix(_SUFFIX) for name in found if name.endswith(_SUFFIX)))

    def load(self, name: str) -> Scene:
        """One scene, called ``suite/name``.

        Raises:
            UnknownNameError: If there is no such scene.
            SceneError: If the file holds no scene that can be.
        """
        known = self.names()
        if name not in known:
            raise UnknownNameError("scene", f"{self.name}/{name}", [f"{self.name}/{each}" for each in known])
        text = (self._folder() / f"{name}{_SUFFIX}").read_text(encoding="utf-8")
        return replace(parse_scene(text, f"{self.name}/{name}"), name=f"{self.name}/{name}")

    def _folder(self) -> Traversable:
        return files(self.package).joinpath(*self.folder.split("/"))


class Vieira(FileSuite):
    """21 scenes published with the planner of Vieira et al. 2022: ``basic``, ten simple ones, ten examples."""

    name = "vieira"
    package = "phframe.scenes"
    folder = "data/vieira"


class Papallas(FileSuite):
    """The ten scenes S1 to S10 of Papallas and Dogar 2020."""

    name = "papallas"
    package = "phframe.scenes"
    folder = "data/papallas"
