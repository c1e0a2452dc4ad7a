"""Where an arm's base would have to stand for a scene: the straight reach of its target, from base pose to base pose."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

from phframe.core import ArmModel, BasePose, Scene, Shelf
from phframe.motion.reachability import SupportsStraightReach
from phframe.motion.straight_reach import ROUGHLY, StraightReach

ACROSS = (0.0, 0.1, -0.1)
"""From the default base pose along the mouth (m)."""
UP = (0.0, 0.05, -0.05, -0.1)
"""From the default base pose upwards (m)."""
ENOUGH = 2
"""Free yaws to the target, from which on more of them do not count for more than a base that is nearer the default."""
Told = Callable[[int, int], None]
"""Is told how many of how many base poses have been looked at."""


@dataclass(frozen=True, slots=True)
class Mount:
    """An arm on a base that stands somewhere, and how it gets at a scene's target.

    Attributes:
        arm: The arm, as one of its options has it.
        base_pose: Where its base stands.
        yaws: Of the gripper (rad), at which the straight way to the target and out again is free in an empty shelf.
    """

    arm: ArmModel[Any]
    base_pose: BasePose
    yaws: tuple[float, ...]


def mount_map(arms: Sequence[ArmModel[Any]], scene: Scene, told: Told = lambda done, of: None) -> tuple[Mount, ...]:
    """The reach of a scene's target from base poses around the default ones.

    Args:
        arms: The same arm with each of the options that are to be chosen among, the preferred one first; all support
            straight reaches.
        scene: The scene.
        told: Is told how far it is.

    Returns:
        In the order of preference: nearest the default first.
    """
    offsets = sorted(product(ACROSS, UP), key=lambda offset: math.hypot(*offset))
    asked = [(arm, _moved(arm.default_base_pose(scene.shelf), *offset)) for offset in offsets for arm in arms]
    found = []
    for done, (arm, base_pose) in enumerate(asked, start=1):
        yaws = _grasp_yaws(straight_reach(arm, scene.shelf, base_pose), scene, ROUGHLY)
        found.append(Mount(arm, base_pose, yaws))
        told(done, len(asked))
    return tuple(found)


def best_mount(mounts: Sequence[Mount], scene: Scene, least_served: float) -> Mount | None:
    """The first mount with ``ENOUGH`` free yaws to the target, else the one with the most; None: none has any.

    What the map found roughly is looked at closely, and so much of the shelf must be within reach besides.

    Args:
        mounts: In order of preference.
        scene: The scene.
        least_served: Fraction of the shelf.
    """
    for mount in sorted(mounts, key=lambda mount: -min(len(mount.yaws), ENOUGH)):
        reach = straight_reach(mount.arm, scene.shelf, mount.base_pose)
        if not mount.yaws or not _grasp_yaws(reach, scene, 1):
            continue
        served = mount.arm.fraction_served(scene.shelf, mount.base_pose, least_served)
        if served is None or served >= least_served:
            return mount
    return None


def straight_reach(arm: ArmModel[Any], shelf: Shelf, base_pose: BasePose) -> StraightReach:
    """The straight ways in of an arm that supports them."""
    assert isinstance(arm, SupportsStraightReach), "asked for only then"
    return arm.straight_reach(shelf, base_pose)


def _grasp_yaws(reach: StraightReach, scene: Scene, stride: int) -> tuple[float, ...]:
    item = scene.objects[scene.target_index]
    return reach.grasp_yaws(item.position, item.radius, stride, back=True)


def _moved(base_pose: BasePose, across: float, up: float) -> BasePose:
    """A base pose elsewhere, in figures that are short to write."""
    y, z = (round(value, 6) for value in (base_pose.y + across, base_pose.z + up))
    return replace(base_pose, y=y, z=z)
