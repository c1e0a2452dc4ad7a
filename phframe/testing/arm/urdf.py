"""Checks that an arm's URDF says the same as the arm."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np

from phframe.core import compose, inverse
from phframe.testing.arm.urdf_tree import UrdfTree
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_close, expect_equal
from phframe.testing.subjects import ArmUnderTest
from phframe.testing.tolerances import URDF

GEOMETRIES = {"box", "cylinder", "sphere", "mesh"}
KINDS = {"revolute", "prismatic", "continuous", "fixed"}


@check
def urdf_is_one_tree(subject: ArmUnderTest) -> Faults:
    """ArmModel.urdf: URDF text, whose links hang together by joints from one base."""
    tree = UrdfTree(subject.arm.urdf())
    yield from expect_equal(tree.root.tag, "robot", "the root element")
    yield from expect(len(set(tree.links)) == len(tree.links), "links of different names", str(tree.links))
    yield from expect(len(tree.bases) == 1, "one link that hangs on no joint", str(tree.bases))
    for joint in tree.joints.values():
        known = joint.parent in tree.links and joint.child in tree.links
        yield from expect(known, f"links at both ends of {joint.name!r}", f"{joint.parent!r} and {joint.child!r}")
        yield from expect(joint.kind in KINDS, f"{joint.name!r} to be of a kind that is known", joint.kind)


@check
def urdf_has_the_joints_and_links(subject: ArmUnderTest) -> Faults:
    """ArmModel.urdf: its joints and links bear the names in ``joints``, ``fingers`` and ``tip_link``; limits are real."""
    arm, tree = subject.arm, UrdfTree(subject.arm.urdf())
    for link in (arm.tip_link, *arm.fingers.links):
        yield from expect(link in tree.links, f"a link {link!r}", f"links: {', '.join(tree.links)}")
    for joint in (*arm.joints, *arm.fingers.joints):
        yield from expect(joint.name in tree.joints, f"a joint {joint.name!r}", f"joints: {', '.join(tree.joints)}")
        if joint.name in tree.joints:
            limits = tree.joints[joint.name].limits
            found = [limits.get(key, np.nan) for key in ("lower", "upper", "velocity", "effort")]
            wanted = [joint.lower, joint.upper, joint.velocity, joint.effort]
            yield from expect(np.allclose(found, wanted), f"limits of {joint.name!r}: {wanted}", str(found))


@check
def urdf_moves_like_the_arm(subject: ArmUnderTest) -> Faults:
    """ArmModel.tip_link: the link of the URDF that ``forward`` gives the pose of, in the frame of the base."""
    arm, tree = subject.arm, UrdfTree(subject.arm.urdf())
    for q in (arm.home, *subject.joint_values()):
        found = tree.pose_of(arm.tip_link, {joint.name: float(v) for joint, v in zip(arm.joints, q, strict=True)})
        wanted = np.asarray(arm.forward(q))
        same_sign = np.concatenate([found[:3], found[3:] * (np.sign(found[3:] @ wanted[3:]) or 1.0)])
        yield from expect_close(same_sign, wanted, URDF, f"the fingertip of the URDF at q = {q}")


@check
def urdf_fingers_open_sideways(subject: ArmUnderTest) -> Faults:
    """Fingers: two coupled fingers that slide, left and right, each by half of what the gripper opens."""
    arm, tree = subject.arm, UrdfTree(subject.arm.urdf())
    for joint, link, side in zip(arm.fingers.joints, arm.fingers.links, (1.0, -1.0), strict=True):
        # Seen from the fingertip, with whatever mimics this joint left where it is.
        level = inverse(tree.pose_of(arm.tip_link, {}))
        closed, opened = (compose(level, tree.pose_of(link, {joint.name: v})) for v in (joint.lower, joint.upper))
        moved = opened[:3] - closed[:3]
        wanted = [0.0, side * (joint.upper - joint.lower), 0.0]
        yield from expect_close(moved, wanted, URDF, f"how far {link!r} moves in the fingertip frame (m)")


@check
def urdf_is_made_of_solid_primitives(subject: ArmUnderTest) -> Faults:
    """ArmModel.urdf: made of primitives; inertias and collision shapes are the real ones."""
    tree = UrdfTree(subject.arm.urdf())
    shapes = [shape for link in tree.root.findall("link") for shape in link.iterfind("collision/geometry/*")]
    yield from expect(shapes, "collision shapes", "none")
    kinds = {shape.tag for shape in shapes}
    yield from expect(kinds <= GEOMETRIES, f"collision shapes among {sorted(GEOMETRIES)}", str(sorted(kinds)))
    for name in (*subject.arm.fingers.links, *(joint.child for joint in tree.joints.values() if joint.kind != "fixed")):
        yield from _solid(tree, name)
    for name in subject.arm.fingers.links:
        link = tree.link_element(name)
        yield from expect(link is not None and link.find("collision") is not None, f"{name!r} with a shape", "none")


def _solid(tree: UrdfTree, name: str) -> Faults:
    link = tree.link_element(name)
    inertial = None if link is None else link.find("inertial")
    if inertial is None:
        yield from expect(False, f"an inertia of the moving link {name!r}", "none")
        return
    moments = np.linalg.eigvalsh(_inertia(inertial))
    mass = float(_get(inertial.find("mass"), "value"))
    sound = mass > 0.0 and (moments > 0.0).all() and moments[2] <= moments[:2].sum() * (1.0 + 1e-9)
    yield from expect(
        sound, f"{name!r} with a mass above 0 and moments that a body can have", f"{mass:g} kg, {moments}"
    )


def _inertia(inertial: ET.Element) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    element = inertial.find("inertia")
    xx, yy, zz, xy, xz, yz = (float(_get(element, key)) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz"))
    return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _get(element: ET.Element | None, key: str) -> str:
    return "nan" if element is None else element.get(key, "nan")


URDF_CHECKS: tuple[Check[ArmUnderTest], ...] = (
    urdf_is_one_tree,
    urdf_has_the_joints_and_links,
    urdf_moves_like_the_arm,
    urdf_fingers_open_sideways,
    urdf_is_made_of_solid_primitives,
)
