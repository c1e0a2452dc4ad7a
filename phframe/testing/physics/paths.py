"""Scenes and gripper paths for the checks of physics backends."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from phframe.core import (
    ArmModel,
    Contacts,
    Cylinder,
    GripperPath,
    Phase,
    PhaseRule,
    Scene,
    SceneObject,
    Shelf,
)

SHELF = Shelf(depth=0.6, width=0.6)
MIDDLE = 0.3
"""y of the shelf's centre line (m)."""
OUTSIDE = -0.05
"""x of the fingertip before the mouth (m)."""


def rule(speed: float = 0.25, opening: float = 0.0) -> PhaseRule:
    """A rule that allows contact."""
    return PhaseRule(speed, opening, Contacts.OBJECTS)


def path(poses: ArrayLike, phases: Sequence[Phase], *, speed: float = 0.25, opening: float = 0.0) -> GripperPath:
    """A path of which every phase has the same rule."""
    return GripperPath(np.asarray(poses, dtype=np.float64), tuple(phases), dict.fromkeys(phases, rule(speed, opening)))


def drive_in(x: float, y: float = MIDDLE, *, speed: float = 0.25) -> GripperPath:
    """Straight in from before the mouth, the fingers closed."""
    return path([[OUTSIDE, y, 0.0], [x, y, 0.0]], [Phase.INSERT], speed=speed)


def sweep(x: float, y0: float, y1: float, *, speed: float = 0.2) -> GripperPath:
    """In at ``y0``, across to ``y1``, and out."""
    poses = [[OUTSIDE, y0, 0.0], [x, y0, 0.0], [x, y1, 0.0], [OUTSIDE, y1, 0.0]]
    return path(poses, [Phase.INSERT, Phase.SWEEP, Phase.RETREAT], speed=speed)


def cylinder(
    name: str, x: float, y: float, *, radius: float = 0.03, mass: float = 0.3, friction: float = 0.25
) -> SceneObject:
    """An object."""
    return SceneObject(name, Cylinder(radius), (x, y), mass=mass, friction=friction)


def scene_of(*objects: SceneObject, shelf: Shelf = SHELF) -> Scene:
    """A scene whose target is the last object."""
    return Scene("a test stand", shelf, objects, objects[-1].id)


def crowd() -> Scene:
    """Five objects, four of which obstruct ``CROWD_SWEEP``."""
    return scene_of(
        cylinder("a", 0.20, 0.30),
        cylinder("b", 0.27, 0.33),
        cylinder("c", 0.20, 0.40),
        cylinder("d", 0.36, 0.26),
        cylinder("target", 0.50, 0.30),
    )


CROWD_SWEEP = sweep(0.33, 0.18, 0.36)


def finger_length(arm: ArmModel[Any]) -> float:
    """How far (m) the parts that go in first stand out before anything wider comes."""
    shape = arm.shape
    wider = [o for o in shape.closed if 2.0 * np.abs(o.vertices[:, 1]).max() > shape.insertion_width + 1e-6]
    return -max((float(o.vertices[:, 0].max()) for o in wider), default=-0.05)


def graspable_radius(arm: ArmModel[Any]) -> float:
    """The radius (m) of an object that fits well between the open fingers."""
    return min(0.03, arm.shape.max_opening / 2.0 - 0.008)


def grasp(arm: ArmModel[Any], x: float, y: float = MIDDLE, *, withdraw: bool = True) -> GripperPath:
    """In with open fingers until they are 2 cm past ``x``, close, and draw out."""
    opening, inside = 2.0 * (graspable_radius(arm) + 0.008), [x + 0.02, y, 0.0]
    poses = [[OUTSIDE, y, 0.0], inside, inside]
    rules = {Phase.REACH: rule(0.2, opening), Phase.GRASP: rule(0.1, arm.shape.min_opening)}
    phases = [Phase.REACH, Phase.GRASP]
    if withdraw:
        poses, phases = [*poses, [-0.12, y, 0.0]], [*phases, Phase.WITHDRAW]
        rules[Phase.WITHDRAW] = rule(0.2, arm.shape.min_opening)
    return GripperPath(np.array(poses), tuple(phases), rules)
