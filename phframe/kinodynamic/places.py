"""Where a pushed object may be put: drawn places that touch nothing."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from phframe.core import FloatArray, Scene, State

NEAR, LEAST, NEAR_TRIES, TRIES = 0.3, 0.2, 200, 400
"""Places are drawn within NEAR of the object (m), after so many tries anywhere, at least LEAST away; and given up."""
GAP = 0.005
"""Kept between an object at its place and everything else (m)."""


def drawn_place(
    scene: Scene, state: State, row: int, forbidden: Callable[[FloatArray], bool], rng: np.random.Generator
) -> FloatArray | None:
    """A place ``(2,)`` for an object, 0.2 to 0.3 m away if there is one, that touches nothing; None: none was drawn.

    Source: Papallas and Dogar (2020), as GRTC draws the goal of a blocker.

    Args:
        scene: Shelf and objects.
        state: The world at rest.
        row: Of the object.
        forbidden: Whether a place ``(2,)`` will not do.
        rng: The only source of randomness.
    """
    start = state.positions[row]
    for attempt in range(TRIES):
        place = _drawn(scene, start, float(scene.radii[row]), rng, anywhere=attempt >= NEAR_TRIES)
        far_enough = math.hypot(*(place - start)) >= LEAST
        if far_enough and is_free(scene, state, row, place) and not forbidden(place):
            return place
    return None


def is_free(scene: Scene, state: State, row: int, place: FloatArray) -> bool:
    """Whether an object at a place ``(2,)`` stands on the board and touches nothing."""
    radius, shelf = float(scene.radii[row]), scene.shelf
    margin = radius + GAP
    if not (margin <= place[0] <= shelf.depth - margin and margin <= place[1] <= shelf.width - margin):
        return False
    apart = np.linalg.norm(state.positions - place, axis=1) - scene.radii - margin
    apart[row] = np.inf
    return bool((apart[state.on_board] >= 0.0).all())


def _drawn(scene: Scene, start: FloatArray, radius: float, rng: np.random.Generator, *, anywhere: bool) -> FloatArray:
    """Evenly within the disc around the object, or anywhere on the board."""
    if anywhere:
        return np.asarray(rng.uniform([radius, radius], [scene.shelf.depth - radius, scene.shelf.width - radius]))
    angle, distance = rng.uniform(-math.pi, math.pi), NEAR * math.sqrt(rng.random())
    return np.asarray(start + distance * np.array([math.cos(angle), math.sin(angle)]))
