"""Crowded scenes: a target deep in the shelf, with objects all around it."""

from __future__ import annotations

from pydantic import Field, ValidationInfo, field_validator
from pydantic_core import PydanticCustomError

from phframe.scenes.draws import Draws
from phframe.scenes.placement import Layout
from phframe.scenes.seeded import SeededOptions, SeededSuite, Space, rounded_up


class DenseOptions(SeededOptions):
    """How crowded dense scenes are. By default their objects cover 17 to 34 % of the board.

    Lengths are used in steps of 0.1 mm.
    """

    blocking: int = Field(4, ge=1, le=200, description="least number of obstacles in the target's corridor")
    fewest: int = Field(20, ge=2, le=200, description="least number of objects, the target among them")
    most: int = Field(
        40, ge=2, le=200, validate_default=True, description="greatest number of objects, the target among them"
    )
    wall_gap: Space = Field(0.025, description="least space between the target and the side walls (m)")

    @field_validator("most")
    @classmethod
    def _not_below_fewest(cls, most: int, info: ValidationInfo) -> int:
        fewest = info.data.get("fewest", most)  # absent where it is wrong itself
        if most < fewest:
            raise PydanticCustomError("below_fewest", "less than fewest, {fewest}", {"fewest": fewest})
        return most


class DenseScenes(SeededSuite[DenseOptions]):
    """Crowded scenes from seeds: 20 to 40 objects that cover 17 to 34 % of the board; ``dense/7`` is that of seed 7.

    The target stands between two thirds and nine tenths of the shelf's depth, where fingers fit between it and the side
    walls; obstacles stand before, beside and behind it, at least four of them in its corridor.
    """

    options_type = DenseOptions
    name = "dense"
    listed = 30
    crowd = "around a target"
    remedy = "lower most, radius, blocking or wall_gap, or enlarge the shelf"

    def layout(self, draws: Draws) -> Layout:
        """The options in whole tenths of a millimetre, and a number of obstacles that is drawn first."""
        options = self.options
        count = draws.between(options.fewest, options.most) - 1
        return Layout(
            count=count,
            blocking=min(options.blocking, count),
            wall_gap=rounded_up(options.wall_gap),
            anywhere=True,
            **self.lengths(),
        )
