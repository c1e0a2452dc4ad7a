"""The checks of what a robot touches, on one whose collision shapes have no names, as those of most robots have none."""

from __future__ import annotations

import re
from typing import Any

import pytest

from phframe.registry import Kind, load
from phframe.testing import JOINTED, PHYSICS_CHECKS, Check, NotApplicableError, PhysicsUnderTest
from tests.backends.engines import each_engine

OF_CONTACTS = (
    "contacts_are_told_in_order",
    "stops_at_the_first_contact",
    "stops_at_a_wall",
    "walls_hold_the_arm",
    "a_grasped_target_comes_out",
)


@pytest.fixture
def nameless() -> Any:
    """The example robot with the names of its collision shapes left out."""
    pytest.importorskip("pinocchio")
    example = load(Kind.ARM, "articulated")

    class Nameless(example):  # type: ignore[misc, valid-type]
        """Any robot but phframe's own."""

        def urdf(self) -> str:
            return re.sub(r'<collision name="[^"]*"', "<collision", super().urdf())

    arm = Nameless(example.options_type())
    assert arm.urdf().count("<collision>") > 5
    assert "<collision name" not in arm.urdf()
    return arm


@pytest.mark.needs_baxter
@each_engine
@pytest.mark.parametrize("check", [c for c in PHYSICS_CHECKS if c.name in OF_CONTACTS], ids=lambda check: check.name)
def test_a_robot_without_names_feels_what_it_touches(
    nameless: Any, engine: str, check: Check[PhysicsUnderTest]
) -> None:
    pytest.importorskip(engine)
    backend = load(Kind.BACKEND, engine)
    subject = PhysicsUnderTest(
        lambda scene, arm, base_pose: backend(scene, arm, base_pose, backend.options_type()),
        nameless,
        JOINTED,
        name=engine,
    )
    try:
        check(subject)
    except NotApplicableError as reason:
        pytest.skip(str(reason))
