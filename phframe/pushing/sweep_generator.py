"""Generates sweeps for a component: the paper's (Algorithm 3), and what to do where that does not fit."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from phframe.core import FloatArray
from phframe.core.gripper_path import LEAST_AHEAD
from phframe.geometry.arm_view import ArmView
from phframe.pushing.corridor import Corridor
from phframe.pushing.deviation import Deviation
from phframe.pushing.grouping import bounding_rectangle
from phframe.pushing.options import ROUNDING, PushingOptions
from phframe.pushing.tilted_sweep import Component, Direction, Push, TiltedSweeps, Way

TILTS = tuple(math.radians(degrees) for degrees in (0.0, 10.0, -10.0, 20.0, -20.0, 30.0, -30.0))
"""Of the arm against the corridor, the way it pushes, tried in this order (rad)."""


class SweepGenerator:
    """Sweeps for one component in one corridor, by one arm.

    Args:
        corridor: The corridor.
        members: Centres ``(k, 2)`` of the component in the corridor frame (m).
        radius: The largest radius among them (m).
        target_radius: Of the target (m).
        view: The arm in the shelf, fingers closed.
        options: For clearances and tilts.
    """

    def __init__(
        self,
        corridor: Corridor,
        members: FloatArray,
        radius: float,
        target_radius: float,
        view: ArmView,
        options: PushingOptions,
    ) -> None:
        self._options = options
        self._corridor, self._shelf, self._view = corridor, view.shelf, view
        self._radius, self._target_radius = radius, target_radius
        self.rectangle = bounding_rectangle(members)
        self._component = Component(members, self.rectangle, radius)
        self._direction = self._papers_direction()

    def pushes(self) -> Iterator[Push]:
        """The sweeps to be tried, best first: the paper's one, as far as walls and target allow it, or all that fit."""
        if self._options.sweeps == "fitted":
            yield from self._best()
        else:
            yield from filter(None, self._sweeps([Way(self._direction, 0.0)]).paper())

    def clearance(self, push: Push) -> float:
        """Least distance of the arm from walls and from the target all the way through a push of this generator's (m)."""
        way = Way(push.sweep.direction, push.sweep.tilt)
        return self._sweeps([way]).clearance(push)

    def all_clearing(self) -> list[Push]:
        """Every fitted sweep that clears, at any tilt: first those that ram nothing, then in the order they are tried in."""
        clearing = (push for pushes in self._fitted for push in pushes if push.clears)
        return sorted(clearing, key=lambda push: push.rams)

    def neighbours(self, push: Push) -> list[Push]:
        """The sweeps next to one: less or more deep, in a lane farther off or nearer, at the next tilts; as far as they fit.

        They push in the same direction; those that clear come first.

        Args:
            push: One of this generator's.
        """
        sweep, step = push.sweep, self._radius / 2.0
        ways = sorted(self._ways(sweep.direction), key=lambda way: way.tilt)
        place = next(row for row, way in enumerate(ways) if way.tilt == sweep.tilt)
        turned = [ways[row] for row in (place - 1, place + 1) if 0 <= row < len(ways)]
        deeper = np.array([-step, step, 0.0, 0.0, *[0.0] * len(turned)])
        aside = np.array([0.0, 0.0, -step, step, *[0.0] * len(turned)]) * sweep.direction
        sweeps = self._sweeps([*[ways[place]] * 4, *turned])
        found = sweeps.at(sweep.depth + deeper, sweep.lane + aside)
        others = {each.sweep: each for each in found if each is not None and each.sweep != sweep}
        return sorted(others.values(), key=lambda each: not each.clears)

    def _best(self) -> Iterator[Push]:
        """The sweeps that fit.

        In each direction, the paper's before the other, the one that clears with the least tilt and rams nothing on its
        way in; where there is none, one that clears all the same; then those that fit at the least tilt but do not clear.
        """
        second_best: list[Push] = []
        third_best: list[Push] = []
        for pushes in self._fitted:
            best = next((push for push in pushes if push.clears and not push.rams), None)
            if best is not None:
                yield best
            else:
                second_best += [push for push in pushes if push.clears][:1]
            third_best += [push for push in pushes[:1] if not push.clears]
        yield from second_best
        for push in third_best:
            yield replace(push, deviations=(*push.deviations, Deviation.NOT_CLEARING))

    @cached_property
    def _fitted(self) -> tuple[list[Push], list[Push]]:
        """Those that fit in the paper's direction, and in the other one, in the order of the tilts."""
        mine, others = (self._ways(direction) for direction in (self._direction, -self._direction))
        found = self._sweeps([*mine, *others]).fitted()
        return [*filter(None, found[: len(mine)])], [*filter(None, found[len(mine) :])]

    def _ways(self, direction: Direction) -> list[Way]:
        """How the arm may push in a direction, in the order that it is tried in."""
        why = () if direction == self._direction else (self._why_other(direction),)
        tilts = (lean * direction for lean in (TILTS if self._has_room(direction) else TILTS[:1]))
        within = (tilt for tilt in tilts if abs(tilt) <= self._options.max_tilt + ROUNDING)
        ahead = (tilt for tilt in within if math.cos(self._corridor.angle + tilt) >= LEAST_AHEAD)
        return [Way(direction, tilt, (*why, Deviation.TILTED) if tilt else why) for tilt in ahead]

    def _sweeps(self, ways: Sequence[Way]) -> TiltedSweeps:
        return TiltedSweeps(self._corridor, self._component, self._view, self._target_radius, ways, self._options)

    def _has_room(self, direction: Direction) -> bool:
        """Whether there is room for the members outside the corridor, at any tilt: if not, nothing clears."""
        corridor, members = self._corridor, self._component.centers
        edge = corridor.axis + direction * corridor.half_width
        across = corridor.to_shelf(np.column_stack([members[:, 0], np.full(len(members), edge)]))[:, 1]
        return bool(((across > self._radius) & (across < self._shelf.width - self._radius)).all())

    def _papers_direction(self) -> Direction:
        """Towards the side of the corridor's centre line on which the rectangle lies."""
        corridor, rectangle = self._corridor, self.rectangle
        offset = float(rectangle.center[1]) - corridor.axis
        if offset == 0.0:
            middle = corridor.to_local(np.array([self._shelf.depth / 2.0, self._shelf.width / 2.0]))
            return -1 if rectangle.center[1] <= middle[1] else 1
        return 1 if offset > 0.0 else -1

    def _why_other(self, direction: Direction) -> Deviation:
        """Why to push in this direction, which is not the paper's."""
        corridor, rectangle = self._corridor, self.rectangle
        reach = corridor.half_width - self._radius
        spans = rectangle.lower[1] <= corridor.axis - reach and rectangle.upper[1] >= corridor.axis + reach
        from_nearer = direction == (1 if corridor.to_shelf(rectangle.center)[1] <= self._shelf.width / 2.0 else -1)
        return Deviation.SPANS_CORRIDOR if spans and from_nearer else Deviation.OTHER_DIRECTION
