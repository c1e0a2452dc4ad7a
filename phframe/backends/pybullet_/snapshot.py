"""A PyBullet world caught in motion, for planners that steer at control level."""

from __future__ import annotations

from dataclasses import dataclass

from phframe.backends.pybullet_.world import World
from phframe.core import Floats, State, Value


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot(Value):
    """A state and how fast everything in it moves.

    Attributes:
        state: Poses, conditions, what is held, the arm.
        velocities: ``(n, 6)`` of the objects (m/s, rad/s); 0 for what has spilled.
        joint_speeds: Of the arm's joints and the two fingers ``(dof + 2,)`` (rad/s or m/s).
    """

    state: State
    velocities: Floats
    joint_speeds: Floats

    def __post_init__(self) -> None:
        self._freeze("velocities", "joint_speeds")


def take_snapshot(world: World) -> Snapshot:
    """The world as it is now."""
    return Snapshot(world.read_state(), world.velocities, world.joint_speeds)


def put_back(world: World, snapshot: Snapshot) -> None:
    """Make the world be what it was when the snapshot was taken, but for what Bullet remembers of its contacts."""
    world.restore(snapshot.state)
    world.set_in_motion(snapshot.velocities, snapshot.joint_speeds)
