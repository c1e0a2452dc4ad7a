"""Writes URDF text for a planar arm made of boxes."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Sequence

import numpy as np

from phframe.core import Fingers, FloatArray, Joint, Outline

DENSITY = 600.0
"""Of the boxes (kg/m^3): that of a hollow metal arm."""
CARRIAGE_MASS = 1.0
"""Of each of the two slides that carry no box (kg)."""


def planar_urdf(name: str, joints: Sequence[Joint], fingers: Fingers, outlines: Sequence[Outline]) -> str:
    """A chain base -> x -> y -> yaw that ends in the link ``fingertip``, with two sliding fingers.

    Args:
        name: Of the robot.
        joints: Two that slide, along x and y, and one that turns.
        fingers: The gripper's joints and links, left and right.
        outlines: Parts of the arm, fingers closed; a part with a side belongs to that finger.
    """
    robot = ET.Element("robot", name=name)
    links = ["base", *(f"{joint.name}_slide" for joint in joints[:-1]), "fingertip"]
    for link in links[:-1]:
        _add_link(robot, link, [])
    _add_link(robot, links[-1], [outline for outline in outlines if not outline.side])
    kinds = zip(
        joints, ("prismatic", "prismatic", "revolute"), ("1 0 0", "0 1 0", "0 0 1"), links, links[1:], strict=False
    )
    for joint, kind, axis, parent, child in kinds:
        _add_joint(robot, joint, kind, axis, parent, child)
    for joint, link, side in zip(fingers.joints, fingers.links, (1, -1), strict=True):
        _add_link(robot, link, [outline for outline in outlines if outline.side == side])
        element = _add_joint(robot, joint, "prismatic", f"0 {side} 0", links[-1], link)
        if side < 0:
            ET.SubElement(element, "mimic", joint=fingers.joints[0].name, multiplier="1", offset="0")
    ET.indent(robot)
    return ET.tostring(robot, encoding="unicode")


def _add_joint(robot: ET.Element, joint: Joint, kind: str, axis: str, parent: str, child: str) -> ET.Element:
    element = ET.SubElement(robot, "joint", name=joint.name, type=kind)
    ET.SubElement(element, "parent", link=parent)
    ET.SubElement(element, "child", link=child)
    ET.SubElement(element, "axis", xyz=axis)
    limits = {"lower": joint.lower, "upper": joint.upper, "velocity": joint.velocity, "effort": joint.effort}
    ET.SubElement(element, "limit", {key: repr(number) for key, number in limits.items()})
    return element


def _add_link(robot: ET.Element, name: str, outlines: Sequence[Outline]) -> None:
    link = ET.SubElement(robot, "link", name=name)
    boxes = [_box(outline) for outline in outlines]
    _add_inertia(ET.SubElement(link, "inertial"), boxes)
    for outline, (center, size) in zip(outlines, boxes, strict=True):
        for role in ("visual", "collision"):
            element = ET.SubElement(link, role, name=f"{outline.part} {role}")
            ET.SubElement(element, "origin", xyz=_text(center), rpy="0 0 0")
            ET.SubElement(ET.SubElement(element, "geometry"), "box", size=_text(size))


def _box(outline: Outline) -> tuple[FloatArray, FloatArray]:
    """Centre ``(3,)`` and size ``(3,)`` of the box around a part (m)."""
    lower = np.array([*outline.vertices.min(axis=0), outline.bottom])
    upper = np.array([*outline.vertices.max(axis=0), outline.top])
    return (lower + upper) / 2.0, upper - lower


def _add_inertia(inertial: ET.Element, boxes: Sequence[tuple[FloatArray, FloatArray]]) -> None:
    """Mass, centre and moments of boxes of even density; of a small cube where there are none."""
    side = (CARRIAGE_MASS / DENSITY) ** (1.0 / 3.0)
    solids = boxes or [(np.zeros(3), np.full(3, side))]
    masses = np.array([DENSITY * size.prod() for _, size in solids])
    centers = np.array([center for center, _ in solids])
    middle = masses @ centers / masses.sum()
    moments = np.zeros((3, 3))
    for mass, (center, size) in zip(masses, solids, strict=True):
        arm = center - middle
        own = np.diag((size**2).sum() - size**2) / 12.0
        moments += mass * (own + np.eye(3) * (arm @ arm) - np.outer(arm, arm))
    ET.SubElement(inertial, "origin", xyz=_text(middle), rpy="0 0 0")
    ET.SubElement(inertial, "mass", value=repr(float(masses.sum())))
    names = {"ixx": (0, 0), "iyy": (1, 1), "izz": (2, 2), "ixy": (0, 1), "ixz": (0, 2), "iyz": (1, 2)}
    ET.SubElement(inertial, "inertia", {key: repr(float(moments[cell])) for key, cell in names.items()})


def _text(vector: FloatArray) -> str:
    return " ".join(repr(float(value)) for value in vector)
