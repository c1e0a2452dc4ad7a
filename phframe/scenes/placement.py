"""Where random objects stand: a target deep in the shelf, obstacles before or around it, some of them in its way.

Everything is in whole tenths of a millimetre, with no function whose last digit depends on the machine's mathematics
library, so the same seed gives the same places everywhere.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from phframe.scenes.draws import Draws

Point = tuple[int, int]

TRIES_PER_OBJECT = 500
TRIES = 20_000
"""Candidate places looked at before a scene is given up: about a tenth of a second."""


@dataclass(frozen=True, slots=True)
class Layout:
    """What a random scene must keep to; lengths in tenths of a millimetre.

    Attributes:
        count: Obstacles.
        blocking: At least so many of them in the target's corridor.
        depth: Of the shelf.
        width: Of the shelf.
        radius: Of every object.
        gap: Least free space between objects, and to the walls.
        target_gap: Least free space around the target.
        corridor: Half-width of the corridor.
        wall_gap: Least free space between the target and the side walls, if more than ``gap``.
        bands: Least and greatest distance of the target's centre from a side wall; one of them, and one of the walls, is
            drawn. None: it may stand anywhere between the walls.
        anywhere: Whether obstacles may stand beside and behind the target, too; else all are nearer to the mouth.
    """

    count: int
    blocking: int
    depth: int
    width: int
    radius: int
    gap: int
    target_gap: int
    corridor: int
    wall_gap: int = 0
    bands: tuple[tuple[int, int], ...] | None = None
    anywhere: bool = False

    @property
    def target_depths(self) -> tuple[int, int]:
        """Least and greatest x of the target: between two thirds and nine tenths of the shelf's depth."""
        return 2 * self.depth // 3, min(9 * self.depth // 10, self.depth - self.radius - self.gap)

    @property
    def target_margin(self) -> int:
        """Least distance of the target's centre from the side walls."""
        return self.radius + max(self.gap, self.wall_gap)


def place_objects(layout: Layout, draws: Draws) -> list[Point] | int:
    """The places of the obstacles, then of the target; or how many obstacles found a place at most, if not all."""
    tries, most = TRIES, 0
    while tries > 0:
        places, used = _attempt(layout, draws)
        if len(places) == layout.count + 1:
            return [*places[1:], places[0]]
        tries, most = tries - used, max(most, len(places) - 1)
    return max(most, 0)


def _attempt(layout: Layout, draws: Draws) -> tuple[list[Point], int]:
    """One try at a whole scene, the target first: the places found and the number of candidates looked at."""
    target = _target(layout, draws)
    if target is None or target[0] ** 2 + target[1] ** 2 <= layout.corridor**2:  # no corridor leads there
        return [], 1
    places, used = [target], 1
    for index in range(layout.count):
        place, tries = _obstacle(layout, draws, places, blocking=index < layout.blocking)
        used += tries
        if place is None:
            break
        places.append(place)
    return places, used


def _target(layout: Layout, draws: Draws) -> Point | None:
    (low, high), margin = layout.target_depths, layout.target_margin
    if low > high or margin > layout.width - margin or layout.bands == ():
        return None
    x = draws.between(low, high)
    if layout.bands is None:
        return x, draws.between(margin, layout.width - margin)
    y = draws.between(*layout.bands[draws.between(0, len(layout.bands) - 1)])
    return x, layout.width - y if draws.between(0, 1) else y


def _obstacle(layout: Layout, draws: Draws, places: list[Point], *, blocking: bool) -> tuple[Point | None, int]:
    target, nearest = places[0], layout.radius + layout.gap
    deepest = layout.depth - nearest if layout.anywhere else target[0] - 1
    for tries in range(1, TRIES_PER_OBJECT + 1):
        place = _candidate(layout, draws, nearest, deepest)
        if place is None:
            break
        if _is_free(layout, place, places) and not (blocking and not in_corridor(layout, place, target)):
            return place, tries
    return None, TRIES_PER_OBJECT


def _candidate(layout: Layout, draws: Draws, low: int, high: int) -> Point | None:
    south, north = layout.radius + layout.gap, layout.width - layout.radius - layout.gap
    if low > high or south > north:
        return None
    return draws.between(low, high), draws.between(south, north)


def _is_free(layout: Layout, place: Point, places: list[Point]) -> bool:
    x, y = place
    target, *others = places
    apart, apart_from_target = 2 * layout.radius + layout.gap, 2 * layout.radius + layout.target_gap
    if (x - target[0]) ** 2 + (y - target[1]) ** 2 < apart_from_target**2:
        return False
    return all((x - a) ** 2 + (y - b) ** 2 >= apart**2 for a, b in others)


def in_corridor(layout: Layout, place: Point, target: Point) -> bool:
    """Whether a place lies in the target's corridor (path region, Algorithm 1), straight or at an angle."""
    if target[1] > layout.width - layout.corridor:
        return _in_angled_corridor(layout.corridor, place, target)
    if target[1] < layout.corridor:
        x, y = place
        return _in_angled_corridor(layout.corridor, (x, layout.width - y), (target[0], layout.width - target[1]))
    return abs(place[1] - target[1]) <= layout.corridor and place[0] < target[0]


def _in_angled_corridor(half_width: int, place: Point, target: Point) -> bool:
    """The strip beside the line through the mouth corner that passes below the target at the half-width's distance.

    The line's direction is built from square roots alone: its angle is atan2(y, x) - asin(w / |t|).
    """
    (x, y), (a, b), w = target, place, half_width
    along = math.sqrt(x * x + y * y - w * w)
    direction_x, direction_y = along * x + w * y, along * y - w * x
    ahead, beside = a * direction_x + b * direction_y, b * direction_x - a * direction_y
    end, twice_width = x * direction_x + y * direction_y, 2.0 * w * (x * x + y * y)
    return 0.0 <= ahead < end and 0.0 <= beside <= twice_width
