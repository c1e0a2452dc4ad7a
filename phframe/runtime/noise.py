"""How what the planner believes differs from what is true: the figures, and the friction of what it plans with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated, Any, Self

import numpy as np
from pydantic import Field

from phframe.core import OptionError, Options, Scene, coulomb_with_board

STREAM = 2**32 - 1
"""Key of the stream of random numbers that noise has for itself, so that planners draw the same with it and without."""
POSITIONS, FRICTION, PARTICLES = 0, 1, 2
"""What that stream is split into, so that either draws the same whatever the other does."""


class Noise(Options):
    """What the planner believes against what is true.

    Attributes:
        position: Standard deviation of the error in x and in y with which an object is observed (m).
        friction: Relative standard deviation of the friction between object and board, as the planner believes it.
    """

    position: Annotated[float, Field(ge=0.0, le=0.05)] = 0.0
    friction: Annotated[float, Field(ge=0.0, le=1.0)] = 0.0

    @classmethod
    def of(cls, given: str | Mapping[str, Any] | None) -> Self:
        """Noise from text such as ``position=0.005,friction=0.3``, from a mapping, or none at all.

        Raises:
            OptionError: If it is not of that form, or a key or a value cannot be.
        """
        if isinstance(given, str):
            return cls.parse(_pairs(given), "noise")
        wanted: Any = {} if given is None else given
        if not (isinstance(wanted, Mapping) and all(isinstance(key, str) for key in wanted)):
            raise OptionError(f"noise is text such as position=0.005,friction=0.3, or a mapping by name, not {given!r}")
        return cls.parse(wanted, "noise")

    def stream(self, seed: int, part: int) -> np.random.Generator:
        """Random numbers for one part of the noise of an episode with a seed."""
        return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(STREAM, part)))

    def believed(self, scene: Scene, seed: int) -> Scene:
        """The scene as the planner believes it: the friction of every object with the board is off by a factor.

        The factors are log-normal, as friction is positive: of mean 1 and standard deviation ``friction``, drawn once.
        """
        if not self.friction:
            return scene
        spread = float(np.sqrt(np.log1p(self.friction**2)))
        normal = self.stream(seed, FRICTION).standard_normal(len(scene.objects))
        factors = np.exp(spread * normal - spread**2 / 2.0).tolist()
        pairs = zip(scene.objects, factors, strict=True)
        return replace(scene, objects=tuple(replace(o, friction=f * coulomb_with_board(scene, o)) for o, f in pairs))


def _pairs(text: str) -> dict[str, str]:
    """``key=value`` pairs between commas."""
    pairs: dict[str, str] = {}
    for piece in text.split(","):
        key, equals, value = (part.strip() for part in piece.partition("="))
        if not (key and equals and value):
            raise OptionError(
                f"noise {text!r} is not of the form position=0.005,friction=0.3; "
                f"there is: {', '.join(sorted(Noise.model_fields))}"
            )
        if key in pairs:
            raise OptionError(f"noise {key!r} is given twice: {pairs[key]!r} and {value!r}. Keep one.")
        pairs[key] = value
    return pairs
