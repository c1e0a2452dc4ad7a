"""One sweep: one component, one direction, one tilt of the arm, fitted between the walls and past the target."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from phframe.core import MOUTH_CLEARANCE, FloatArray, rotation_matrix
from phframe.geometry.arm_view import ArmView
from phframe.geometry.straight_motion import distances_on_way_in, swept_distances
from phframe.pushing.corridor import Corridor
from phframe.pushing.deviation import Deviation
from phframe.pushing.grouping import Rectangle
from phframe.pushing.options import PushingOptions
from phframe.pushing.sweep import Sweep

Direction = Literal[1, -1]
Deviations = tuple[str, ...]

ENGAGEMENT = 0.9
"""A fingertip short of a centre by more than this many radii slips off ahead of it."""
ROUNDING = 1e-6
"""Kept from every limit (m), so that no answer hangs on rounding."""
HEAD_ON = 0.5
"""An arm that comes nearer to a centre than this many radii pushes what it meets ahead of it."""
SHORTEST_SWEEP = 1e-3
"""A sweep shorter than this (m) moves nothing."""
EDGE_SURPLUS = 1e-3
"""How far past the corridor's edge the leading side goes (m), so that what it pushed is outside, not on the edge."""


@dataclass(frozen=True, slots=True)
class Push:
    """A sweep that fits, with the deviations it needed.

    Attributes:
        sweep: The push.
        deviations: By name.
        clears: Whether everything pushed ends outside the corridor.
        rams: Whether the arm, on its way in, meets something head-on that it is to push sideways.
    """

    sweep: Sweep
    deviations: Deviations
    clears: bool
    rams: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Component:
    """What is to be pushed, in the corridor frame.

    Attributes:
        centers: Of its members ``(k, 2)`` (m).
        rectangle: Around them.
        radius: The largest among them (m).
    """

    centers: FloatArray
    rectangle: Rectangle
    radius: float


class TiltedSweep:
    """Fits a sweep. Made, asked once and dropped.

    Args:
        corridor: The corridor.
        component: What is to be pushed.
        view: The arm in the shelf, fingers closed.
        target_radius: Of the target (m).
        direction: Of the push.
        tilt: Of the arm against the corridor (rad).
        options: For the clearances.
    """

    def __init__(
        self,
        corridor: Corridor,
        component: Component,
        view: ArmView,
        target_radius: float,
        *,
        direction: Direction,
        tilt: float,
        options: PushingOptions,
    ) -> None:
        self._corridor, self._component, self._shelf = corridor, component, view.shelf
        self._direction, self._tilt = direction, tilt
        self._keep_off = options.target_clearance * target_radius
        self._lane_clearance = options.lane_clearance
        self._arm = view.silhouette(tilt)
        self._front = view.silhouette(corridor.angle + tilt).front
        self._walls = view.walls(corridor.angle + tilt)
        self._boxes = view.boxes

    def paper(self) -> Push | None:
        """The paper's sweep, whatever it meets: to the rectangle's far edge or as near to the target as is allowed."""
        far = float(self._component.rectangle.upper[0])
        push = self._at(far, ())
        if push is None or (allowed := self._depth_allowed(push.sweep)) >= far:
            return push
        return self._at(allowed, ())

    def push(self, deviations: Deviations) -> Push | None:
        """The sweep to the rectangle's far edge, or as far as the target allows; None where no member would be met.

        Where the target does not let it in far enough to touch anything, the lane makes way instead of the depth.
        """
        far = float(self._component.rectangle.upper[0])
        push = self._at(far, deviations)
        allowed = far if push is None else self._depth_allowed(push.sweep)
        if allowed < far:
            push = self._at(allowed, deviations)
            if push is None or not self._touches(push.sweep):
                push = self._at(far, (*deviations, Deviation.LANE_SHIFTED), past_target=True)
                if push is not None and self._depth_allowed(push.sweep) < far:
                    return None
        return push if push is not None and self._touches(push.sweep) and self._meets(push.sweep) else None

    def _at(self, depth: float, deviations: Deviations, *, past_target: bool = False) -> Push | None:
        """The sweep at a depth, clamped to the walls; with ``past_target`` in a lane that passes the target by."""
        limits = self._limits(depth)
        if limits is None:
            return None
        sides = self._arm.side(self._component.centers[:, 0] - depth, self._direction)
        wanted = (self._lane_past_target() if past_target else self._lane(depth), self._end(sides))
        lane, end = (min(max(y, limits[0]), limits[1]) for y in wanted)
        end = self._direction * min(self._direction * end, self._room(sides))
        if (end - lane) * self._direction < SHORTEST_SWEEP:
            return None
        clamped = [(lane, wanted[0], Deviation.LANE_CLAMPED), (end, wanted[1], Deviation.SWEEP_CLAMPED)]
        settled = (*deviations, *(deviation for value, wish, deviation in clamped if value != wish))
        sweep = self._with_ways(depth, lane, end)
        return None if sweep is None else Push(sweep, settled, self._clears(sweep, sides), self._rams(sweep))

    def _rams(self, sweep: Sweep) -> bool:
        """Whether the straight way in leads through the middle of a member, which then goes deeper, not aside."""
        tip = np.array([sweep.depth, sweep.lane])
        local = (self._component.centers - tip) @ rotation_matrix(self._tilt)
        lower, upper = self._boxes
        distances = distances_on_way_in(local, lower, upper, sweep.entry)
        return bool((distances < HEAD_ON * self._component.radius).any())

    def _lane(self, depth: float) -> float:
        """Beside the rectangle, on the side away from the push."""
        rectangle, radius = self._component.rectangle, self._component.radius
        nearest, farthest = rectangle.lower[0] - radius - depth, rectangle.upper[0] + radius - depth
        beside = self._arm.widest_side(nearest, farthest, self._direction) + radius + self._lane_clearance
        return float(rectangle.lower[1] - beside if self._direction == 1 else rectangle.upper[1] + beside)

    def _lane_past_target(self) -> float:
        """As near to the target as the fingertip may go, on the side that it pushes away from."""
        behind = float(self._arm.side(np.zeros(1), -self._direction)[0])
        return self._corridor.axis + self._direction * (self._keep_off + behind + 1e-6)

    def _end(self, sides: FloatArray) -> float:
        """Where the leading side has reached the corridor's edge at the depth of every member."""
        edge = self._corridor.half_width + EDGE_SURPLUS
        return self._corridor.axis + self._direction * (edge - float(sides.min()))

    def _room(self, sides: FloatArray) -> float:
        """How far the fingertip can sweep, counted in the push's direction, before a member is squeezed against a wall (m)."""
        corridor, radius = self._corridor, self._component.radius
        wall = self._shelf.width - radius if self._direction * math.cos(corridor.angle) > 0.0 else radius
        across = wall - corridor.to_shelf(np.column_stack([self._component.centers[:, 0], np.zeros(len(sides))]))[:, 1]
        return float((self._direction * across / math.cos(corridor.angle) - radius - sides).min())

    def _touches(self, sweep: Sweep) -> bool:
        """Whether the fingertip gets far enough past the front of the nearest member to push it sideways."""
        return bool(sweep.depth > self._component.rectangle.lower[0] - ENGAGEMENT * self._component.radius)

    def _meets(self, sweep: Sweep) -> bool:
        """Whether the arm meets a member on its way across or in: no wall keeps it short of all, nor is its lane beyond them."""
        before, inserted, swept, _ = sweep.waypoints
        members, radius = self._component.centers, self._component.radius - ROUNDING
        return any(
            bool((swept_distances(self._arm.parts + a, b - a, members) < radius).any())
            for a, b in ((inserted, swept), (before, inserted))
        )

    def _depth_allowed(self, sweep: Sweep) -> float:
        """How deep the fingertip may go so that nowhere between lane and end it comes too near to the target."""
        north, south = (float(self._arm.side(np.zeros(1), way)[0]) for way in (1, -1))
        low, high = min(sweep.lane, sweep.end) - south, max(sweep.lane, sweep.end) + north
        beside = max(low - self._corridor.axis, self._corridor.axis - high, 0.0)
        if beside >= self._keep_off:
            return sweep.depth
        return min(sweep.depth, self._corridor.end - math.sqrt(self._keep_off**2 - beside**2))

    def _clears(self, sweep: Sweep, sides: FloatArray) -> bool:
        """Whether every member, pushed to one radius ahead of the leading side, is outside and has room there."""
        radius = self._component.radius
        pushed = sweep.end + sweep.direction * (sides + radius)
        outside = (pushed - self._corridor.axis) * sweep.direction > self._corridor.half_width
        across = self._corridor.to_shelf(np.column_stack([self._component.centers[:, 0], pushed]))[:, 1]
        room = (across >= radius - ROUNDING) & (across <= self._shelf.width - radius + ROUNDING)
        return bool((outside & room).all())

    def _limits(self, depth: float) -> tuple[float, float] | None:
        """Least and greatest y of the fingertip at a depth (m); None where the arm does not fit at all."""
        axis, angle = self._corridor.axis, self._corridor.angle
        start = self._corridor.to_shelf(np.array([depth, axis]))
        if not self._walls.is_free(start):
            return None
        across = np.array([-math.sin(angle), math.cos(angle)])
        far = self._shelf.depth + self._shelf.width
        south, north = (float(self._walls.travel(start, way * across, far)) - ROUNDING for way in (-1.0, 1.0))
        return axis - south, axis + north

    def _with_ways(self, depth: float, lane: float, end: float) -> Sweep | None:
        """Add the straight ways in and out, from where the whole arm is before the mouth; None where a wall is in it."""
        yaw = self._corridor.angle + self._tilt
        ahead = np.array([math.cos(yaw), math.sin(yaw)])
        lengths = []
        for y in (lane, end):
            tip = self._corridor.to_shelf(np.array([depth, y]))
            length = float(tip[0] + self._front + MOUTH_CLEARANCE) / ahead[0]
            if self._walls.travel(tip, -ahead, length) < length:
                return None
            lengths.append(length)
        return Sweep(self._direction, depth, lane, end, lengths[0], lengths[1], self._tilt)
