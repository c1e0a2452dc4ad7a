"""Random components in random corridors, with the sweeps that are proposed for them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from hypothesis import assume
from hypothesis import strategies as st

from phframe.core import FloatArray, Outline, Shelf
from phframe.geometry.arm_view import ArmView
from phframe.pushing import Corridor, PushingOptions, find_corridor
from phframe.pushing.grouping import bounding_rectangle
from phframe.pushing.sweep_generator import SweepGenerator
from phframe.pushing.tilted_sweep import Component, Direction, Push, TiltedSweeps, Way
from tests.pushing.parts import ARM, HALF_WIDTH, RADIUS


def millimetres(least: float, most: float) -> st.SearchStrategy[float]:
    return st.integers(round(least * 1000), round(most * 1000)).map(lambda number: number / 1000.0)


@dataclass(frozen=True)
class Case:
    """One component in the corridor to one target."""

    shelf: Shelf
    target: tuple[float, float]
    members: FloatArray  # in the shelf frame

    @property
    def corridor(self) -> Corridor:
        corridor = find_corridor(np.array(self.target), self.shelf, HALF_WIDTH)
        assert isinstance(corridor, Corridor)
        return corridor

    @property
    def local(self) -> FloatArray:
        return self.corridor.to_local(self.members)

    @property
    def view(self) -> ArmView:
        return ArmView(self.shelf, ARM.closed, PushingOptions().wall_clearance)

    @property
    def geometry(self) -> SweepGenerator:
        return self.generator(PushingOptions())

    def generator(self, options: PushingOptions) -> SweepGenerator:
        """Of its sweeps, with options."""
        return SweepGenerator(self.corridor, self.local, RADIUS, RADIUS, self.view, options)

    def fitted(self, direction: Direction, tilt: float, outlines: tuple[Outline, ...] = ARM.closed) -> Push | None:
        """The sweep in one direction at one tilt, if it fits."""
        view = ArmView(self.shelf, outlines, PushingOptions().wall_clearance)
        component = Component(self.local, bounding_rectangle(self.local), RADIUS)
        options = PushingOptions()
        (push,) = TiltedSweeps(self.corridor, component, view, RADIUS, [Way(direction, tilt)], options).fitted()
        return push

    @property
    def pushes(self) -> list[Push]:
        return list(self.geometry.pushes())

    @property
    def mirrored(self) -> Case:
        width = self.shelf.width
        return Case(
            self.shelf, (self.target[0], width - self.target[1]), self.members * [1.0, -1.0] + np.array([0.0, width])
        )


@st.composite
def cases(draw: st.DrawFn, *, straight: bool = False, inside: bool = True) -> Case:
    """Components within the corridor, or anywhere, beside and behind the target too."""
    shelf = Shelf(depth=draw(millimetres(0.4, 0.7)), width=draw(millimetres(0.4, 0.8)))
    least = HALF_WIDTH if straight else RADIUS
    target = draw(millimetres(0.2, shelf.depth - RADIUS)), draw(millimetres(least, shelf.width - least))
    count = draw(st.integers(1, 3))
    spots = st.tuples(millimetres(0.0, shelf.depth - RADIUS), millimetres(RADIUS, shelf.width - RADIUS))
    members = np.array([draw(spots) for _ in range(count)])
    case = Case(shelf, target, members)
    if inside:
        local = case.local * [1.0, 0.0] + (np.abs(case.local[:, 1:] - case.corridor.axis) % HALF_WIDTH) * [0.0, 1.0]
        signs = np.where(case.local[:, 1] >= case.corridor.axis, 1.0, -1.0)
        local = np.column_stack([local[:, 0] % case.corridor.end, case.corridor.axis + signs * local[:, 1]])
        members = case.corridor.to_shelf(local)
        assume(_stand(members, shelf))
        case = Case(shelf, target, members)
    return case


def _stand(members: FloatArray, shelf: Shelf) -> bool:
    lower, upper = np.array([0.0, RADIUS]), np.array([shelf.depth - RADIUS, shelf.width - RADIUS])
    return bool(((members >= lower) & (members <= upper)).all())
