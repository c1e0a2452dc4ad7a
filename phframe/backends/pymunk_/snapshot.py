"""A pymunk world caught in motion, for planners that steer at control level."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from phframe.backends.pymunk_.state import read_state
from phframe.backends.pymunk_.world import ShelfSpace
from phframe.core import FloatArray, Floats, GripperTrajectory, Phase, State, Value


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot(Value):
    """A state and how fast its objects move. The arm has no speed of its own: it goes where it is driven.

    Attributes:
        state: Poses, conditions, what is held, the arm.
        velocities: ``(n, 3)`` of the objects, x, y (m/s) and spin (rad/s); 0 for what has spilled.
    """

    state: State
    velocities: Floats

    def __post_init__(self) -> None:
        self._freeze("velocities")


def take_snapshot(world: ShelfSpace) -> Snapshot:
    """The world as it is now."""
    still = (0.0, 0.0, 0.0)
    bodies = [world.items[name].body if name in world.items else None for name in world.scene.ids]
    rows = [still if body is None else (*body.velocity, body.angular_velocity) for body in bodies]
    return Snapshot(read_state(world), np.array(rows))


def set_in_motion(world: ShelfSpace, velocities: FloatArray) -> None:
    """Give the objects of a world that has just been built their speeds ``(n, 3)``."""
    for name, (x, y, spin) in zip(world.scene.ids, velocities.tolist(), strict=True):
        if name in world.items:
            world.items[name].body.velocity = x, y
            world.items[name].body.angular_velocity = spin
    world.at_rest = not velocities.any()


def held_twist(
    pose: FloatArray, twist: FloatArray, dt: float, openings: FloatArray, force_limit: float
) -> GripperTrajectory:
    """The trajectory of a fingertip that keeps a twist ``(3,)`` for ``dt`` seconds, from a pose ``(3,)``."""
    return GripperTrajectory(
        np.array([0.0, dt]), np.array([pose, pose + twist * dt]), openings, (Phase.SWEEP,), force_limit
    )
