"""The problems of the paper's experiment, which are scenes of the other suites."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import Any

from phframe.core import Options, Scene, SceneSuite, UnknownNameError
from phframe.scenes.generator import RandomScenes
from phframe.scenes.suites import Papallas, Vieira

_NAME = "paper"
_RANDOM = 100


class Paper(SceneSuite[Options]):
    """121 problems like those of the paper's experiment: its basic and simple scenes, those of Papallas, 100 random ones.

    The first 21 are the published ones. The paper's random ones are not published; here they are ``random/0`` to
    ``random/99``, with the options' defaults. Each is its scene of ``vieira``, ``papallas`` or ``random`` in all but name.
    """

    def __init__(self, options: Options | None = None) -> None:
        super().__init__(options or Options())

    def names(self) -> tuple[str, ...]:
        """The names of all 121, numbers in them in their order."""
        return tuple(self._homes)

    def load(self, name: str) -> Scene:
        """One scene, called ``paper/name``.

        Raises:
            UnknownNameError: If there is no such scene.
        """
        if name not in self._homes:
            raise UnknownNameError("scene", f"{_NAME}/{name}", [f"{_NAME}/{each}" for each in self._homes])
        suite, own_name = self._homes[name]
        return replace(suite.load(own_name), name=f"{_NAME}/{name}")

    @cached_property
    def _homes(self) -> Mapping[str, tuple[SceneSuite[Any], str]]:
        """Suite and name there of each scene, by its name here."""
        vieira, papallas, random = Vieira(), Papallas(), RandomScenes()
        simple = [name for name in vieira.names() if name.startswith("simple-")]
        return {
            "basic": (vieira, "basic"),
            **{f"random-{seed}": (random, str(seed)) for seed in range(_RANDOM)},
            **{name: (papallas, name) for name in papallas.names()},
            **{name: (vieira, name) for name in simple},
        }
