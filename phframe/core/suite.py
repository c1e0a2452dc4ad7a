"""The interface of suites: named collections of scenes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar, Generic, TypeVar

from phframe.core.options import Options
from phframe.core.scene import Scene

OptionsT = TypeVar("OptionsT", bound=Options)


class SceneSuite(ABC, Generic[OptionsT]):
    """A named collection of scenes; its scenes are called ``suite/name``."""

    options_type: ClassVar[type[Options]] = Options

    def __init__(self, options: OptionsT) -> None:
        self.options = options

    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """The names of its scenes, without the suite's; for a generator, a few examples."""

    @abstractmethod
    def load(self, name: str) -> Scene:
        """One scene.

        Raises:
            UnknownNameError: If there is no such scene.
            SceneError: If it cannot be.
        """
