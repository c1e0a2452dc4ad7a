"""The colours of recordings and videos. Amber is the target's alone; red means: it fell.

Views of space have a ground of ours, the same in both themes of the viewer; but it writes labels on half transparent
fields of its own, dark or light. White letters can be read on both as long as what lies below is dark. What the viewer
draws on its own ground (log, curves, graph) must be read on a light one as on a dark one, so it is of middle luminance.
"""

from __future__ import annotations

from phframe.core import Condition

Color = tuple[int, int, int, int]

BACKGROUND: Color = (16, 20, 26, 255)
"""Of the views from the top."""
BACKDROP: Color = (104, 115, 129, 255)
"""Of the view in 3D: between the shelf and dark robots."""
BOARD: Color = (37, 44, 54, 255)
WALL: Color = (116, 140, 168, 34)
EDGE: Color = (158, 171, 188, 255)
FAINT: Color = (52, 61, 73, 255)

TEXT: Color = (244, 247, 250, 255)
"""Of labels."""

OBJECT: Color = (126, 138, 153, 255)
TARGET: Color = (255, 181, 46, 255)
TOPPLED: Color = (240, 84, 84, 255)
SPILLED: Color = (150, 58, 62, 255)
CHOSEN: Color = (244, 247, 250, 255)
EXPECTED: Color = (172, 184, 200, 255)

LINK: Color = (78, 91, 108, 255)
FINGER: Color = (178, 190, 205, 255)
CORRIDOR: Color = (35, 60, 84, 255)
CORRIDOR_GLASS: Color = (80, 160, 230, 46)
CORRIDOR_EDGE: Color = (88, 152, 206, 255)
RECTANGLE: Color = (244, 247, 250, 255)
PATH: Color = (172, 184, 200, 255)
SWEEP: Color = (120, 235, 200, 255)
PERSISTENT: Color = (82, 178, 255, 255)

COMPONENTS: tuple[Color, ...] = (
    (82, 178, 255, 255),
    (178, 140, 255, 255),
    (88, 214, 141, 255),
    (255, 128, 196, 255),
    (60, 214, 205, 255),
    (200, 222, 90, 255),
    (118, 140, 255, 255),
    (214, 160, 120, 255),
)

SHADE = 0.3

GREY_INK: Color = (118, 128, 141, 255)
AMBER_INK: Color = (190, 115, 10, 255)
RED_INK: Color = (214, 58, 58, 255)
BLUE_INK: Color = (30, 120, 210, 255)
VIOLET_INK: Color = (136, 98, 210, 255)
GREEN_INK: Color = (14, 138, 104, 255)
PINK_INK: Color = (205, 70, 145, 255)
INKS: tuple[Color, ...] = (GREY_INK, AMBER_INK, RED_INK, BLUE_INK, VIOLET_INK, GREEN_INK, PINK_INK)
"""For the viewer's own ground."""


def shaded(color: Color) -> Color:
    """A dark shade of a colour, for a surface that is written on."""
    red, green, blue, opacity = color
    return round(SHADE * red), round(SHADE * green), round(SHADE * blue), opacity


def component_color(label: int) -> Color:
    """The colour of a component; they repeat after eight."""
    return COMPONENTS[label % len(COMPONENTS)]


def fallen_color(condition: Condition) -> Color | None:
    """The colour of an object that no longer stands; None: it does."""
    return {Condition.TOPPLED: TOPPLED, Condition.SPILLED: SPILLED}.get(condition)
