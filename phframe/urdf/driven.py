"""A robot as an arm drives it: every other joint fixed, fingers that open upwards and are coupled one to one.

URDFs couple and count in many ways: fingers that open to negative values, by a multiplier of -1, or after a third joint. An
engine that commands each finger by half of the opening must not meet any of them.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from phframe.core import ArmError, ArmModel, FloatArray
from phframe.urdf.description import ArmDescription, TipFrame
from phframe.urdf.description_check import check_description
from phframe.urdf.model import Mimic, Robot, RobotJoint, listed
from phframe.yaml.wording import shown

SIDES = (1.0, -1.0)
ALONG = 1e-3
"""By how much the direction in which a finger slides may differ from the y axis of the fingertip frame (sine)."""
SAME = 1e-6
"""Two travels or places of fingers that differ by no more (m) are one."""


def driven_robot(description: ArmDescription, robot: Robot) -> Robot:
    """The robot of a description, with the link ``fingertip``.

    Joints that are not driven and follow none that is stay at 0, or at the limit nearest to it: they are fixed. Driven
    ones that turn without end get limits of half a turn either way. Fingers are closed at their lower limits, and the
    right one follows the left one.

    Raises:
        ArmError: If description and URDF do not agree, or the fingers do not slide apart evenly.
    """
    robot = _with_tip(robot, description.tip)
    check_description(description, robot)
    couplings = {name: _resolved(robot, name) for name in robot.moving}
    left, right = (_opening_upwards(robot, name, side) for name, side in zip(description.fingers, SIDES, strict=True))
    flips = {finger.name: -1.0 for finger in (left, right) if finger.axis != robot.joint(finger.name).axis}
    fingers = _coupled(left, right, couplings, flips)
    leaders = [finger.name for finger in fingers if finger.mimic is None]
    limited = [replace(robot.joint(name), kind="revolute") for name in description.joints if _is_endless(robot, name)]
    others = [joint for name, joint in robot.moving.items() if name not in {*description.joints, *description.fingers}]
    return robot.with_joints(
        [*fingers, *limited, *(_other(joint, couplings, description.joints, leaders, flips) for joint in others)]
    )


def placements(robot: Robot, tip: str, fingers: Sequence[str]) -> Mapping[str, FloatArray]:
    """Transforms ``(4, 4)`` of the links that move with the fingertip, in its frame.

    Args:
        robot: The robot.
        tip: The link whose frame is the fingertip's.
        fingers: Names of the joints of the fingers, which are at their lower limits.
    """
    top, place = tip, np.eye(4)
    while top in robot.parent_joints and robot.parent_joints[top].joint is None:
        place = robot.parent_joints[top].placement() @ place
        top = robot.parent_joints[top].parent
    places: dict[str, FloatArray] = {top: np.asarray(np.linalg.inv(place), dtype=np.float64)}
    for joint in robot.from_root:
        if joint.parent in places and joint.child != top and (joint.joint is None or joint.name in fingers):
            value = 0.0 if joint.joint is None else joint.joint.lower
            places[joint.child] = places[joint.parent] @ joint.placement(value)
    return places


def _is_endless(robot: Robot, name: str) -> bool:
    return robot.joint(name).kind == "continuous"


def _with_tip(robot: Robot, tip: TipFrame | None) -> Robot:
    if tip is None:
        if ArmModel.tip_link not in robot.links:
            raise ArmError(f"the URDF has no link {ArmModel.tip_link!r}: say under 'tip' where the fingertip is")
        return robot
    if tip.link not in robot.links:
        raise ArmError(f"the URDF has no link {shown(tip.link)}; there is: {listed(robot.links)}")
    if ArmModel.tip_link in robot.links:
        raise ArmError(f"the URDF has a link {ArmModel.tip_link!r} already: leave out 'tip', or rename the link")
    return robot.with_frame(ArmModel.tip_link, tip.link, tip.at, tip.rpy)


def _resolved(robot: Robot, name: str) -> Mimic:
    """The joint that a joint follows in the end, itself where it follows none."""
    coupling, seen = Mimic(name), {name}
    while (next_ := robot.joint(coupling.joint).mimic) is not None:
        coupling = coupling.after(next_)
        if coupling.joint in seen:
            raise ArmError(f"joint {name!r} of the URDF follows itself (mimic)")
        seen.add(coupling.joint)
        if coupling.joint not in robot.moving:
            raise ArmError(f"joint {name!r} of the URDF follows {shown(coupling.joint)}, which is no joint that moves")
    return coupling


def _opening_upwards(robot: Robot, name: str, side: float) -> RobotJoint:
    """A finger's joint, reversed if it moves towards the middle as its value grows."""
    joint = robot.joint(name)
    places = placements(robot, ArmModel.tip_link, [name])
    if joint.child not in places:
        raise ArmError(f"the finger joint {name!r} does not move with the fingertip: look at 'tip' and 'fingers'")
    along = places[joint.child][:3, :3] @ np.asarray(joint.axis)
    if abs(abs(along[1]) - 1.0) > ALONG:
        x, y, z = along
        raise ArmError(
            f"the finger joint {name!r} slides along ({x:.3g}, {y:.3g}, {z:.3g}) in the fingertip frame; "
            "fingers open along its y axis: look at the rpy of 'tip'"
        )
    return joint if along[1] * side > 0.0 else joint.reversed()


def _coupled(
    left: RobotJoint, right: RobotJoint, couplings: Mapping[str, Mimic], flips: Mapping[str, float]
) -> tuple[RobotJoint, RobotJoint]:
    """Both fingers, the right one after the left one where they are coupled at all."""
    assert left.joint is not None, "it slides"
    assert right.joint is not None, "it slides"
    travels = left.joint.upper - left.joint.lower, right.joint.upper - right.joint.lower
    if abs(travels[0] - travels[1]) > SAME:
        raise ArmError(
            f"the fingers travel {travels[0]:g} and {travels[1]:g} m; each must travel half of what the gripper opens"
        )
    a, b = couplings[left.name], couplings[right.name]
    if a.joint != b.joint:
        if {a.joint, b.joint} != {left.name, right.name}:
            raise ArmError(
                f"the fingers follow {a.joint!r} and {b.joint!r} (mimic); they must follow the same joint, or none"
            )
        return left, right
    ratio = (
        flips.get(right.name, 1.0) * flips.get(left.name, 1.0) * b.multiplier / a.multiplier if a.multiplier else 0.0
    )
    offset = flips.get(right.name, 1.0) * (b.offset - b.multiplier / (a.multiplier or 1.0) * a.offset)
    if abs(ratio - 1.0) > SAME or abs(left.joint.lower + offset - right.joint.lower) > SAME:
        raise ArmError(
            f"the finger joints {left.name!r} and {right.name!r} are coupled (mimic) so that they do not open evenly: "
            f"as the left one opens by 1 mm from {left.joint.lower:g}, the right one opens by {ratio:g} mm from "
            f"{left.joint.lower + offset:g}, and its closed place is {right.joint.lower:g}"
        )
    return replace(left, mimic=None), replace(right, mimic=Mimic(left.name, 1.0, right.joint.lower - left.joint.lower))


def _other(
    joint: RobotJoint,
    couplings: Mapping[str, Mimic],
    driven: Collection[str],
    fingers: Collection[str],
    flips: Mapping[str, float],
) -> RobotJoint:
    """A joint that is not driven: after a driven one or a finger that follows none, or fixed."""
    assert joint.joint is not None, "it moves"
    own = couplings[joint.name]
    for finger in fingers:
        leader = couplings[finger]
        if own.joint == leader.joint and leader.multiplier:
            multiplier = own.multiplier / leader.multiplier
            flipped = multiplier * flips.get(finger, 1.0)
            return replace(joint, mimic=Mimic(finger, flipped, own.offset - multiplier * leader.offset))
    if own.joint in driven:
        return replace(joint, mimic=own)
    lower, upper = joint.joint.lower, joint.joint.upper
    value = own.offset if own.joint != joint.name else 0.0
    return joint.fixed_at(min(max(value, lower), upper) if lower < upper else value)
