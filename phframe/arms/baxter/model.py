"""Baxter as links and joints, from the table of figures: one arm moves, the other is parked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import cos, sin
from typing import Literal

import numpy as np

from phframe.arms.baxter import figures
from phframe.core import Fingers, Joint
from phframe.urdf.model import Link, Mimic, Robot, RobotJoint
from phframe.urdf.solids import ORIGIN, Inertia, Solid, Vector, of_solids, rotation, together

Side = Literal["left", "right"]
SIDES: tuple[Side, Side] = ("left", "right")
TIP = "fingertip"
"""The link at the fingertip of the arm that moves."""
MIRRORED = ("s0", "e0", "w0", "w2")
"""Joints whose values change sign between mirrored poses of the two arms."""


def baxter_robot(side: Side) -> Robot:
    """Baxter with one arm that moves and the other parked outwards."""
    parts = list(_parts(side))
    return Robot.of(f"baxter_{side}", [link for link, _ in parts], [joint for _, joint in parts if joint])


def arm_joints(side: Side) -> tuple[Joint, ...]:
    """The seven joints of an arm, from the shoulder to the wrist."""
    return tuple(
        Joint(f"{side}_{s.joint}", s.lower, s.upper, velocity=s.velocity, effort=s.effort) for s in figures.SEGMENTS
    )


def fingers(side: Side) -> Fingers:
    """The gripper of an arm."""
    limits = (0.0, figures.FINGER_TRAVEL, figures.FINGER_VELOCITY, figures.FINGER_EFFORT)
    links = _finger_links(side)
    return Fingers((Joint(f"{links[0]}_joint", *limits), Joint(f"{links[1]}_joint", *limits)), links)


def mirrored(q: Sequence[float]) -> tuple[float, ...]:
    """The joint values of the other arm in the mirrored pose (y -> -y)."""
    return tuple(
        -value if segment.joint in MIRRORED else value for segment, value in zip(figures.SEGMENTS, q, strict=True)
    )


Part = tuple[Link, RobotJoint | None]


def _parts(side: Side) -> Iterator[Part]:
    """Every link with what it hangs on, parents first."""
    yield Link.of_solids("base", figures.TORSO, figures.TORSO_GEOMETRY), None
    yield (
        Link.of_solids("pedestal", figures.PEDESTAL, figures.PEDESTAL_GEOMETRY),
        RobotJoint("base", "pedestal", ORIGIN),
    )
    yield Link.of_solids("head", figures.HEAD, figures.HEAD_GEOMETRY), RobotJoint("base", "head", figures.HEAD_AT)
    yield Link.of_solids("screen", figures.SCREEN), RobotJoint("head", "screen", figures.SCREEN_AT, figures.SCREEN_RPY)
    yield from _arm(side, None)
    if side == "left":
        yield from _arm("right", mirrored(figures.IDLE))
    else:
        yield from _arm("left", figures.IDLE)


def _arm(side: Side, parked: tuple[float, ...] | None) -> Iterator[Part]:
    """The links of an arm, moving or fixed where it is parked."""
    parent = "base"
    for number, (segment, joint) in enumerate(zip(figures.SEGMENTS, arm_joints(side), strict=True)):
        child = f"{side}_{segment.link}"
        at, rpy = (segment.at, segment.rpy) if number else _shoulder(side)
        hung = RobotJoint(parent, child, at, rpy, joint)
        yield (
            Link.of_solids(child, segment.inertia, segment.collision_geometry),
            hung if parked is None else _parked(hung, parked[number]),
        )
        parent = child
    yield from _gripper(side, parent, moving=parked is None)


def _shoulder(side: Side) -> tuple[Vector, Vector]:
    """The first joint's origin and rotation on the torso."""
    sign = 1.0 if side == "left" else -1.0
    (x, y, z), (ahead, _, up), yaw = figures.SHOULDER_AT, figures.SEGMENTS[0].at, sign * figures.SHOULDER_YAW
    return (x + ahead * cos(yaw), sign * y + ahead * sin(yaw), z + up), (0.0, 0.0, yaw)


def _gripper(side: Side, parent: str, *, moving: bool) -> Iterator[Part]:
    tip, links = TIP if moving else f"{side}_{TIP}", _finger_links(side)
    at = tuple(a + b for a, b in zip(figures.HAND_AT, figures.TIP_AT, strict=True))
    body = _seen_from_tip(figures.GRIPPER_BODY)
    inertia = together([_hand_from_tip(), of_solids(figures.GRIPPER_MASS, [body])])
    yield Link.of_solids(tip, inertia, (body,)), RobotJoint(parent, tip, (at[0], at[1], at[2]), figures.TIP_TURN)
    mechanism = fingers(side)
    for link, joint, sign in zip(links, mechanism.joints, (1.0, -1.0), strict=True):
        solids = tuple(_on_side(solid, sign) for solid in figures.FINGER_GEOMETRY)
        base = (-figures.FINGER_LENGTH, sign * figures.FINGER_SLOT, 0.0)
        mimic = Mimic(mechanism.joints[0].name) if sign < 0.0 else None
        slide = RobotJoint(tip, link, base, ORIGIN, joint, "prismatic", (0.0, sign, 0.0), mimic)
        yield (
            Link.of_solids(link, of_solids(figures.FINGER_MASS, solids), solids),
            slide if moving else _parked(slide, 0.0),
        )


def _finger_links(side: Side) -> tuple[str, str]:
    return f"{side}_gripper_left_finger", f"{side}_gripper_right_finger"


def _hand_from_tip() -> Inertia:
    """The hand's inertia in the fingertip frame."""
    x, y, z = figures.TIP_AT
    axes = rotation(figures.TIP_TURN).T
    at = axes @ np.array([-x, -y, -z])
    return figures.HAND.moved((float(at[0]), float(at[1]), float(at[2])), (0.0, -figures.TIP_TURN[1], 0.0))


def _seen_from_tip(box: Solid) -> Solid:
    """A box of the hand's frame in the fingertip frame: z becomes x, x becomes -z."""
    (x, y, z), (width, length, depth) = box.at, box.size
    return replace(box, size=(depth, length, width), at=(z - figures.TIP_AT[2], y, -x))


def _on_side(solid: Solid, sign: float) -> Solid:
    """A part of the left finger on either finger: turned half way about the gripper's axis."""
    x, y, z = solid.at
    return replace(solid, at=(x, sign * y, sign * z))


def _parked(joint: RobotJoint, value: float) -> RobotJoint:
    return replace(joint.fixed_at(value), fixed_name="")
