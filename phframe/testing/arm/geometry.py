"""Checks of what an arm says of itself seen from above."""

from __future__ import annotations

from functools import partial

import numpy as np

from phframe.core import ArmError, FloatArray, Outline, compose, rotation_matrix, tilt_of, yaw_of
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_at_most, expect_close, expect_raises
from phframe.testing.subjects import ArmUnderTest
from phframe.testing.tolerances import OUTLINE

LEVEL = 0.1
"""A gripper that leans by more than this (rad) is not what its outlines show."""


@check
def outlines_are_convex_and_counter_clockwise(subject: ArmUnderTest) -> Faults:
    """Outline: a convex part, vertices (k, 2) counter-clockwise."""
    for outline in subject.arm.shape.closed:
        edges = np.roll(outline.vertices, -1, axis=0) - outline.vertices
        after = np.roll(edges, -1, axis=0)
        turns = edges[:, 0] * after[:, 1] - edges[:, 1] * after[:, 0]
        once = abs(np.arctan2(turns, (edges * after).sum(axis=1)).sum() - 2.0 * np.pi) < 1e-6
        sound = len(outline.vertices) >= 3 and (turns >= -1e-12).all() and once
        yield from expect(sound, f"{outline.part!r} convex and counter-clockwise", str(outline.vertices.tolist()))
        yield from expect(
            outline.bottom < outline.top, f"{outline.part!r} with bottom < top", f"{outline.bottom:g}, {outline.top:g}"
        )


@check
def origin_is_at_the_tip(subject: ArmUnderTest) -> Faults:
    """Outline: the origin is at the tip of the closed fingers, x points ahead."""
    front = max(float(outline.vertices[:, 0].max()) for outline in subject.arm.shape.closed)
    yield from expect_close(front, 0.0, OUTLINE, "the foremost point of the closed outlines (m)")


@check
def widths_are_those_of_the_outlines(subject: ArmUnderTest) -> Faults:
    """ArmShape: link_width where it is widest, open fingers included; insertion_width of the closed fingers together."""
    shape = subject.arm.shape
    widest = _width(shape.outlines(shape.max_opening))
    yield from expect_close(shape.link_width, widest, OUTLINE, "link_width, the width of the widest outline (m)")
    first = [outline for outline in shape.closed if outline.vertices[:, 0].max() > -OUTLINE]
    yield from expect_close(_width(first), shape.insertion_width, OUTLINE, "the width of what goes in first (m)")


@check
def opening_moves_each_finger_by_half(subject: ArmUnderTest) -> Faults:
    """Outline.side: which way a part moves as the gripper opens, by half of what it opens; +1 to the left."""
    shape = subject.arm.shape
    sides = [outline.side for outline in shape.closed]
    yield from expect({-1, 1} <= set(sides) <= {-1, 0, 1}, "a part with side +1, one with -1, others 0", str(sides))
    opened = shape.outlines(shape.max_opening)
    travel = (shape.max_opening - shape.min_opening) / 2.0
    for before, after in zip(shape.closed, opened, strict=True):
        moved = after.vertices - before.vertices
        yield from expect_close(
            moved, moved * 0.0 + [0.0, before.side * travel], 1e-9, f"how far {before.part!r} moves"
        )
    for outline in shape.closed:
        middle = float(outline.vertices[:, 1].mean())
        yield from expect(
            middle * outline.side >= 0.0, f"{outline.part!r} on its own side", f"its middle at y = {middle:g}"
        )


@check
def fingers_open_as_far_as_their_joints_let_them(subject: ArmUnderTest) -> Faults:
    """Fingers: each travels half of what the gripper opens, within its joint's limits."""
    shape = subject.arm.shape
    for joint in subject.arm.fingers.joints:
        wanted = (shape.max_opening - shape.min_opening) / 2.0
        yield from expect_close(joint.upper - joint.lower, wanted, 1e-9, f"the travel of {joint.name!r} (m)")


@check
def openings_out_of_range_are_refused(subject: ArmUnderTest) -> Faults:
    """ArmShape.outlines raises ArmError if the gripper cannot open that far."""
    shape = subject.arm.shape
    for opening in (shape.max_opening + 0.01, shape.min_opening - 0.01, float("nan")):
        yield from expect_raises(ArmError, partial(shape.outlines, opening), f"an opening of {opening:g} m")


@check
def home_is_outside_the_shelf(subject: ArmUnderTest) -> Faults:
    """ArmModel.home: the parked arm, outside the shelf, for the default base pose."""
    arm = subject.arm
    tip = compose(arm.default_base_pose(subject.shelf).pose, arm.forward(arm.home))
    yield from expect(tip[0] <= 0.0, "the fingertip before the mouth", f"at x = {tip[0]:g} m")
    if tilt_of(tip) > LEVEL:
        return
    for outline in (*arm.shape.closed, *arm.shape.outlines(arm.shape.max_opening)):
        front = float(_placed(outline, tip)[:, 0].max())
        yield from expect_at_most(front, 0.0, f"x of the foremost point of {outline.part!r} (m)")


def _width(outlines: list[Outline] | tuple[Outline, ...]) -> float:
    """The width (m) of the narrowest strip about the x axis that holds all outlines."""
    return 2.0 * max(float(np.abs(outline.vertices[:, 1]).max()) for outline in outlines)


def _placed(outline: Outline, tip: FloatArray) -> FloatArray:
    return np.asarray(outline.vertices @ rotation_matrix(yaw_of(tip)).T + tip[:2])


GEOMETRY_CHECKS: tuple[Check[ArmUnderTest], ...] = (
    outlines_are_convex_and_counter_clockwise,
    origin_is_at_the_tip,
    widths_are_those_of_the_outlines,
    opening_moves_each_finger_by_half,
    fingers_open_as_far_as_their_joints_let_them,
    openings_out_of_range_are_refused,
    home_is_outside_the_shelf,
)
