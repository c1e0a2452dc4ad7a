"""Baxter's outlines against its collision geometry: what planning in the plane sees is what is there in space."""

from __future__ import annotations

from functools import cache
from itertools import product

import numpy as np
import pytest

pytest.importorskip("pinocchio", reason="needs the extra 'baxter'")

from phframe.core import FloatArray, Outline, Shelf, compose, inverse, planar_pose
from tests.arms.baxter_arm import baxter
from tests.arms.collision_surface import CollisionSurface

pytestmark = pytest.mark.needs_baxter
ARM, SHELF = baxter("left"), Shelf(0.594, 0.584)
MOUNT = ARM.default_base_pose(SHELF)
TOLERANCE = 2e-3
"""of widths (m): surfaces are sampled, outlines drawn around round ones."""
BARREL = 0.03
"""By how much the wrist's barrel stands out farther where its axis lies level and across (m)."""
GRIPPER = 0.215
"""How far behind the fingertip the gripper and the wrist that turns with it reach (m)."""


def surface(*links: str) -> CollisionSurface:
    return CollisionSurface(ARM, MOUNT, links)


@cache
def whole_arm() -> CollisionSurface:
    arm = ("upper_elbow", "lower_elbow", "upper_forearm", "lower_forearm", "wrist")
    return surface(*(f"left_{link}" for link in arm), "fingertip", *ARM.fingers.links)


def half_widths(distances: FloatArray) -> FloatArray:
    """How far the closed outlines stand out to either side at distances behind the fingertip ``(n,)`` (m)."""
    return np.asarray(np.max([half_width(outline, -distances) for outline in ARM.shape.closed], axis=0))


def half_width(outline: Outline, x: FloatArray) -> FloatArray:
    """How far one outline stands out at x ``(n,)``; 0 where it is not (m)."""
    widest = np.zeros(len(x))
    for (x0, y0), (x1, y1) in zip(outline.vertices, np.roll(outline.vertices, -1, axis=0), strict=True):
        low, high = min(x0, x1) - 1e-9, max(x0, x1) + 1e-9
        y = y0 + (y1 - y0) * (x - x0) / (x1 - x0) if x0 != x1 else np.full(len(x), max(abs(y0), abs(y1)))
        widest = np.where((x >= low) & (x <= high), np.maximum(widest, np.abs(y)), widest)
    return widest


def fits_shelf(q: FloatArray) -> bool:
    """Whether the arm touches neither walls, board nor ceiling."""
    points = whole_arm().in_shelf(q)
    x, y, z = points[points[:, 0] > 0.0].T
    return bool(((x < SHELF.depth) & (y > 0.0) & (y < SHELF.width) & (z > 0.0) & (z < SHELF.height)).all())


def excess(q: FloatArray) -> float:
    """By how much what is beyond the mouth is wider than the outlines say (m)."""
    points = whole_arm().behind_tip(q)
    return float((np.abs(points[:, 1]) - half_widths(-points[:, 0])).max(initial=0.0))


def configurations(pose: FloatArray) -> list[FloatArray]:
    """Configurations with the fingertip at a pose in the shelf, that touch no part of the shelf."""
    target = compose(inverse(MOUNT.pose), pose)
    lower, upper = np.array([[joint.lower, joint.upper] for joint in ARM.joints]).T
    starts = [ARM.home, *np.random.default_rng(1).uniform(lower, upper, (30, 7))]
    found = (ARM.kinematics.descend(target, start) for start in starts)
    return [q for q in found if q is not None and fits_shelf(q)]


@pytest.mark.slow
def test_wherever_the_arm_can_be_it_can_be_within_its_outlines() -> None:
    yaws, columns, depths = (0, 10, -10, 20, -20), (-0.2, -0.1, 0.0, 0.1, 0.2), (0.1, 0.2, 0.3, 0.4, 0.5)
    middle = SHELF.width / 2.0
    poses = [planar_pose(x, middle + y, 0.10, np.radians(yaw)) for yaw, y, x in product(yaws, columns, depths)]
    reached = [found for pose in poses if (found := configurations(pose))]
    least = np.array([min(excess(q) for q in found) for found in reached])
    assert len(reached) > 100
    assert (least <= TOLERANCE).mean() >= 0.7, (
        "of a few configurations at random; a motion planner looks for narrow ones"
    )
    assert (least <= BARREL).mean() >= 0.95, "else the wrist's barrel lies across"


def test_the_gripper_is_as_wide_as_its_collision_geometry() -> None:
    q = ARM.inverse(compose(inverse(MOUNT.pose), planar_pose(0.4, SHELF.width / 2.0, 0.10)), ARM.home)
    assert q is not None
    points = surface("left_wrist", "fingertip", *ARM.fingers.links).behind_tip(q)
    for near in np.arange(0.005, GRIPPER - 0.01, 0.01):
        slice_ = points[(points[:, 0] < -near) & (points[:, 0] > -near - 0.02)]
        outlined = half_widths(np.linspace(near, near + 0.02, 21)).max()
        assert float(np.abs(slice_[:, 1]).max(initial=0.0)) <= outlined + 1e-4
    widest = float(np.abs(points[:, 1]).max())
    assert widest == pytest.approx(float(half_widths(np.linspace(0.0, GRIPPER, 200)).max()), abs=TOLERANCE)


def test_the_forearm_is_no_wider_in_the_outlines_than_it_can_be() -> None:
    """Outlines that were far too wide would pass the other test: at no distance may they exceed all that occurs."""
    poses = [planar_pose(x, SHELF.width / 2.0 + y, 0.10) for x, y in product((0.4, 0.45, 0.5), (-0.2, -0.1, 0.1, 0.2))]
    points = np.vstack([whole_arm().behind_tip(q) for pose in poses for q in configurations(pose)])
    for near in np.arange(0.22, 0.48, 0.02):
        occurring = np.abs(points[(points[:, 0] < -near) & (points[:, 0] > -near - 0.03), 1]).max(initial=0.0)
        outlined = float(half_widths(np.array([near + 0.015]))[0])
        assert outlined <= occurring + 0.01, f"{near:g} m behind the fingertip"


def test_each_finger_is_one_outline_and_opens_with_its_collision_geometry() -> None:
    sides = [outline.side for outline in ARM.shape.closed]
    assert (sides.count(1), sides.count(-1)) == (1, 1)
    assert ARM.shape.insertion_width == pytest.approx(0.064, abs=1e-9)
    opened = ARM.shape.outlines(ARM.shape.max_opening)
    outer = max(float(outline.vertices[:, 1].max()) for outline in opened if outline.side == 1)
    assert 2.0 * outer == pytest.approx(0.1056, abs=2e-4)
    inner = min(float(outline.vertices[:, 1].min()) for outline in opened if outline.side == 1)
    assert 2.0 * inner == pytest.approx(ARM.shape.max_opening, abs=1e-9)


def test_heights_are_those_of_the_collision_geometry() -> None:
    by_name = {outline.part: outline for outline in ARM.shape.closed}
    assert (by_name["left finger"].bottom, by_name["left finger"].top) == pytest.approx((-0.021, 0.021))
    assert (by_name["fingertip body"].bottom, by_name["fingertip body"].top) == pytest.approx((-0.02735, 0.03865))
