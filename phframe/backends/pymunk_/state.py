"""A pymunk world read as a State or caught in motion, what has left the board, and what is no longer physics."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from phframe.backends.contract import TOP_SPEED
from phframe.backends.pymunk_.gripper import stand
from phframe.backends.pymunk_.world import ShelfItem, ShelfSpace, lay_floor
from phframe.core import ArmState, Condition, FloatArray, Floats, SceneObject, SimulationDivergedError, State, Value


def read_state(world: ShelfSpace) -> State:
    """The world as it is now."""
    poses = np.array([_pose(world, item) for item in world.scene.objects])
    conditions = tuple(_condition(world, name) for name in world.scene.ids)
    return State(poses, conditions, world.held, None if world.parked else _arm_state(world))


def _condition(world: ShelfSpace, name: str) -> Condition:
    """Nothing topples here; but what had toppled when the state was restored does not stand up again."""
    if name in world.spilled:
        return Condition.SPILLED
    return Condition.TOPPLED if name in world.toppled else Condition.UPRIGHT


def _pose(world: ShelfSpace, item: SceneObject) -> list[float]:
    """A pose, in plain numbers: an array of each object costs more than one of all."""
    if item.id in world.spilled:
        return world.spilled[item.id]
    body = world.items[item.id].body
    (x, y), half = body.position, body.angle / 2.0
    return [x, y, item.shape.height / 2.0, math.cos(half), 0.0, 0.0, math.sin(half)]


def _arm_state(world: ShelfSpace) -> ArmState:
    body = world.arm.body
    return ArmState(np.array([*body.position, body.angle]), world.opening, world.command)


def survey(world: ShelfSpace) -> None:
    """Take what has left the board at the mouth out of the world; what is held stands on the board as far as that goes."""
    if world.held is not None:
        stand(world, world.items[world.held])
    gone = [item for item in world.items.values() if item.body.position[0] < 0.0 and item.name != world.held]
    for item in gone:
        world.spilled[item.name] = _pose(world, item.thing)
        del world.items[item.name]
        world.space.remove_joints(item.floor if item.on_board else ())
        world.space.remove(item.body, item.shape)


def refuse_divergence(world: ShelfSpace) -> None:
    """Raise where a body is nowhere or faster than physics allows.

    Raises:
        SimulationDivergedError: With the object and its speed.
    """
    for item in world.movable:
        if not _speed(item) < TOP_SPEED:
            raise SimulationDivergedError(
                f"the simulation diverged: {item.name!r} moves at {_speed(item):.3g} m/s; try a smaller backend step"
            )


def is_calm(world: ShelfSpace, speed: float) -> bool:
    """Whether every object on the board is slower than ``speed`` (m/s), rim included."""
    return all(_speed(item) < speed for item in world.movable)


def _speed(item: ShelfItem) -> float:
    return math.hypot(*item.body.velocity) + abs(item.body.angular_velocity) * item.radius


@dataclass(frozen=True, slots=True, eq=False)
class PymunkSnapshot(Value):
    """A state and how fast its objects move. The arm has no speed of its own: it goes where it is driven.

    Attributes:
        state: Poses, conditions, what is held, the arm.
        velocities: ``(n, 3)`` of the objects, x, y (m/s) and spin (rad/s); 0 for what has spilled.
    """

    state: State
    velocities: Floats

    def __post_init__(self) -> None:
        self._freeze("velocities")


def take_snapshot(world: ShelfSpace) -> PymunkSnapshot:
    """The world as it is now."""
    still = (0.0, 0.0, 0.0)
    bodies = [world.items[name].body if name in world.items else None for name in world.scene.ids]
    rows = [still if body is None else (*body.velocity, body.angular_velocity) for body in bodies]
    return PymunkSnapshot(read_state(world), np.array(rows))


def set_in_motion(world: ShelfSpace, velocities: FloatArray) -> None:
    """Give the objects of a world that has just been built their speeds ``(n, 3)``."""
    for name, (x, y, spin) in zip(world.scene.ids, velocities.tolist(), strict=True):
        if name in world.items and (x or y or spin):
            lay_floor(world, world.items[name])
            world.items[name].body.velocity = x, y
            world.items[name].body.angular_velocity = spin
    world.at_rest = not velocities.any()
