"""How each planner is drawn: one colour throughout a report, safe for the colour-blind, on light and on dark."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from phframe.core.variant import split_variant

LIGHT = ("#0072b2", "#d55e00", "#009e73", "#b5579d", "#c28800", "#3a9bd6", "#882255", "#5a5f66")
"""After Okabe and Ito (2008), yellow and black replaced, the light ones darker."""
DARK = ("#4ea8e0", "#f08040", "#2fc79c", "#e094c6", "#e9b23a", "#94d2fa", "#cf6d9c", "#a9afb8")
"""The same hues for a dark page."""
DASHES = ("solid", (0, (5, 1.6)), (0, (1.2, 1.2)), (0, (5, 1.4, 1.2, 1.4)))
MARKERS = ("o", "D", "s", "^")


@dataclass(frozen=True, slots=True)
class PlannerStyle:
    """How a planner is drawn.

    Attributes:
        colour: Index in the palettes.
        variant: 0, or which of the planners of one colour it is: it has its own dashes and markers, and hollow bars.
    """

    colour: int
    variant: int


def styles(planners: Sequence[str]) -> dict[str, PlannerStyle]:
    """A style for each planner, of its own for up to 32.

    Where there are more planners than colours, variants of one planner share its colour, unless those are too many.
    """
    names = sorted(planners)
    if len(names) > len(LIGHT):
        families = [split_variant(name.partition(" (")[0])[0] for name in names]
        order = {family: i for i, family in enumerate(sorted(set(families)))}
        found = {
            name: PlannerStyle(order[f], families[:i].count(f))
            for i, (name, f) in enumerate(zip(names, families, strict=True))
        }
        if len(order) <= len(LIGHT) and all(look.variant < len(DASHES) for look in found.values()):
            return found
    return {name: PlannerStyle(i % len(LIGHT), i // len(LIGHT) % len(DASHES)) for i, name in enumerate(names)}
