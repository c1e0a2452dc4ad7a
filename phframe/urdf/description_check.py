"""Whether what is described of an arm agrees with its URDF."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from phframe.core import ArmError, Joint
from phframe.urdf.description import ArmDescription
from phframe.urdf.model import Robot, listed
from phframe.yaml.wording import shown


def check_description(description: ArmDescription, robot: Robot) -> None:
    """Find a description and a URDF to agree.

    Raises:
        ArmError: If they do not; says where.
    """
    names = (*description.joints, *description.fingers)
    if twice := sorted({name for name in names if names.count(name) > 1}):
        raise ArmError(f"joint {twice[0]!r} is named twice under 'joints' and 'fingers'")
    joints = [_joint(robot, name) for name in description.joints]
    if followers := [name for name in description.joints if robot.joint(name).mimic]:
        raise ArmError(f"joint {followers[0]!r} follows another (mimic); under 'joints' are those that are driven")
    for name in description.fingers:
        _joint(robot, name)
        if robot.joint(name).kind != "prismatic":
            raise ArmError(f"the finger joint {name!r} turns; fingers that slide are needed")
    _check_values("home", description.home, joints)
    for configuration in description.seed_configurations:
        _check_values("a seed configuration", configuration, joints)
    if strange := sorted({link for pair in description.allowed_collisions for link in pair} - set(robot.links)):
        raise ArmError(
            f"'overlapping' or the SRDF names the link {shown(strange[0])}, which the URDF has not; "
            f"there is: {listed(robot.links)}"
        )


def _joint(robot: Robot, name: str) -> Joint:
    """A joint that can be driven."""
    joint = robot.joint(name).joint
    assert joint is not None, "found by its joint"
    for fault in _faults(joint):
        raise ArmError(f"joint {name!r} of the URDF {fault}")
    return joint


def _faults(joint: Joint) -> Iterator[str]:
    if joint.lower >= joint.upper:
        yield f"has no room between its limits {joint.lower:g} and {joint.upper:g} (0 where none is given)"
    for key, value in (("velocity", joint.velocity), ("effort", joint.effort)):
        if value <= 0.0:
            yield f"has the {key} {value:g} (0 where none is given); the arm drives it, so one above 0 is needed"


def _check_values(what: str, values: Sequence[float], joints: Sequence[Joint]) -> None:
    if len(values) != len(joints):
        raise ArmError(f"{what} has {len(values)} values for {len(joints)} joints")
    for joint, value in zip(joints, values, strict=True):
        if not joint.lower <= value <= joint.upper:
            raise ArmError(f"at {what} {joint.name} is {value:g}, beyond its limits {joint.lower:g} to {joint.upper:g}")
