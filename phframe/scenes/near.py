"""Scenes whose target is near a side wall, where corridors are angled or obstacles have no place to go."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

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
        description="greatest distance of the target's centre from the nearer side wall (m)",
    )
    wall_gap: Space = Field(0.01, description="least space between the target and the side wall (m)")


class NearScenes(SeededSuite[NearOptions]):
    """Scenes from seeds whose target is near a side wall: ``near/7`` is that of seed 7.

    With w the corridor's half-width and r the radius of the objects, a third of the targets are nearer to the wall than w,
    down to where fingers hardly fit between: their corridors are angled. A third are from w to w + r from it: their
    corridors are straight, and obstacles beside them have no place to go. The others are from w + r to 1.5 w from it.
    """

    options_type = NearOptions
    name = "near"
    listed = 30
    crowd = "before a target so near to a side wall"
    remedy = "lower count, radius, blocking or wall_gap, raise beside, or enlarge the shelf"

    def layout(self, draws: Draws) -> Layout:
        """The options in whole tenths of a millimetre."""
        options = self.options
        blocking, wall_gap = min(options.blocking, options.count), rounded_up(options.wall_gap)
        layout = Layout(count=options.count, blocking=blocking, wall_gap=wall_gap, **self.lengths())
        return replace(layout, bands=_bands(layout, rounded_down(options.beside)))


def _bands(layout: Layout, beside: int) -> tuple[tuple[int, int], ...]:
    """Least and greatest distances from the wall: less than w, from w to w + r, and from there to ``beside``."""
    margin, w = layout.target_margin, layout.corridor
    edges = (margin, w, w + layout.radius, beside + 1)
    farthest = min(beside, layout.width - margin)
    found = ((max(low, margin), min(high - 1, farthest)) for low, high in pairwise(edges))
    return tuple((low, high) for low, high in found if low <= high)
