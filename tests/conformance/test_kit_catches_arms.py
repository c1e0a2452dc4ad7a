"""Every check of arms finds an arm that breaks its promise."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cached_property

import numpy as np
import pytest
from numpy.typing import ArrayLike

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import ArmShape, BasePose, Fingers, FloatArray, Joint, Outline, Shelf
from phframe.testing import ARM_CHECKS, ArmUnderTest, Check, ConformanceError, check_arm


class NamesTwice(PlanarArm):
    @property
    def joints(self) -> tuple[Joint, ...]:
        return tuple(replace(joint, name="joint") for joint in super().joints)


class HomeFarAway(PlanarArm):
    @property
    def home(self) -> FloatArray:
        return np.array([0.0, 7.0, 0.0])


class LongQuaternions(PlanarArm):
    def forward(self, q: ArrayLike) -> FloatArray:
        pose = super().forward(q)
        return np.concatenate([pose[:3], 2.0 * pose[3:]])


class Wanders(PlanarArm):
    asked = 0

    def forward(self, q: ArrayLike) -> FloatArray:
        self.asked += 1
        return np.asarray(super().forward(q) + np.array([self.asked * 1e-12, 0, 0, 0, 0, 0, 0]))


class GivesUp(PlanarArm):
    def inverse(self, pose: ArrayLike, seed: ArrayLike | None = None) -> FloatArray | None:
        return None


class GuessesWithoutASeed(PlanarArm):
    def inverse(self, pose: ArrayLike, seed: ArrayLike | None = None) -> FloatArray | None:
        return self.home if seed is None else super().inverse(pose, seed)


class OneQuaternionOnly(PlanarArm):
    def inverse(self, pose: ArrayLike, seed: ArrayLike | None = None) -> FloatArray | None:
        return None if np.asarray(pose)[3] < 0.0 else super().inverse(pose, seed)


class IgnoresLimits(PlanarArm):
    def inverse(self, pose: ArrayLike, seed: ArrayLike | None = None) -> FloatArray | None:
        x, y, _, w, _, _, z = np.asarray(pose, dtype=np.float64)
        return np.array([x, y, 2.0 * math.atan2(z, w)])


class AlwaysFinds(PlanarArm):
    def inverse(self, pose: ArrayLike, seed: ArrayLike | None = None) -> FloatArray | None:
        found = super().inverse(pose, seed)
        return self.home if found is None else found


class TakesAnything(PlanarArm):
    def forward(self, q: ArrayLike) -> FloatArray:
        values = np.nan_to_num(np.asarray(q, dtype=np.float64), posinf=0.0)
        return super().forward(np.resize(values, 3))

    def inverse(self, pose: ArrayLike, seed: ArrayLike | None = None) -> FloatArray | None:
        values = np.asarray(pose, dtype=np.float64)
        return super().inverse(values, seed) if values.shape == (7,) and np.isfinite(values).all() else None


class StandsFarAway(PlanarArm):
    def default_base_pose(self, shelf: Shelf) -> BasePose:
        return BasePose(-30.0, 0.0, 0.0, 0.0)


class StandsInside(PlanarArm):
    def default_base_pose(self, shelf: Shelf) -> BasePose:
        return BasePose(0.2, shelf.width / 2.0, 0.06, 0.0)


class Reshaped(PlanarArm):
    """An arm whose outlines are altered."""

    @cached_property
    def shape(self) -> ArmShape:
        shape = PlanarArm(self.options).shape
        return replace(shape, closed=tuple(self.altered(outline) for outline in shape.closed))

    def altered(self, outline: Outline) -> Outline:
        return outline


class Clockwise(Reshaped):
    def altered(self, outline: Outline) -> Outline:
        return replace(outline, vertices=outline.vertices[::-1])


class AheadOfItself(Reshaped):
    def altered(self, outline: Outline) -> Outline:
        return replace(outline, vertices=outline.vertices + np.array([0.03, 0.0]))


class Wider(Reshaped):
    def altered(self, outline: Outline) -> Outline:
        return replace(outline, vertices=outline.vertices * np.array([1.0, 1.2]))


class OneFingerMoves(Reshaped):
    def altered(self, outline: Outline) -> Outline:
        return replace(outline, side=max(outline.side, 0))


class OpensTooFar(ArmShape):
    __slots__ = ()

    def outlines(self, opening: float) -> tuple[Outline, ...]:
        return self.closed


class OpensAnyhow(PlanarArm):
    @cached_property
    def shape(self) -> ArmShape:
        shape = PlanarArm(self.options).shape
        return OpensTooFar(shape.closed, shape.link_width, shape.insertion_width, shape.max_opening)


class ShortFingers(PlanarArm):
    @property
    def fingers(self) -> Fingers:
        fingers = super().fingers
        left, right = (replace(joint, upper=0.5 * joint.upper) for joint in fingers.joints)
        return Fingers((left, right), fingers.links)


class Rewritten(PlanarArm):
    """An arm whose URDF is altered."""

    old, new = "", ""

    def urdf(self) -> str:
        text = super().urdf()
        assert self.old in text
        return text.replace(self.old, self.new)


class TwoBases(Rewritten):
    old, new = "</robot>", '<link name="lost"/></robot>'


class OtherNames(Rewritten):
    old, new = '"left_finger_link"', '"claw"'


class OtherAxis(Rewritten):
    old, new = '<axis xyz="1.0 0.0 0.0" />', '<axis xyz="0.0 0.0 1.0" />'


class FingersUpwards(Rewritten):
    old, new = '<axis xyz="0.0 -1.0 0.0" />', '<axis xyz="0 0 1" />'


class Weightless(Rewritten):
    old, new = "<mass value=", "<mass was="


BROKEN: dict[str, type[PlanarArm]] = {
    "joints_make_sense": NamesTwice,
    "home_is_within_limits": HomeFarAway,
    "forward_gives_unit_poses": LongQuaternions,
    "kinematics_are_stateless": Wanders,
    "inverse_undoes_forward": GivesUp,
    "inverse_tells_the_truth_without_a_seed": GuessesWithoutASeed,
    "inverse_knows_a_pose_by_either_quaternion": OneQuaternionOnly,
    "inverse_respects_limits": IgnoresLimits,
    "inverse_says_no_out_of_reach": AlwaysFinds,
    "bad_joint_values_are_refused": TakesAnything,
    "bad_poses_are_refused": TakesAnything,
    "default_base_pose_lets_it_reach_in": StandsFarAway,
    "outlines_are_convex_and_counter_clockwise": Clockwise,
    "origin_is_at_the_tip": AheadOfItself,
    "widths_are_those_of_the_outlines": Wider,
    "opening_moves_each_finger_by_half": OneFingerMoves,
    "fingers_open_as_far_as_their_joints_let_them": ShortFingers,
    "openings_out_of_range_are_refused": OpensAnyhow,
    "home_is_outside_the_shelf": StandsInside,
    "urdf_is_one_tree": TwoBases,
    "urdf_has_the_joints_and_links": OtherNames,
    "urdf_moves_like_the_arm": OtherAxis,
    "urdf_fingers_open_sideways": FingersUpwards,
    "urdf_is_made_of_solid_primitives": Weightless,
}


@pytest.mark.parametrize("check", ARM_CHECKS, ids=lambda check: check.name)
def test_every_check_can_fail(check: Check[ArmUnderTest]) -> None:
    arm = BROKEN[check.name](PlanarArmOptions())
    with pytest.raises(ConformanceError) as caught:
        check(ArmUnderTest(arm))
    assert caught.value.failures[0].check == check.name
    assert "no exception" not in str(caught.value)


def test_an_exception_is_a_finding_with_its_place() -> None:
    class Crashes(PlanarArm):
        def forward(self, q: ArrayLike) -> FloatArray:
            raise ZeroDivisionError("no reason")

    with pytest.raises(ConformanceError, match=r"ZeroDivisionError: no reason \(test_kit_catches_arms.py, line \d+\)"):
        check_arm(Crashes(PlanarArmOptions()))
