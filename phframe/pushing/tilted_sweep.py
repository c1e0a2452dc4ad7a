"""Sweeps of one component, each in one direction at one tilt of the arm, fitted between the walls and past the target."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from phframe.core import MOUTH_CLEARANCE, FloatArray, IntArray, rotated_in_plane, rotation_matrix
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
    rams: bool


@dataclass(frozen=True, slots=True)
class Way:
    """How the arm is to push.

    Attributes:
        direction: Of the push.
        tilt: Of the arm against the corridor (rad).
        deviations: That led to it, by name.
    """

    direction: Direction
    tilt: float
    deviations: Deviations = ()


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


class _Sweeps(NamedTuple):
    """Sweeps in numbers, one for each way ``(b,)``; see ``Sweep``.

    Attributes:
        depth: Of the fingertip ``(b,)`` (m).
        ends: The lane, and where the sweep ends ``(2, b)`` (m).
        lengths: Of the ways in, and out ``(2, b)`` (m).
        sides: How far the leading side is ahead of the fingertip at the depth of each member ``(k, b)`` (m).
        clamped: Whether a wall keeps the lane, and the end, from where they should be ``(2, b)``.
        fits: Whether there is a sweep at all ``(b,)``.
    """

    depth: FloatArray
    ends: FloatArray
    lengths: FloatArray
    sides: FloatArray
    clamped: NDArray[np.bool_]
    fits: NDArray[np.bool_]

    def where(self, mask: NDArray[np.bool_], others: _Sweeps) -> _Sweeps:
        """Those of a mask ``(b,)``, and others in place of the rest."""
        return _Sweeps(*(np.where(mask, mine, other) for mine, other in zip(self, others, strict=True)))

    def among(self, mask: NDArray[np.bool_]) -> _Sweeps:
        """The same, of which none fits but those of a mask ``(b,)`` that did."""
        return self._replace(fits=self.fits & mask)

    @property
    def tips(self) -> FloatArray:
        """The fingertip inserted, and swept ``(2, b, 2)``, in the corridor frame (m)."""
        return _points(self.depth, self.ends)


class TiltedSweeps:
    """Fits a sweep in each of several ways, all at once. Holds nothing that changes.

    Args:
        corridor: The corridor.
        component: What is to be pushed.
        view: The arm in the shelf, fingers closed.
        target_radius: Of the target (m).
        ways: How the arm is to push.
        options: For the clearances.
    """

    def __init__(
        self,
        corridor: Corridor,
        component: Component,
        view: ArmView,
        target_radius: float,
        ways: Sequence[Way],
        options: PushingOptions,
    ) -> None:
        self._corridor, self._component, self._shelf = corridor, component, view.shelf
        self._ways, self._direction = ways, np.array([float(way.direction) for way in ways])
        self._target_radius, self._keep_off = target_radius, options.target_clearance * target_radius
        self._lane_clearance = options.lane_clearance
        tilts = tuple(way.tilt for way in ways)
        yaws = tuple(corridor.angle + tilt for tilt in tilts)
        self._arm, self._in_shelf, self._walls = view.silhouette(tilts), view.silhouette(yaws), view.walls(yaws)
        self._boxes, self._cos = view.boxes, math.cos(corridor.angle)
        self._turn = rotation_matrix(corridor.angle).T
        self._members_y = corridor.to_shelf(component.centers * [1.0, 0.0])[:, 1]
        self._room = self._room_at_walls()
        self._far = np.full(len(ways), float(component.rectangle.upper[0]))

    def paper(self) -> list[Push | None]:
        """The paper's sweeps, whatever they meet: to the rectangle's far edge or as near to the target as is allowed."""
        sweeps = self._at(self._far, self._lane(self._far))
        allowed = self._depth_allowed(sweeps)
        nearer = self._at(allowed, self._lane(allowed))
        return self._pushes(sweeps.where(~sweeps.fits | (allowed >= self._far), nearer))

    def fitted(self) -> list[Push | None]:
        """The sweeps to the rectangle's far edge, or as far as the target allows; None where no member would be met.

        Where the target does not let one in far enough to touch anything, the lane makes way instead of the depth.
        """
        far = self._far
        sweeps = self._at(far, self._lane(far))
        allowed = np.where(sweeps.fits, self._depth_allowed(sweeps), far)
        shifted = allowed < far
        if shifted.any():
            nearer = self._at(allowed, self._lane(allowed))
            sweeps = sweeps.where(~shifted, nearer)
            shifted &= ~(nearer.fits & self._touches(nearer))
        if shifted.any():
            past = self._at(far, self._lane_past_target())
            sweeps = past.among(self._depth_allowed(past) >= far).where(shifted, sweeps)
        return self._pushes(self._meeting(sweeps), shifted)

    def at(self, depth: FloatArray, lane: FloatArray) -> list[Push | None]:
        """The sweeps at depths and in lanes ``(b,)`` of the corridor frame (m), as far as walls allow; None as in ``fitted``."""
        sweeps = self._at(depth, lane)
        return self._pushes(self._meeting(sweeps.among(self._depth_allowed(sweeps) >= depth)))

    def _at(self, depth: FloatArray, lane: FloatArray) -> _Sweeps:
        """The sweeps at depths, in lanes ``(b,)``, clamped to the walls."""
        least, most = self._limits(depth)
        sides = self._arm.side(self._component.centers[:, :1] - depth, self._direction)
        wanted = np.array([lane, self._end(sides)])
        ends = np.minimum(np.maximum(wanted, least), most)
        ends[1] = self._direction * np.minimum(self._direction * ends[1], (self._room - sides).min(axis=0))
        lengths, out = self._ways_out(depth, ends)
        fits = out & ((ends[1] - ends[0]) * self._direction >= SHORTEST_SWEEP)
        return _Sweeps(depth, ends, lengths, sides, ends != wanted, fits)

    def _limits(self, depth: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Least and greatest y of the fingertip at a depth (m); where the arm does not fit there is nothing between them."""
        axis, angle = self._corridor.axis, self._corridor.angle
        start = self._in_shelf_frame(_points(depth, np.full_like(depth, axis)))
        across = np.array([-math.sin(angle), math.cos(angle)])
        north, south = self._walls.room(start, across, self._shelf.depth + self._shelf.width)
        return axis - (south - ROUNDING), axis + (north - ROUNDING)

    def _in_shelf_frame(self, points: FloatArray) -> FloatArray:
        """Points ``(..., 2)`` of the corridor frame in the shelf frame."""
        return rotated_in_plane(points, self._turn) + self._corridor.origin

    def _lane(self, depth: FloatArray) -> FloatArray:
        """Beside the rectangle, on the side away from the push."""
        rectangle, radius = self._component.rectangle, self._component.radius
        nearest, farthest = rectangle.lower[0] - radius - depth, rectangle.upper[0] + radius - depth
        beside = self._arm.widest_side(nearest, farthest, self._direction) + radius + self._lane_clearance
        return np.asarray(np.where(self._direction > 0.0, rectangle.lower[1] - beside, rectangle.upper[1] + beside))

    def _lane_past_target(self) -> FloatArray:
        """As near to the target as the fingertip may go, on the side that it pushes away from."""
        north, south = self._arm.tip_sides
        behind = np.where(self._direction > 0.0, south, north)
        return self._corridor.axis + self._direction * (self._keep_off + behind + ROUNDING)

    def _end(self, sides: FloatArray) -> FloatArray:
        """Where the leading side has reached the corridor's edge at the depth of every member."""
        edge = self._corridor.half_width + EDGE_SURPLUS
        return np.asarray(self._corridor.axis + self._direction * (edge - sides.min(axis=0)))

    def _room_at_walls(self) -> FloatArray:
        """How far the leading side can sweep at each member's depth before that meets a wall ``(k, b)`` (m)."""
        radius, way = self._component.radius, self._direction
        walls = np.where(way * self._cos > 0.0, self._shelf.width - radius, radius)
        return np.asarray(way * (walls - self._members_y[:, None]) / self._cos - radius)

    def _ways_out(self, depth: FloatArray, ends: FloatArray) -> tuple[FloatArray, NDArray[np.bool_]]:
        """Lengths ``(2, b)`` of the straight ways in and out (m), and whether no wall is in either of them.

        They begin and end where the whole arm is before the mouth.
        """
        tips = self._in_shelf_frame(_points(depth, ends))
        lengths = (tips[..., 0] + self._in_shelf.front + MOUTH_CLEARANCE) / self._walls.ahead[:, 0]
        return lengths, np.asarray(self._walls.lets_out(tips, lengths).all(axis=0))

    def _touches(self, sweeps: _Sweeps) -> NDArray[np.bool_]:
        """Whether the fingertip gets far enough past the front of the nearest member to push it sideways."""
        front = self._component.rectangle.lower[0] - ENGAGEMENT * self._component.radius
        return np.asarray(sweeps.depth > front)

    def _meeting(self, sweeps: _Sweeps) -> _Sweeps:
        """Those whose fingertip gets far enough, and whose arm meets a member on its way in or across.

        So no wall keeps it short of all, nor is its lane beyond them. Most pass over a member's centre with their leading
        side; of the rest the distances from all that they sweep over are taken.
        """
        fits = sweeps.fits & self._touches(sweeps)
        x, y = self._component.centers.T[..., None]
        begin, end = self._direction * sweeps.ends
        beside = self._direction * y - sweeps.sides
        passed = (begin <= beside) & (beside <= end) & (x <= sweeps.depth + self._arm.front)
        rows = np.flatnonzero(fits & ~passed.any(axis=0))
        if len(rows):
            distances = self._swept(sweeps, rows, self._component.centers)
            fits[rows] = (distances < self._component.radius - ROUNDING).any(axis=(0, 1))
        return sweeps._replace(fits=fits)

    def _swept(self, sweeps: _Sweeps, rows: IntArray, points: FloatArray) -> FloatArray:
        """Distances ``(n, 2, r)`` of points ``(n, 2)`` from what the arm sweeps over on its ways in and across (m)."""
        inserted, swept = sweeps.tips[:, rows]
        before = inserted - sweeps.lengths[0, rows, None] * self._arm.turns[rows, :, 0]
        parts = self._arm.parts[rows] + np.array([before, inserted])[:, :, None, None]
        return swept_distances(parts, np.array([inserted - before, swept - inserted]), points)

    def _depth_allowed(self, sweeps: _Sweeps) -> FloatArray:
        """How deep the fingertips may go so that nowhere between lane and end they come too near to the target ``(b,)`` (m)."""
        (north, south), axis = self._arm.tip_sides, self._corridor.axis
        low, high = sweeps.ends.min(axis=0) - south, sweeps.ends.max(axis=0) + north
        beside = np.maximum(np.maximum(low - axis, axis - high), 0.0)
        return np.minimum(sweeps.depth, [self._depth_beside(each) for each in beside.tolist()])

    def _depth_beside(self, beside: float) -> float:
        """How deep a fingertip may go that is beside the target by so much (m)."""
        if beside >= self._keep_off:
            return math.inf
        return self._corridor.end - math.sqrt(self._keep_off**2 - beside**2)

    def _pushes(self, sweeps: _Sweeps, shifted: NDArray[np.bool_] | None = None) -> list[Push | None]:
        """What fits, as pushes, with what they do; ``shifted``: those in a lane past the target."""
        numbers = np.concatenate([sweeps.depth[None], sweeps.ends, sweeps.lengths])[:, sweeps.fits].T.tolist()
        clears, rams = self._clears(sweeps).tolist(), self._rams(sweeps).tolist()
        pushes: list[Push | None] = [None] * len(self._ways)
        for row, (depth, lane, end, entry, leave) in zip(np.flatnonzero(sweeps.fits).tolist(), numbers, strict=True):
            way = self._ways[row]
            sweep = Sweep(way.direction, depth, lane, end, entry, leave, way.tilt)
            deviations = (*way.deviations, *self._deviations(sweeps, shifted, row))
            pushes[row] = Push(sweep, deviations, clears[row], rams[row])
        return pushes

    def _deviations(self, sweeps: _Sweeps, shifted: NDArray[np.bool_] | None, row: int) -> Iterator[Deviation]:
        if shifted is not None and shifted[row]:
            yield Deviation.LANE_SHIFTED
        if sweeps.clamped[0, row]:
            yield Deviation.LANE_CLAMPED
        if sweeps.clamped[1, row]:
            yield Deviation.SWEEP_CLAMPED

    def _clears(self, sweeps: _Sweeps) -> NDArray[np.bool_]:
        """Whether every member, pushed to one radius ahead of the leading side, is outside and has room there."""
        radius, way, corridor = self._component.radius, self._direction, self._corridor
        pushed = sweeps.ends[1] + way * (sweeps.sides + radius)
        outside = (pushed - corridor.axis) * way > corridor.half_width
        across = self._members_y[:, None] + self._cos * pushed
        room = (across >= radius - ROUNDING) & (across <= self._shelf.width - radius + ROUNDING)
        return np.asarray((outside & room).all(axis=0))

    def _rams(self, sweeps: _Sweeps) -> NDArray[np.bool_]:
        """Whether the straight way in leads through the middle of a member, which then goes deeper, not aside."""
        local = (self._component.centers - sweeps.tips[0, :, None]) @ self._arm.turns
        distances = distances_on_way_in(local, *self._boxes, sweeps.lengths[0])
        return np.asarray((distances < HEAD_ON * self._component.radius).any(axis=(1, 2)))

    def clearance(self, push: Push) -> float:
        """Least distance of the arm from walls and from the target all the way (m).

        Of a wall nearest is what is inside the shelf, or before its front, where the arm turns from one way into the next, or
        the corner at the mouth.

        Args:
            push: In one of the ways.
        """
        corridor, shelf, points = self._corridor, self._shelf, push.sweep.waypoints
        place = [(way.direction, way.tilt) for way in self._ways].index((push.sweep.direction, push.sweep.tilt))
        tips = self._in_shelf_frame(points[1:3])
        x, y = (self._in_shelf.parts[place].reshape(-1, 2) + tips[:, None]).reshape(-1, 2).T
        inside, before = y[x >= 0.0], x[(x < 0.0) & ((y < 0.0) | (y > shelf.width))]
        walls = (
            inside.min(initial=np.inf),
            shelf.width - inside.max(initial=-np.inf),
            shelf.depth - x.max(),
            -before.max(initial=-np.inf),
        )
        fixed = np.array(
            [[corridor.end, corridor.axis], *corridor.to_local(np.array([[0.0, 0.0], [0.0, shelf.width]]))]
        )
        parts = self._arm.parts[place] + points[:3, None, None]
        target, *mouth = swept_distances(parts, np.diff(points, axis=0), fixed).min(axis=1).tolist()
        return float(min(*walls, target - self._target_radius, *mouth))


def _points(depth: FloatArray, y: FloatArray) -> FloatArray:
    """Points ``(..., b, 2)`` of the corridor frame at depths ``(b,)`` and y ``(..., b)`` (m)."""
    points = np.empty((*y.shape, 2))
    points[..., 0], points[..., 1] = depth, y
    return points
