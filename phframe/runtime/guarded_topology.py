"""A foreign topology engine under watch: it is given copies, and what it returns is checked."""

from __future__ import annotations

from typing import Any

import numpy as np

from phframe.core import FloatArray, IntArray, Options, PersistenceDiagram, TopologyEngine
from phframe.registry import Kind
from phframe.runtime.blame import is_own, title_of
from phframe.runtime.border import refused


def guarded_topology(engine: TopologyEngine[Any]) -> TopologyEngine[Any]:
    """An engine as it is to be used: phframe's own as it is, another under watch."""
    return engine if is_own(engine) else GuardedTopology(engine)


class GuardedTopology(TopologyEngine[Options]):
    """Does what another engine does.

    Args:
        engine: The other.
    """

    def __init__(self, engine: TopologyEngine[Any]) -> None:
        super().__init__(engine.options)
        self.__wrapped__, self._title = engine, title_of(Kind.TOPOLOGY, engine)

    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        """The other's.

        Raises:
            PluginError: If it is no diagram of so many points.
        """
        found = self.__wrapped__.diagram(points.copy())
        if not isinstance(found, PersistenceDiagram):
            raise refused(self._title, f"a {type(found).__name__} is no PersistenceDiagram")
        births, deaths = (np.asarray(each, dtype=np.float64) for each in (found.births, found.deaths))
        if births.ndim != 1 or births.shape != deaths.shape or len(births) > len(points):
            raise refused(self._title, f"a diagram of {len(points)} points has births {births.shape}, {deaths.shape}")
        if not np.isfinite(births).all() or (births < 0).any() or not (deaths >= births).all():
            raise refused(
                self._title, "a bar of its diagram is born before 0, dies before it is born or is not a number"
            )
        if (np.diff(deaths[np.isfinite(deaths)]) < 0).any() or np.isinf(deaths).sum() != min(len(points), 1):
            raise refused(self._title, "deaths ascend, and exactly the last is infinite")
        return PersistenceDiagram(births, deaths)

    def components(self, points: FloatArray, radius: float) -> IntArray:
        """The other's.

        Raises:
            PluginError: If they are no labels of so many points.
        """
        found = np.array(self.__wrapped__.components(points.copy(), radius))
        if found.shape != (len(points),) or found.dtype.kind not in "iu":
            raise refused(self._title, f"the labels of {len(points)} points are whole numbers, not {found!r:.80}")
        first = np.sort(np.unique(found, return_index=True)[1])
        if not np.array_equal(found[first], np.arange(len(first))):
            raise refused(self._title, "labels count from 0 in the order in which components first appear")
        return found.astype(np.int64)
