"""What all suites of scenes made from seeds share: the same seed and options give the same scene for ever."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Annotated, Any, ClassVar, Generic, TypeVar, cast

from pydantic import Field

from phframe.core import Cylinder, Options, Scene, SceneError, SceneObject, SceneSuite, Shelf, UnknownNameError
from phframe.scenes.draws import Draws
from phframe.scenes.placement import Layout, Point, place_objects

_UNITS = 10_000  # tenths of a millimetre in a metre
_LONGEST_SEED = 18  # digits

Length = Annotated[float, Field(gt=0.0, le=10.0)]
Space = Annotated[float, Field(ge=0.0, le=1.0)]


class SeededOptions(Options):
    """The shelf, the objects and the space between them. Lengths are used in steps of 0.1 mm."""

    blocking: int = Field(2, ge=1, le=200, description="least number of obstacles in the target's corridor")
    depth: Length = Field(0.55, description="depth of the shelf (m)")
    width: Length = Field(0.61, description="width of the shelf (m)")
    height: Length = Field(0.4, description="height of the shelf (m)")
    radius: float = Field(0.03, ge=0.001, le=1.0, description="radius of the objects (m)")
    object_height: Length = Field(0.12, description="height of the objects (m)")
    gap: Space = Field(0.002, description="least space between objects, and to the walls (m)")
    target_gap: Space = Field(0.02, description="least space around the target (m)")
    corridor: float = Field(0.12, gt=0.0, le=1.0, description="half-width of the corridor that must be blocked (m)")


SeededT = TypeVar("SeededT", bound=SeededOptions)


class SeededSuite(SceneSuite[SeededT], Generic[SeededT]):
    """Scenes from seeds: ``NAME/7`` is the scene of seed 7. Coordinates are whole tenths of a millimetre.

    The target stands between two thirds and nine tenths of the shelf's depth, and some of the obstacles in its corridor.

    Attributes:
        name: The suite's name.
        listed: Of how many seeds the scenes are listed.
        crowd: Where its obstacles stand, as the error says it that they find no place.
        remedy: What that error says is to be done.
    """

    name: ClassVar[str]
    listed: ClassVar[int]
    crowd: ClassVar[str] = "before a target"
    remedy: ClassVar[str] = "lower count, radius or blocking, or enlarge the shelf"

    def __init__(self, options: SeededT | None = None) -> None:
        super().__init__(cast(SeededT, self.options_type()) if options is None else options)

    @abstractmethod
    def layout(self, draws: Draws) -> Layout:
        """What a scene must keep to; the first of its draws may be used for it."""

    def names(self) -> tuple[str, ...]:
        """The first seeds; any other whole number is a scene too."""
        return tuple(str(seed) for seed in range(self.listed))

    def load(self, name: str) -> Scene:
        """The scene of a seed.

        Args:
            name: The seed: a whole number from 0, without leading zeros.

        Raises:
            UnknownNameError: If the name is no such number.
            SceneError: If so many objects of that size find no place.
        """
        draws = Draws(self._seed(name))
        layout = self.layout(draws)
        places = place_objects(layout, draws)
        if isinstance(places, int):
            raise SceneError(self._no_room(layout, places), f"{self.name}/{name}")
        return self._scene(f"{self.name}/{name}", places)

    def lengths(self) -> dict[str, Any]:
        """The lengths of a layout, in whole tenths of a millimetre; rounded so that nothing can overlap or stand outside."""
        options = self.options
        return {
            "depth": rounded_down(options.depth),
            "width": rounded_down(options.width),
            "radius": rounded_up(options.radius),
            "gap": rounded_up(options.gap),
            "target_gap": rounded_up(options.target_gap),
            "corridor": rounded_up(options.corridor),
        }

    def _seed(self, name: str) -> int:
        if name.isascii() and name.isdigit() and len(name) <= _LONGEST_SEED and str(int(name)) == name:
            return int(name)
        known = [f"{self.name}/{each}" for each in self.names()]
        hint = f"Every whole number from 0 (up to {_LONGEST_SEED} digits, no leading zeros) is a scene."
        raise UnknownNameError("scene", f"{self.name}/{name}", known, hint)

    def _scene(self, name: str, places: list[Point]) -> Scene:
        options = self.options
        shape = Cylinder(options.radius, options.object_height)
        ids = [*(f"object_{i}" for i in range(1, len(places))), "target"]
        items = tuple(
            SceneObject(each, shape, (x / _UNITS, y / _UNITS)) for each, (x, y) in zip(ids, places, strict=True)
        )
        return Scene(name, Shelf(options.depth, options.width, options.height), items, "target")

    def _no_room(self, layout: Layout, most: int) -> str:
        options = self.options
        return (
            f"no place for {layout.count} obstacles of radius {options.radius:g} m {self.crowd} in a shelf of "
            f"{options.depth:g} x {options.width:g} m, at least {layout.blocking} of them in its corridor: {most} at most "
            f"found one; {self.remedy}"
        )


def rounded_down(length: float) -> int:
    """A length (m) in whole tenths of a millimetre, not more than it is."""
    return math.floor(round(length * _UNITS, 6))  # 0.61 m is 6100 steps, not 6099


def rounded_up(length: float) -> int:
    """A length (m) in whole tenths of a millimetre, not less than it is."""
    return math.ceil(round(length * _UNITS, 6))
