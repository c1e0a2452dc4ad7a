"""A small reader of URDF that computes link poses on its own, to compare an arm's kinematics with."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from phframe.core import FloatArray, compose

IDENTITY = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])


@dataclass(frozen=True, slots=True)
class UrdfJoint:
    """A joint as the URDF has it.

    Attributes:
        name: Its name.
        kind: ``revolute``, ``prismatic``, ``continuous`` or ``fixed``.
        parent: The link it hangs on.
        child: The link it carries.
        origin: Pose ``(7,)`` in the parent's frame.
        axis: ``(3,)``.
        limits: lower, upper, velocity, effort, where given.
        mimic: The joint it follows, or None.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: FloatArray
    axis: FloatArray
    limits: Mapping[str, float]
    mimic: str | None

    def motion(self, value: float) -> FloatArray:
        """Pose ``(7,)`` of the child's frame for a joint value, in the joint's frame."""
        axis = self.axis / np.linalg.norm(self.axis)
        if self.kind == "prismatic":
            return np.concatenate([axis * value, IDENTITY[3:]])
        if self.kind in ("revolute", "continuous"):
            return np.concatenate([np.zeros(3), [math.cos(value / 2.0)], axis * math.sin(value / 2.0)])
        return IDENTITY


class UrdfTree:
    """The links and joints of a URDF text.

    Args:
        text: The URDF.

    Raises:
        xml.etree.ElementTree.ParseError: If it is no XML.
    """

    def __init__(self, text: str) -> None:
        self.root = ET.fromstring(text)
        self.links = [link.get("name", "") for link in self.root.findall("link")]
        self.joints = {element.get("name", ""): _joint(element) for element in self.root.findall("joint")}
        self._above = {joint.child: joint for joint in self.joints.values()}

    @property
    def bases(self) -> list[str]:
        """The links that hang on no joint; a tree has one."""
        return [link for link in self.links if link not in self._above]

    def link_element(self, name: str) -> ET.Element | None:
        """The element of a link."""
        return next((link for link in self.root.findall("link") if link.get("name") == name), None)

    def pose_of(self, link: str, values: Mapping[str, float]) -> FloatArray:
        """Pose ``(7,)`` of a link in the frame of the base, for joint values by name; others are 0."""
        pose = IDENTITY
        while link in self._above:
            joint = self._above[link]
            value = values.get(joint.name, values.get(joint.mimic or "", 0.0))
            pose = compose(compose(joint.origin, joint.motion(value)), pose)
            link = joint.parent
        return pose


def _joint(element: ET.Element) -> UrdfJoint:
    limit, mimic = element.find("limit"), element.find("mimic")
    return UrdfJoint(
        element.get("name", ""),
        element.get("type", ""),
        _attribute(element, "parent", "link"),
        _attribute(element, "child", "link"),
        _origin(element.find("origin")),
        _numbers(_attribute(element, "axis", "xyz") or "1 0 0"),
        {} if limit is None else {key: float(value) for key, value in limit.items()},
        None if mimic is None else mimic.get("joint"),
    )


def _attribute(element: ET.Element, child: str, key: str) -> str:
    found = element.find(child)
    return "" if found is None else found.get(key, "")


def _numbers(text: str) -> FloatArray:
    return np.array([float(word) for word in text.split()])


def _origin(element: ET.Element | None) -> FloatArray:
    if element is None:
        return IDENTITY
    roll, pitch, yaw = _numbers(element.get("rpy", "0 0 0")) / 2.0
    turns = (
        np.array([0.0, 0.0, 0.0, math.cos(yaw), 0.0, 0.0, math.sin(yaw)]),
        np.array([0.0, 0.0, 0.0, math.cos(pitch), 0.0, math.sin(pitch), 0.0]),
        np.array([0.0, 0.0, 0.0, math.cos(roll), math.sin(roll), 0.0, 0.0]),
    )
    pose = compose(compose(turns[0], turns[1]), turns[2])
    return np.concatenate([_numbers(element.get("xyz", "0 0 0")), pose[3:]])
