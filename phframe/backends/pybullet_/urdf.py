"""Makes an arm's URDF fit for PyBullet, which names links but not their shapes, and passes over coupled joints."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Container, Iterator
from dataclasses import dataclass
from typing import Any

from phframe.core import ArmModel, IncompatibleError

COLLISION = " collision"
"""What the names of collision shapes end with, after the part they belong to."""


@dataclass(frozen=True, slots=True)
class Coupling:
    """A joint that follows another.

    Attributes:
        joint: That follows.
        leader: That it follows.
        ratio: Its value over the leader's.
        offset: Its value where the leader's is 0.
    """

    joint: str
    leader: str
    ratio: float
    offset: float


@dataclass(frozen=True, slots=True)
class PreparedUrdf:
    """An arm as PyBullet can have it.

    Attributes:
        text: The URDF: nothing to look at, one link for every part that has an outline.
        parts: What each link is called in a contact.
        couplings: Joints that follow others.
    """

    text: str
    parts: dict[str, str]
    couplings: tuple[Coupling, ...]


def prepared_urdf(arm: ArmModel[Any]) -> PreparedUrdf:
    """The URDF of an arm, ready to load.

    Raises:
        IncompatibleError: If it is not XML, or lacks a joint or link that the arm names.
    """
    try:
        robot = ET.fromstring(arm.urdf())
    except ET.ParseError as error:
        raise IncompatibleError(f"PyBullet cannot load the URDF of {type(arm).__name__}: {error}") from None
    _refuse_lacking(arm, robot)
    outlined = {outline.part for outline in arm.shape.closed}
    parts: dict[str, str] = {}
    for link in robot.findall("link"):
        for visual in link.findall("visual"):
            link.remove(visual)
        parts.update(_parts(robot, link, outlined))
    return PreparedUrdf(ET.tostring(robot, encoding="unicode"), parts, tuple(_couplings(robot)))


def _refuse_lacking(arm: ArmModel[Any], robot: ET.Element) -> None:
    joints, links = ({element.get("name") for element in robot.findall(kind)} for kind in ("joint", "link"))
    wanted = [joint.name for joint in (*arm.joints, *arm.fingers.joints)]
    wanted += [mimic.get("joint", "") for mimic in robot.iter("mimic")]
    lacking = [name for name in wanted if name not in joints]
    lacking += [name for name in (arm.tip_link, *arm.fingers.links) if name not in links]
    if lacking:
        raise IncompatibleError(f"the URDF of {type(arm).__name__} has no joint or link {', '.join(lacking)}")


def _parts(robot: ET.Element, link: ET.Element, outlined: Container[str]) -> Iterator[tuple[str, str]]:
    """What a link, and the links it is taken apart into, are called: as its outline, if it has one, or as it is."""
    name, covers = link.get("name", ""), link.findall("collision")
    own = [cover.get("name", "").removesuffix(COLLISION) for cover in covers]
    if len(covers) == 1:
        yield name, own[0] if own[0] in outlined else name
        return
    yield name, name
    for part, cover in zip(own, covers, strict=True):
        if part in outlined:
            link.remove(cover)
            yield _shell(robot, name, part, cover), part


def _shell(robot: ET.Element, parent: str, part: str, cover: ET.Element) -> str:
    """A link without mass for one shape of another link."""
    name = f"{parent}/{part}"
    shell = ET.SubElement(robot, "link", name=name)
    inertial = ET.SubElement(shell, "inertial")
    ET.SubElement(inertial, "mass", value="0")
    ET.SubElement(inertial, "inertia", dict.fromkeys(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), "0"))
    shell.append(cover)
    joint = ET.SubElement(robot, "joint", name=f"{name} mount", type="fixed")
    ET.SubElement(joint, "parent", link=parent)
    ET.SubElement(joint, "child", link=name)
    return name


def _couplings(robot: ET.Element) -> Iterator[Coupling]:
    for joint in robot.findall("joint"):
        mimic = joint.find("mimic")
        if mimic is not None:
            ratio, offset = float(mimic.get("multiplier", "1")), float(mimic.get("offset", "0"))
            yield Coupling(joint.get("name", ""), mimic.get("joint", ""), ratio, offset)
