"""The gripper of the pymunk world: fingers that move, and what they hold."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from phframe.backends.pymunk_.chipmunk import Point, set_corners, set_group
from phframe.backends.pymunk_.world import ARM_GROUP, OTHERS, MovingFinger, ShelfItem, ShelfSpace, lay_floor

TOUCH = 5e-4
"""A finger this near (m) to an object touches it."""


def place_arm(world: ShelfSpace, pose: Sequence[float]) -> None:
    """Put the arm at a fingertip pose (x, y, yaw), at rest; only where that is collision-free."""
    x, y, yaw = pose
    for body in (world.arm.body, world.arm.carrier):
        body.position, body.angle = (x, y), yaw
        body.velocity = 0.0, 0.0
        body.angular_velocity = 0.0
    world.parked = False


def place_held(world: ShelfSpace, position: Point) -> None:
    """Put what is held at a position, at rest, with the turn it has."""
    held = world.items[world.held or ""].body
    held.position = position
    held.velocity, held.angular_velocity = (0.0, 0.0), 0.0


def set_opening(world: ShelfSpace, opening: float) -> None:
    """Put the fingers ``opening`` (m) apart."""
    if opening == world.opening:
        return
    shift = (opening - world.measures.min_opening) / 2.0
    for finger in world.arm.fingers:
        set_corners(finger.polygon, [(x, y + finger.side * shift) for x, y in finger.corners])
    world.opening = world.command = opening


def between_fingers(world: ShelfSpace) -> list[ShelfItem]:
    """The objects whose centres lie between the open fingers, and that these do not pass over."""
    return [
        item
        for item in world.items.values()
        if all(gap >= 0.0 for gap in _gaps(world, item)) and all(item.meets & f.category for f in world.arm.fingers)
    ]


def gripped(world: ShelfSpace, items: Sequence[ShelfItem]) -> ShelfItem | None:
    """Which of some objects both fingers touch, if any does."""
    for item in items:
        gaps = zip(_gaps(world, item), world.arm.fingers, strict=True)
        if world.arm.fingers and all(_touches(world, item, finger, gap) for gap, finger in gaps):
            return item
    return None


def _touches(world: ShelfSpace, item: ShelfItem, finger: MovingFinger, gap: float) -> bool:
    """Whether an object reaches over a gap (m) from its centre to a finger."""
    return gap <= item.radius + TOUCH and gap <= _reach(world, item, finger) + TOUCH


def _reach(world: ShelfSpace, item: ShelfItem, finger: MovingFinger) -> float:
    """How far an object reaches from its centre towards a finger (m)."""
    across = world.arm.body.angle + finger.side * math.pi / 2.0 - item.body.angle
    return item.thing.shape.support(np.array([math.cos(across), math.sin(across)]))


def _gaps(world: ShelfSpace, item: ShelfItem) -> list[float]:
    """Distance from each finger's inner face to an object's centre (m); negative where it is not beside the finger."""
    x, y = world.arm.body.to_local(item.body.position)
    half = world.opening / 2.0
    return [half - f.side * y if f.back <= x <= f.front else -1.0 for f in world.arm.fingers]


def hold(world: ShelfSpace, item: ShelfItem, command: float) -> None:
    """Join an object to the gripper: it goes where the gripper goes, and drags along the board.

    Args:
        world: Where.
        item: What.
        command: The opening that the fingers go on being told to have (m), and squeeze for.
    """
    lay_floor(world, item)
    set_group(item.shape, ARM_GROUP, categories=OTHERS, mask=item.meets)
    arm, body, at = world.arm.body, item.body, item.body.position
    pivot = world.space.pivot(arm, body, arm.to_local(at), body.to_local(at))
    world.grip = pivot, world.space.gear(arm, body, body.angle - arm.angle)
    world.held, world.command = item.name, command
    stand(world, item)


def release(world: ShelfSpace) -> None:
    """Let go of what is held: it stands on the board, free, where it is."""
    item = world.items[world.held or ""]
    world.space.remove_joints(world.grip)
    set_group(item.shape, 0, categories=OTHERS, mask=item.meets)
    world.grip, world.held = (), None


def stand(world: ShelfSpace, item: ShelfItem) -> None:
    """Let the board resist what is held, with its friction, up to the mouth, where the board ends."""
    on_board = item.body.position[0] >= 0.0
    if on_board is not item.on_board:
        (world.space.put_back if on_board else world.space.remove_joints)(item.floor)
        item.on_board = on_board


def drag(world: ShelfSpace) -> float:
    """What it takes to move what is held along the board (N): Coulomb's mu m g."""
    item = world.items.get(world.held or "")
    return item.friction if item is not None and item.on_board else 0.0
