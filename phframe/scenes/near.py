"""Scenes whose target is near a side wall, where corridors are angled or obstacles have no place to go."""

from __future__ import annotations

from pydantic import Field

from phframe.scenes.draws import Draws
from phframe.scenes.generator import RandomOptions
from phframe.scenes.placement import Layout
from phframe.scenes.seeded import Length, SeededSuite, Space, rounded_down, rounded_up


class NearOptions(RandomOptions):
    """How near to a side wall the target stands; the rest as in random scenes.

    Lengths are used in steps of 0.1 mm.
    """

    beside: Length = Field(
        0.18,
        description="greatest distance of the target's centre from the nearer side wall (m): 1.5 corridor half-widths",
    )
    wall_gap: Space = Field(0.01, description="least space between the target and the side wall (m)")


class NearScenes(SeededSuite[NearOptions]):
    """Scenes from seeds whose target is near a side wall: ``near/7`` is that of seed 7.

    Its distance from the wall is evenly spread from where fingers hardly fit between (0.04 m) to 1.5 corridor half-widths
    (0.18 m), beside the south and the north wall alike: the corridor is angled in most of them. Where it is straight,
    obstacles between it and the wall have little place to go, or none.
    """

    options_type = NearOptions
    name = "near"
    listed = 30
    crowd = "before a target so near to a side wall"
    remedy = "lower count, radius, blocking or wall_gap, raise beside, or enlarge the shelf"

    def layout(self, draws: Draws) -> Layout:
        """The options in whole tenths of a millimetre."""
        options = self.options
        return Layout(
            count=options.count,
            blocking=min(options.blocking, options.count),
            wall_gap=rounded_up(options.wall_gap),
            beside=rounded_down(options.beside),
            **self.lengths(),
        )
