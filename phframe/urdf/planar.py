"""A planar arm made of boxes as a robot."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from phframe.core import Fingers, Joint, Outline
from phframe.urdf.model import Link, Mimic, Robot, RobotJoint
from phframe.urdf.solids import Inertia, Solid, Vector

DENSITY = 600.0
"""Of the boxes (kg/m^3): that of a hollow metal arm."""
CARRIAGE_MASS = 1.0
"""Of each of the two slides that carry no box (kg)."""
AXES: tuple[Vector, Vector, Vector] = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def planar_robot(name: str, joints: Sequence[Joint], fingers: Fingers, outlines: Sequence[Outline]) -> Robot:
    """A chain base -> x -> y -> yaw that ends in the link ``fingertip``, with two sliding fingers.

    Args:
        name: Of the robot.
        joints: Two that slide, along x and y, and one that turns.
        fingers: The gripper's joints and links, left and right.
        outlines: Parts of the arm, fingers closed; a part with a side belongs to that finger.
    """
    names = ["base", *(f"{joint.name}_slide" for joint in joints[:-1]), "fingertip"]
    sides = {names[-1]: 0, fingers.links[0]: 1, fingers.links[1]: -1}
    links = [_link(link, []) for link in names[:-1]]
    links += [_link(link, [outline for outline in outlines if outline.side == side]) for link, side in sides.items()]
    x, y, yaw = joints
    left, right = fingers.joints
    chain = [
        RobotJoint(names[0], names[1], joint=x, kind="prismatic", axis=AXES[0]),
        RobotJoint(names[1], names[2], joint=y, kind="prismatic", axis=AXES[1]),
        RobotJoint(names[2], names[3], joint=yaw, kind="revolute", axis=AXES[2]),
        RobotJoint(names[3], fingers.links[0], joint=left, kind="prismatic", axis=AXES[1]),
        RobotJoint(
            names[3], fingers.links[1], joint=right, kind="prismatic", axis=(0.0, -1.0, 0.0), mimic=Mimic(left.name)
        ),
    ]
    return Robot.of(name, links, chain)


def _link(name: str, outlines: Sequence[Outline]) -> Link:
    """A link of boxes of even density; it weighs what a small cube does where there are none."""
    boxes = [_box(outline) for outline in outlines]
    side = (CARRIAGE_MASS / DENSITY) ** (1.0 / 3.0)
    return Link.of_solids(name, _inertia(boxes or [Solid("box", (side, side, side))]), boxes)


def _inertia(boxes: Sequence[Solid]) -> Inertia:
    """I = sum of m (I_own + |r|^2 1 - r r^T), r from the common centre of mass: parallel axes (Huygens, Steiner)."""
    masses = np.array([DENSITY * np.prod(box.size) for box in boxes])
    centers = np.array([box.at for box in boxes])
    middle = masses @ centers / masses.sum()
    moments = np.zeros((3, 3))
    for mass, box, arm in zip(masses, boxes, centers - middle, strict=True):
        moments += mass * (box.moments(1.0) + np.eye(3) * (arm @ arm) - np.outer(arm, arm))
    return Inertia.of(float(masses.sum()), middle, moments)


def _box(outline: Outline) -> Solid:
    """The box around a part."""
    lower = np.array([*outline.vertices.min(axis=0), outline.bottom])
    upper = np.array([*outline.vertices.max(axis=0), outline.top])
    x, y, z = ((lower + upper) / 2.0).tolist()
    return Solid("box", tuple((upper - lower).tolist()), (x, y, z), part=outline.part, name=outline.part)
