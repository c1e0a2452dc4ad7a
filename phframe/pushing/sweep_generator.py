"""Generates sweeps for a component: the paper's (Algorithm 3), and what to do where that does not fit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from phframe.core import FloatArray
from phframe.core.gripper_path import LEAST_AHEAD
from phframe.geometry.arm_view import ArmView
from phframe.pushing.corridor import Corridor
from phframe.pushing.deviation import Deviation
from phframe.pushing.grouping import bounding_rectangle
from phframe.pushing.options import ROUNDING, PushingOptions
from phframe.pushing.tilted_sweep import Component, Deviations, Direction, Push, TiltedSweep

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

    def pushes(self) -> Iterator[Push]:
        """The sweeps to be tried, best first: the paper's one, as far as walls and target allow it, or all that fit."""
        if self._options.sweeps == "fitted":
            yield from self._fitted()
        elif push := self._sweep(self._direction(), 0.0).paper():
            yield push

    def _fitted(self) -> Iterator[Push]:
        """The sweeps that fit.

        In each direction, the paper's before the other, the one that clears with the least tilt and rams nothing on its
        way in; where there is none, one that clears all the same; then those that fit at the least tilt but do not clear.
        """
        direction = self._direction()
        other: Direction = -1 if direction == 1 else 1
        second_best: list[Push] = []
        third_best: list[Push] = []
        for way, deviations in ((direction, ()), (other, (self._why_other(other),))):
            pushes = list(_until_one_clears(self._tilted(way, deviations)))
            if pushes and _is_best(pushes[-1]):
                yield pushes[-1]
            else:
                second_best += [push for push in pushes if push.clears][:1]
            third_best += [push for push in pushes[:1] if not push.clears]
        yield from second_best
        for push in third_best:
            yield replace(push, deviations=(*push.deviations, Deviation.NOT_CLEARING))

    def _tilted(self, direction: Direction, deviations: Deviations) -> Iterator[Push]:
        for lean in TILTS if self._has_room(direction) else TILTS[:1]:
            tilt = lean * direction
            if abs(tilt) > self._options.max_tilt + ROUNDING:
                continue
            if math.cos(self._corridor.angle + tilt) < LEAST_AHEAD:
                continue
            settled = (*deviations, Deviation.TILTED) if tilt else deviations
            push = self._sweep(direction, tilt).push(settled)
            if push is not None:
                yield push

    def _sweep(self, direction: Direction, tilt: float) -> TiltedSweep:
        return TiltedSweep(
            self._corridor,
            self._component,
            self._view,
            self._target_radius,
            direction=direction,
            tilt=tilt,
            options=self._options,
        )

    def _has_room(self, direction: Direction) -> bool:
        """Whether there is room for the members outside the corridor, at any tilt: if not, nothing clears."""
        corridor, members = self._corridor, self._component.centers
        edge = corridor.axis + direction * corridor.half_width
        across = corridor.to_shelf(np.column_stack([members[:, 0], np.full(len(members), edge)]))[:, 1]
        return bool(((across > self._radius) & (across < self._shelf.width - self._radius)).all())

    def _direction(self) -> Direction:
        """The paper's: towards the side of the corridor's centre line on which the rectangle lies."""
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


def _until_one_clears(pushes: Iterator[Push]) -> Iterator[Push]:
    for push in pushes:
        yield push
        if _is_best(push):
            return


def _is_best(push: Push) -> bool:
    return push.clears and not push.rams
