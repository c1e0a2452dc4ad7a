"""The checks of what a robot touches, on one whose collision shapes have no names, as those of most robots have none."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from phframe.registry import Kind, create, load
from phframe.testing import JOINTED, PHYSICS_CHECKS, Check, NotApplicableError, PhysicsUnderTest
from tests.backends.engines import each_engine

EXAMPLE = Path(__file__).parents[2] / "phframe" / "arms" / "example"
OF_CONTACTS = (
    "contacts_are_told_in_order",
    "stops_at_the_first_contact",
    "stops_at_a_wall",
    "walls_hold_the_arm",
    "a_grasped_target_comes_out",
)


@pytest.fixture
def nameless(tmp_path: Path) -> Any:
    """The example robot with the names of its collision shapes left out."""
    pytest.importorskip("pinocchio")
    text, found = re.subn(r'<collision name="[^"]*"', "<collision", (EXAMPLE / "robot.urdf").read_text())
    assert found > 5
    (tmp_path / "robot.urdf").write_text(text)
    (tmp_path / "arm.yaml").write_text((EXAMPLE / "arm.yaml").read_text())
    arm = create(Kind.ARM, "articulated", {"description": str(tmp_path / "arm.yaml")})
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
