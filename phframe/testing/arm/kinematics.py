"""Checks of an arm's joints, its forward and its inverse kinematics."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from phframe.core import ArmError, FloatArray, compose, inverse, planar_pose
from phframe.testing.check import Check, Faults, check
from phframe.testing.expect import expect, expect_close, expect_equal, expect_raises
from phframe.testing.subjects import ArmUnderTest
from phframe.testing.tolerances import FORWARD


@check
def joints_make_sense(subject: ArmUnderTest) -> Faults:
    """Joint: a name unique within the arm, the least value below the greatest, a speed and an effort above 0."""
    joints = (*subject.arm.joints, *subject.arm.fingers.joints)
    names = [joint.name for joint in joints]
    yield from expect(len(set(names)) == len(names), "unique names of joints", ", ".join(names))
    yield from expect(len(subject.arm.joints) > 0, "at least one joint", "none")
    for joint in joints:
        figures = np.array([joint.lower, joint.upper, joint.velocity, joint.effort])
        sound = np.isfinite(figures).all() and joint.lower < joint.upper and (figures[2:] > 0.0).all()
        yield from expect(sound, "finite limits, lower < upper, speed and effort above 0", str(joint))
    yield from expect(subject.arm.force_limit > 0.0, "a force limit above 0 N", f"{subject.arm.force_limit:g} N")


@check
def home_is_within_limits(subject: ArmUnderTest) -> Faults:
    """ArmModel.home: joint values (dof,) of the parked arm."""
    home = np.asarray(subject.arm.home)
    dof = len(subject.arm.joints)
    if home.shape != (dof,):
        yield from expect_equal(home.shape, (dof,), "the shape of home")
        return
    yield from expect(subject.arm.within_limits(home), "home within the joint limits", str(home))


@check
def forward_gives_unit_poses(subject: ArmUnderTest) -> Faults:
    """ArmModel.forward: pose (7,), x y z and a unit quaternion."""
    for q in subject.joint_values():
        pose = np.asarray(subject.arm.forward(q))
        sound = pose.shape == (7,) and np.isfinite(pose).all() and abs(np.linalg.norm(pose[3:]) - 1.0) < 1e-9
        yield from expect(sound, f"seven finite numbers, the last four of length 1, for q = {q}", str(pose))


@check
def kinematics_are_stateless(subject: ArmUnderTest) -> Faults:
    """ArmModel: stateless, so the same joint values, or pose and seed, give the same bits; arguments are not changed."""
    arm, samples = subject.arm, subject.joint_values()
    before = samples.tobytes()
    poses = [np.asarray(arm.forward(q)) for q in samples]
    solved = [arm.inverse(pose, q) for pose, q in zip(poses, samples, strict=True)]
    for q, pose, solution in reversed(list(zip(samples, poses, solved, strict=True))):
        again, solved_again = np.asarray(arm.forward(q)), arm.inverse(pose, q)
        yield from expect(again.tobytes() == pose.tobytes(), f"forward({q}) as before: {pose}", str(again))
        yield from expect(_same(solved_again, solution), f"inverse({pose}) as before: {solution}", str(solved_again))
    yield from expect(samples.tobytes() == before, "joint values unchanged by forward and inverse", "other numbers")


@check
def inverse_undoes_forward(subject: ArmUnderTest) -> Faults:
    """ArmModel.inverse: joint values that put the fingertip at the pose, near the seed; None only if there are none."""
    for q in subject.joint_values():
        pose = subject.arm.forward(q)
        found = subject.arm.inverse(pose, q)
        yield from expect(found is not None, f"joint values for the pose of q = {q}, seeded with q", "None")
        if found is not None:
            yield from _expect_same_pose(subject.arm.forward(found), pose, f"forward(inverse(forward(q))) for q = {q}")


@check
def inverse_tells_the_truth_without_a_seed(subject: ArmUnderTest) -> Faults:
    """ArmModel.inverse: whatever it returns puts the fingertip at the pose."""
    for q in subject.joint_values():
        pose = subject.arm.forward(q)
        found = subject.arm.inverse(pose)
        if found is not None:
            yield from _expect_same_pose(subject.arm.forward(found), pose, f"forward(inverse(pose)) for q = {q}")


@check
def inverse_knows_a_pose_by_either_quaternion(subject: ArmUnderTest) -> Faults:
    """ArmModel.inverse: a quaternion and its negative are the same turn."""
    for q in subject.joint_values():
        pose = np.asarray(subject.arm.forward(q))
        found = subject.arm.inverse(np.concatenate([pose[:3], -pose[3:]]), q)
        yield from expect(found is not None, f"joint values for the pose of q = {q} with -quaternion", "None")
        if found is not None:
            yield from _expect_same_pose(subject.arm.forward(found), pose, f"the pose of q = {q}")


@check
def inverse_respects_limits(subject: ArmUnderTest) -> Faults:
    """ArmModel.inverse: joint values within limits."""
    lower, upper = np.array([[joint.lower, joint.upper] for joint in subject.arm.joints]).T
    for q in subject.joint_values():
        beyond = np.where(q > (lower + upper) / 2.0, upper + 0.1, lower - 0.1)
        for values in (q, beyond):
            found = subject.arm.inverse(subject.arm.forward(values), q)
            within = found is None or subject.arm.within_limits(found)
            yield from expect(within, f"None, or joint values within limits, for the pose of q = {values}", str(found))


@check
def inverse_says_no_out_of_reach(subject: ArmUnderTest) -> Faults:
    """ArmModel.inverse: None where there are no joint values."""
    for far in (planar_pose(100.0, 0.0), planar_pose(0.0, -100.0), planar_pose(0.0, 0.0, 100.0)):
        found = subject.arm.inverse(far)
        yield from expect(found is None, f"None for a pose 100 m away, {far[:3]}", str(found))


@check
def bad_joint_values_are_refused(subject: ArmUnderTest) -> Faults:
    """ArmModel.forward raises ArmError if q has the wrong length or is not finite."""
    home = np.array(subject.arm.home, dtype=np.float64)
    not_a_number, infinite = home.copy(), home.copy()
    not_a_number[0], infinite[-1] = np.nan, np.inf
    bad: dict[str, ArrayLike] = {
        "no joint values": [],
        "too many joint values": [*home, 0.0],
        "too few joint values": home[:-1],
        "a joint value that is not a number": not_a_number,
        "an infinite joint value": infinite,
    }
    for what, values in bad.items():
        yield from expect_raises(ArmError, partial(subject.arm.forward, values), what)


@check
def bad_poses_are_refused(subject: ArmUnderTest) -> Faults:
    """ArmModel.inverse raises ArmError if the pose has the wrong length or is not finite."""
    pose = np.array(subject.arm.forward(subject.arm.home))
    not_a_number = pose.copy()
    not_a_number[1] = np.nan
    for what, values in {"a pose of six numbers": pose[:6], "a pose that is not a number": not_a_number}.items():
        yield from expect_raises(ArmError, partial(subject.arm.inverse, values), what)


@check
def default_base_pose_lets_it_reach_in(subject: ArmUnderTest) -> Faults:
    """ArmModel.default_mount: where the base stands for a shelf, so that the gripper gets to the middle of it."""
    arm, shelf = subject.arm, subject.shelf
    base = inverse(arm.default_base_pose(shelf).pose)
    for fraction in (0.1, 0.3, 0.5):
        wanted = planar_pose(fraction * shelf.depth, shelf.width / 2.0, arm.shape.height)
        found = arm.inverse(compose(base, wanted), arm.home)
        yield from expect(found is not None, f"joint values for the fingertip at {wanted[:3]} in the shelf", "None")


def _expect_same_pose(found: ArrayLike, wanted: ArrayLike, what: str) -> Faults:
    a, b = np.asarray(found), np.asarray(wanted)
    turned = a * np.array([1.0, 1.0, 1.0, *[np.sign(a[3:] @ b[3:])] * 4])
    yield from expect_close(turned, b, FORWARD, what)


def _same(a: FloatArray | None, b: FloatArray | None) -> bool:
    if a is None or b is None:
        return a is b
    return np.asarray(a).tobytes() == np.asarray(b).tobytes()


KINEMATICS_CHECKS: tuple[Check[ArmUnderTest], ...] = (
    joints_make_sense,
    home_is_within_limits,
    forward_gives_unit_poses,
    kinematics_are_stateless,
    inverse_undoes_forward,
    inverse_tells_the_truth_without_a_seed,
    inverse_knows_a_pose_by_either_quaternion,
    inverse_respects_limits,
    inverse_says_no_out_of_reach,
    bad_joint_values_are_refused,
    bad_poses_are_refused,
    default_base_pose_lets_it_reach_in,
)
