"""What is particular to the MuJoCo backend; what it shares is in test_joints.py, the interface in tests/conformance."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from phframe.core import ArmState
from phframe.testing.physics.paths import MIDDLE, cylinder, drive_in, scene_of
from phframe.testing.physics.stand import on_stand
from tests.backends.engines import ARM, TARGET, physics, slide, subject

mujoco = pytest.importorskip("mujoco")
pytestmark = pytest.mark.needs_mujoco


@pytest.mark.parametrize(
    ("cone", "angle"), [("elliptic", 0.0), ("elliptic", 30.0), ("elliptic", 45.0), ("pyramidal", 0.0)]
)
@pytest.mark.parametrize(("friction", "speed"), [(0.15, 0.2), (0.25, 0.5), (0.4, 0.5)])
def test_what_slides_stops_where_coulomb_says(cone: str, angle: float, friction: float, speed: float) -> None:
    """In every direction; a pyramid is Coulomb's cone along its edges only."""
    backend = physics("mujoco", scene_of(cylinder("o", 0.2, MIDDLE, friction=friction), TARGET), cone=cone)
    way, direction = slide(backend, speed, angle)
    assert way == pytest.approx(speed**2 / (2.0 * friction * 9.81), rel=0.03)
    assert direction == pytest.approx(angle, abs=1.0)


def test_the_force_told_is_that_of_the_contacts() -> None:
    with on_stand(subject("mujoco"), scene_of(cylinder("load", 0.2, MIDDLE, mass=3.0, friction=0.5))) as stand:
        stand.physics.restore(stand.start)
        stand.physics.execute(stand.trajectory(stand.start, drive_in(0.22, speed=0.1)), settle=None)
        engine = stand.physics.world.engine  # type: ignore[attr-defined]
        total = np.zeros(3)
        for row, contact in enumerate(engine.data.contact):
            one, other = (engine.model.is_arm[geom] for geom in contact.geom)
            if one != other:
                force = np.zeros(6)
                mujoco.mj_contactForce(engine.model.mj, engine.data, row, force)
                total += (1.0 if other else -1.0) * contact.frame.reshape(3, 3).T @ force[:3]
        count, *told = engine.data.sensordata
        assert count > 0
        assert np.linalg.norm(total) > 10.0
        assert np.allclose(np.abs(told), np.abs(total), rtol=1e-6, atol=1e-6)


@pytest.mark.parametrize("angle", [10.0, 30.0, 45.0, 60.0, 80.0])
@pytest.mark.parametrize("depth", [1e-4, 1e-3])
def test_an_edge_pushes_towards_the_axis(angle: float, depth: float) -> None:
    """Contacts of a finger's edge with a cylinder; with MuJoCo's own convex collision they point along the finger."""
    turned = math.radians(angle)
    corner = np.array([0.2, MIDDLE + ARM.options.insertion_width / 2.0])
    away = np.array([math.cos(turned), math.sin(turned)])
    center = corner + (0.03 - depth) * away
    backend = physics("mujoco", scene_of(cylinder("o", float(center[0]), float(center[1])), TARGET))
    arm = ArmState(np.array([0.2, MIDDLE, 0.0]), 0.0)
    backend.restore(replace(backend.scene.initial_state(), arm=arm))
    engine = backend.world.engine
    mujoco.mj_forward(engine.model.mj, engine.data)
    pushes = [
        contact.frame[:3] * (1.0 if engine.model.is_arm[contact.geom[0]] else -1.0)
        for contact in engine.data.contact
        if engine.model.is_arm[contact.geom[0]] != engine.model.is_arm[contact.geom[1]]
    ]
    assert pushes
    for push in pushes:
        assert math.degrees(math.atan2(push[1], push[0])) == pytest.approx(angle, abs=3.0)
