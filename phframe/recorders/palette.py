"""The colours of a recording, made for a dark background. Amber is the target's alone; red means: it fell."""

from __future__ import annotations

from phframe.core import Condition

Color = tuple[int, int, int, int]

BACKGROUND: Color = (16, 20, 26, 255)
BOARD: Color = (37, 44, 54, 255)
WALL: Color = (116, 140, 168, 34)
EDGE: Color = (108, 124, 143, 255)
CAPTION: Color = (150, 163, 180, 255)
FAINT: Color = (52, 61, 73, 255)

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
PATH: Color = (140, 152, 168, 255)
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


def component_color(label: int) -> Color:
    """The colour of a component; they repeat after eight."""
    return COMPONENTS[label % len(COMPONENTS)]


def fallen_color(condition: Condition) -> Color | None:
    """The colour of an object that no longer stands; None: it does."""
    return {Condition.TOPPLED: TOPPLED, Condition.SPILLED: SPILLED}.get(condition)
