"""The gripper of the pymunk world: fingers that move, and what they hold."""

from __future__ import annotations

import pymunk

from phframe.backends.pymunk_world import Item, World
from phframe.core import FloatArray

TOUCH = 5e-4
"""A finger this near (m) to an object touches it."""


def place_arm(world: World, pose: FloatArray) -> None:
    """Put the arm at a fingertip pose ``(3,)``, at rest; no force acts, so only where nothing is in the way."""
    for body in (world.arm.body, world.arm.carrier):
        body.position = float(pose[0]), float(pose[1])
        body.angle = float(pose[2])
        body.velocity = 0.0, 0.0
        body.angular_velocity = 0.0
    world.parked = False


def set_opening(world: World, opening: float) -> None:
    """Put the fingers ``opening`` (m) apart."""
    if opening == world.opening:
        return
    for polygon, outline in world.arm.fingers:
        polygon.unsafe_set_vertices(
            [(float(x), float(y)) for x, y in outline.opened(opening - world.min_opening).vertices]
        )
    world.opening = world.command = opening


def between_fingers(world: World) -> Item | None:
    """The object that both fingers touch, if there is one."""
    for item in world.items.values():
        if _touched_by_all(world, item):
            return item
    return None


def _touched_by_all(world: World, item: Item) -> bool:
    center = world.arm.body.world_to_local(item.body.position)
    fingers = [outline for _, outline in world.arm.fingers]
    return bool(fingers) and all(
        outline.vertices[:, 0].min() <= center.x <= outline.vertices[:, 0].max()
        and -TOUCH <= world.opening / 2.0 - outline.side * center.y <= item.radius + TOUCH
        for outline in fingers
    )


def hold(world: World, item: Item) -> None:
    """Join an object to the gripper: it leaves the board and goes where the gripper goes."""
    world.space.remove(*item.floor)
    item.shape.filter = pymunk.ShapeFilter(group=1)
    grip = (
        pymunk.PivotJoint(world.arm.body, item.body, (item.body.position.x, item.body.position.y)),
        pymunk.GearJoint(world.arm.body, item.body, item.body.angle - world.arm.body.angle, 1.0),
    )
    world.space.add(*grip)
    world.grip, world.held = grip, item.name
