"""How a robot that measures with errors sees the world.

Errors are Gaussian in x and in y, and new each time it looks. What is seen must be a state that can be: one object after
another, an error with which it would be in a wall, before the mouth, in the arm or in another object is drawn anew, up to
some times; where none fits, the object is seen where it is. So errors are smaller where objects stand close. Heights, turns,
what is held and what has left the board are seen as they are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from phframe.core import ArmShape, FloatArray, Scene, State, rotated_in_plane, rotation_matrix
from phframe.geometry.polygon import signed_distance
from phframe.runtime.noise import POSITIONS, Noise

ATTEMPTS = 50
"""How often an error may be drawn anew."""


class Sensor:
    """Sees states of one scene.

    Args:
        noise: Of what size its errors are; without errors it sees every state as it is.
        scene: The scene.
        shape: Of the arm in it.
        seed: Of the episode.
    """

    def __init__(self, noise: Noise, scene: Scene, shape: ArmShape, seed: int) -> None:
        self._deviation, self._scene, self._shape = noise.position, scene, shape
        self._rng = noise.stream(seed, POSITIONS)

    def see(self, state: State) -> State:
        """The state as it is seen this time."""
        if not self._deviation:
            return state
        poses = state.poses.copy()
        place = _Place(self._scene, state, self._arm(state))
        for row in np.flatnonzero(state.on_board).tolist():
            if self._scene.ids[row] != state.held:
                poses[row, :2] = self._seen(place, row, poses[:, :2])
        return replace(state, poses=poses)

    def _seen(self, place: _Place, row: int, positions: FloatArray) -> FloatArray:
        """Where an object is seen, beside all others as they are seen or, those that come later, as they are."""
        errors = self._deviation * self._rng.standard_normal((ATTEMPTS, 2))
        gaps = place.gaps(row, positions[row], positions)
        for position in positions[row] + errors:
            if (place.gaps(row, position, positions) >= np.minimum(gaps, 0.0)).all():
                return np.asarray(position)
        return np.asarray(positions[row])

    def _arm(self, state: State) -> list[FloatArray]:
        """The arm's outlines in the shelf frame; none where it is parked."""
        if state.arm is None:
            return []
        opening = float(np.clip(state.arm.opening, self._shape.min_opening, self._shape.max_opening))
        at, turn = state.arm.gripper[:2], rotation_matrix(float(state.arm.gripper[2])).T
        return [rotated_in_plane(outline.vertices, turn) + at for outline in self._shape.outlines(opening)]


class _Place:
    """What is around the objects of a state."""

    def __init__(self, scene: Scene, state: State, arm: list[FloatArray]) -> None:
        self._shelf, self._radii, self._arm = scene.shelf, scene.radii, arm
        self._there = state.on_board

    def gaps(self, row: int, position: FloatArray, positions: FloatArray) -> FloatArray:
        """How far an object at a position would be from all else, negative where it would be in it (m)."""
        (x, y), radius, shelf = position, self._radii[row], self._shelf
        walls = [x, shelf.depth - radius - x, y - radius, shelf.width - radius - y]
        others = np.hypot(*(positions - position).T) - self._radii - radius
        others[~self._there] = others[row] = np.inf
        return np.array([*walls, *others, *(gap - radius for gap in self._gaps_to_arm(position))])

    def _gaps_to_arm(self, position: FloatArray) -> Iterator[float]:
        for polygon in self._arm:
            yield signed_distance(polygon, position)
