"""Random scenes like the published examples: the same seed gives the same scene for ever."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field

from phframe.core import Cylinder, Options, Scene, SceneError, SceneObject, SceneSuite, Shelf, UnknownNameError
from phframe.scenes.draws import Draws
from phframe.scenes.placement import Layout, Point, place_objects

NAME = "random"
_UNITS = 10_000  # tenths of a millimetre in a metre
_EXAMPLES = 10
_LONGEST_SEED = 18  # digits

Length = Annotated[float, Field(gt=0.0, le=10.0)]


class RandomOptions(Options):
    """What random scenes are like. The defaults are the size and the crowd of the published examples.

    Lengths are used in steps of 0.1 mm.
    """

    count: int = Field(9, ge=1, le=200, description="number of obstacles")
    blocking: int = Field(2, ge=1, le=200, description="least number of obstacles in the target's corridor")
    depth: Length = Field(0.55, description="depth of the shelf (m)")
    width: Length = Field(0.61, description="width of the shelf (m)")
    height: Length = Field(0.4, description="height of the shelf (m)")
    radius: float = Field(0.03, ge=0.001, le=1.0, description="radius of the objects (m)")
    object_height: Length = Field(0.12, description="height of the objects (m)")
    gap: float = Field(0.002, ge=0.0, le=1.0, description="least space between objects, and to the walls (m)")
    target_gap: float = Field(0.02, ge=0.0, le=1.0, description="least space around the target (m)")
    corridor: float = Field(0.12, gt=0.0, le=1.0, description="half-width of the corridor that must be blocked (m)")


class RandomScenes(SceneSuite[RandomOptions]):
    """Scenes from seeds: ``random/7`` is the scene of seed 7.

    The target stands between two thirds and nine tenths of the shelf's depth, every obstacle nearer to the mouth than
    it, and some of them in its corridor. Coordinates are whole tenths of a millimetre.
    """

    options_type = RandomOptions

    def __init__(self, options: RandomOptions | None = None) -> None:
        super().__init__(options or RandomOptions())

    def names(self) -> tuple[str, ...]:
        """The first seeds; any other whole number is a scene too."""
        return tuple(str(seed) for seed in range(_EXAMPLES))

    def load(self, name: str) -> Scene:
        """The scene of a seed.

        Args:
            name: The seed: a whole number from 0, without leading zeros.

        Raises:
            UnknownNameError: If the name is no such number.
            SceneError: If so many objects of that size find no place.
        """
        places = place_objects(_layout(self.options), Draws(self._seed(name)))
        if isinstance(places, int):
            raise SceneError(_no_room(self.options, places), f"{NAME}/{name}")
        return self._scene(f"{NAME}/{name}", places)

    def _seed(self, name: str) -> int:
        if name.isascii() and name.isdigit() and len(name) <= _LONGEST_SEED and str(int(name)) == name:
            return int(name)
        known = [f"{NAME}/{each}" for each in self.names()]
        hint = f"Every whole number from 0 (up to {_LONGEST_SEED} digits, no leading zeros) is a scene."
        raise UnknownNameError("scene", f"{NAME}/{name}", known, hint)

    def _scene(self, name: str, places: list[Point]) -> Scene:
        options = self.options
        shape = Cylinder(options.radius, options.object_height)
        ids = [*(f"object_{i}" for i in range(1, len(places))), "target"]
        items = tuple(
            SceneObject(each, shape, (x / _UNITS, y / _UNITS)) for each, (x, y) in zip(ids, places, strict=True)
        )
        return Scene(name, Shelf(options.depth, options.width, options.height), items, "target")


def _layout(options: RandomOptions) -> Layout:
    """The options in whole tenths of a millimetre; rounded so that nothing can overlap or stand outside."""
    return Layout(
        count=options.count,
        blocking=min(options.blocking, options.count),
        depth=_down(options.depth),
        width=_down(options.width),
        radius=_up(options.radius),
        gap=_up(options.gap),
        target_gap=_up(options.target_gap),
        corridor=_up(options.corridor),
    )


def _down(length: float) -> int:
    return math.floor(round(length * _UNITS, 6))  # 0.61 m is 6100 steps, not 6099


def _up(length: float) -> int:
    return math.ceil(round(length * _UNITS, 6))


def _no_room(options: RandomOptions, most: int) -> str:
    return (
        f"no place for {options.count} obstacles of radius {options.radius:g} m before a target in a shelf of "
        f"{options.depth:g} x {options.width:g} m, at least {min(options.blocking, options.count)} of them in its "
        f"corridor: {most} at most found one; lower count, radius or blocking, or enlarge the shelf"
    )
