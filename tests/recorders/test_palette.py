"""Everything written can be read in both themes of Rerun's viewer."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from phframe.recorders import palette

LEAST = 3.0
"""Contrast that large text and drawn lines need (WCAG 2.1, 1.4.3 and 1.4.11)."""
VIEWER = {"light": (255, 255, 255), "dark": (13, 16, 17)}
"""The ground that the viewer writes on, by theme."""
FIELD = {"light": 112.0, "dark": 8.0}
"""What the half transparent field behind a label adds to half of what lies below it, as measured in its pictures."""
UNDER_LABELS = (
    palette.BACKGROUND,
    palette.BOARD,
    palette.CORRIDOR,
    *map(palette.shaded, (*palette.COMPONENTS, palette.OBJECT, palette.TARGET, palette.TOPPLED, palette.SPILLED)),
)


def contrast(one: tuple[float, ...], other: tuple[float, ...]) -> float:
    low, high = sorted(_luminance(color) + 0.05 for color in (one, other))
    return high / low


def _luminance(color: tuple[float, ...]) -> float:
    """Relative luminance (WCAG 2.1) of a colour in sRGB."""
    channels = np.array(color[:3]) / 255.0
    linear = np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)
    return float(linear @ [0.2126, 0.7152, 0.0722])


@pytest.mark.parametrize(("theme", "below"), list(itertools.product(FIELD, UNDER_LABELS)))
def test_labels_can_be_read_on_what_they_lie_on(theme: str, below: palette.Color) -> None:
    field = tuple(0.49 * channel + FIELD[theme] for channel in below[:3])
    assert contrast(palette.TEXT, field) >= LEAST


@pytest.mark.parametrize(("theme", "ink"), list(itertools.product(VIEWER, palette.INKS)))
def test_log_curves_and_graph_can_be_read_in_both_themes(theme: str, ink: palette.Color) -> None:
    assert contrast(ink, VIEWER[theme]) >= LEAST


def test_inks_can_be_told_apart() -> None:
    for one, other in itertools.combinations(palette.INKS, 2):
        assert np.abs(np.subtract(one[:3], other[:3])).sum() > 90


def test_the_darkest_robot_stands_out_from_the_backdrop() -> None:
    assert contrast((18, 18, 18), palette.BACKDROP) >= LEAST
    assert contrast(palette.BOARD, palette.BACKDROP) >= LEAST - 0.5
