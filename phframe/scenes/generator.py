"""Random scenes like the published examples."""

from __future__ import annotations

from pydantic import Field

from phframe.scenes.draws import Draws
from phframe.scenes.placement import Layout
from phframe.scenes.seeded import SeededOptions, SeededSuite


class RandomOptions(SeededOptions):
    """What random scenes are like. The defaults are the size and the crowd of the published examples.

    Lengths are used in steps of 0.1 mm.
    """

    count: int = Field(9, ge=1, le=200, description="number of obstacles")


class RandomScenes(SeededSuite[RandomOptions]):
    """Scenes from seeds: ``random/7`` is the scene of seed 7.

    The target stands between two thirds and nine tenths of the shelf's depth, every obstacle nearer to the mouth than
    it, and some of them in its corridor.
    """

    options_type = RandomOptions
    name = "random"
    listed = 10

    def layout(self, draws: Draws) -> Layout:
        """The options in whole tenths of a millimetre."""
        count = self.options.count
        return Layout(count=count, blocking=min(self.options.blocking, count), **self.lengths())
