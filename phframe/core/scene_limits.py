"""The figures that scenes may have, and why: beyond them engines give errors of their own, or nonsense."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

MOST_OBJECTS = 1000
"""In one scene: every two of them are compared, by scenes, planners and engines."""
MOST_PROBLEMS = 10
"""Told of one scene."""
FARTHEST = 100.0
"""Of an arm's base from the shelf, along each axis (m)."""
MOST_TURNED = 100.0
"""Of a heading (rad); what is beyond is meant in degrees, or has lost its digits."""


@dataclass(frozen=True, slots=True)
class Range:
    """What a figure above 0 may be.

    Attributes:
        least: The least value.
        most: The greatest value.
        unit: Of both.
        too_small: Why it may be no less.
        too_great: Why it may be no more.
    """

    least: float
    most: float
    unit: str
    too_small: str
    too_great: str

    def faults(self, name: str, figure: float) -> Iterator[str]:
        """What is wrong with a positive figure, in a sentence."""
        if figure < self.least:
            yield f"{name} is {figure:g}{self.unit}; the least is {self.least:g}{self.unit}: {self.too_small}"
        elif figure > self.most:
            yield f"{name} is {figure:g}{self.unit}; the most is {self.most:g}{self.unit}: {self.too_great}"


LENGTH = Range(
    1e-3, 10.0, " m", "bodies in contact are some tenths of a millimetre inside one another", "arms reach a few metres"
)
"""Of shelves and objects."""
MASS = Range(1e-3, 1e3, " kg", "engines divide by it, and lose what is lighter", "no arm moves it")
"""Of objects."""
FRICTION = Range(0.0, 10.0, "", "", "no two materials have it, and engines do not get a solution")
"""Coulomb coefficients."""


def positive(name: str, figure: float, limits: Range) -> Iterator[str]:
    """What is wrong with a figure that must be above 0 and within a range."""
    if not (math.isfinite(figure) and figure > 0.0):
        yield f"{name} is {figure:g}; it must be a finite number above 0"
    else:
        yield from limits.faults(name, figure)


def not_negative(name: str, figure: float, limits: Range) -> Iterator[str]:
    """What is wrong with a figure that must be 0 or more and within a range."""
    if not (math.isfinite(figure) and figure >= 0.0):
        yield f"{name} is {figure:g}; it must be a finite number of 0 or more"
    else:
        yield from limits.faults(name, figure)


def at_most(name: str, figure: float, most: float, what: str) -> Iterator[str]:
    """What is wrong with a figure that must be finite and no farther from 0 than ``most``; ``what`` says of what kind it is."""
    if not math.isfinite(figure):
        yield f"{name} is {figure}, not a finite number"
    elif abs(figure) > most:
        yield f"{name} is {figure:g}; {what} are from {-most:g} to {most:g}"
