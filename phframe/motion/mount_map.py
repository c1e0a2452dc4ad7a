"""Where an arm's base would have to stand for a scene: the straight reach of its target, from base pose to base pose."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
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


def mount_map(arms: Sequence[ArmModel[Any]], scene: Scene, told: Told = lambda done, of: None) -> Iterator[Mount]:
    """The reach of a scene's target from base poses around the default ones, nearest these first.

    Args:
        arms: The same arm with each of the options that are to be chosen among, the preferred one first; all support
            straight reaches.
        scene: The scene.
        told: Is told how far it is.
    """
    offsets = sorted(product(ACROSS, UP), key=lambda offset: math.hypot(*offset))
    asked = [(arm, _moved(arm.default_base_pose(scene.shelf), *offset)) for offset in offsets for arm in arms]
    for done, (arm, base_pose) in enumerate(asked, start=1):
        yaws = _grasp_yaws(straight_reach(arm, scene.shelf, base_pose), scene, ROUGHLY)
        told(done, len(asked))
        yield Mount(arm, base_pose, yaws)


def best_mount(mounts: Iterable[Mount], scene: Scene, least_served: float) -> Mount | None:
    """The first mount from which the target is reached and left again, also looked at closely; None: there is none.

    The nearest to the default is best, since the default serves the whole shelf well, where things must be pushed.

    Args:
        mounts: In order of preference.
        scene: The scene.
        least_served: Fraction of the shelf that must be within reach besides.
    """
    for mount in mounts:
        if not mount.yaws or not _grasp_yaws(straight_reach(mount.arm, scene.shelf, mount.base_pose), scene, 1):
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
    """A base pose elsewhere, in figures that are short to write; where it is not moved, bit by bit the same."""
    if across == up == 0.0:
        return base_pose
    y, z = (round(value, 6) for value in (base_pose.y + across, base_pose.z + up))
    return replace(base_pose, y=y, z=z)
