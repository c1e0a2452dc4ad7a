"""What a pymunk world holds, read as a State, and what no longer belongs in it."""

from __future__ import annotations

import math

import numpy as np

from phframe.backends.pymunk_.world import Item, ShelfSpace
from phframe.core import ArmState, Condition, FloatArray, SimulationDivergedError, State, planar_pose

TOP_SPEED = 20.0
"""Anything faster (m/s) is not physics any more."""


def read_state(world: ShelfSpace) -> State:
    """The world as it is now."""
    poses = np.array([_pose(world, row) for row in range(len(world.scene.objects))])
    conditions = tuple(_condition(world, name) for name in world.scene.ids)
    return State(poses, conditions, world.held, None if world.parked else _arm_state(world))


def _condition(world: ShelfSpace, name: str) -> Condition:
    """Nothing topples here; but what had toppled when the state was restored does not stand up again."""
    if name in world.spilled:
        return Condition.SPILLED
    return Condition.TOPPLED if name in world.toppled else Condition.UPRIGHT


def _pose(world: ShelfSpace, row: int) -> FloatArray:
    item = world.scene.objects[row]
    if item.id in world.spilled:
        return world.spilled[item.id]
    body = world.items[item.id].body
    return planar_pose(*body.position, item.shape.height / 2.0, body.angle)


def _arm_state(world: ShelfSpace) -> ArmState:
    body = world.arm.body
    return ArmState(np.array([*body.position, body.angle]), world.opening, world.command)


def spill(world: ShelfSpace) -> None:
    """Take what has left the board at the mouth out of the world."""
    gone = [item for item in world.items.values() if item.body.position.x < 0.0 and item.name != world.held]
    for item in gone:
        world.spilled[item.name] = _pose(world, world.scene.index(item.name))
        del world.items[item.name]
        world.space.remove(item.shape, *item.floor, item.body)


def refuse_divergence(world: ShelfSpace) -> None:
    """Raise where a body is nowhere or faster than physics allows.

    Raises:
        SimulationDivergedError: With the object and its speed.
    """
    for item in world.items.values():
        if not _speed(item) < TOP_SPEED:
            raise SimulationDivergedError(
                f"the simulation diverged: {item.name!r} moves at {_speed(item):.3g} m/s; try a smaller backend step"
            )


def is_calm(world: ShelfSpace, speed: float) -> bool:
    """Whether every object on the board is slower than ``speed`` (m/s), rim included."""
    return all(_speed(item) < speed for item in world.items.values())


def _speed(item: Item) -> float:
    return math.hypot(*item.body.velocity) + abs(item.body.angular_velocity) * item.radius
