"""The compiled engine with the planar arm, for its tests."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import FloatArray, Scene, State, Transition
from phframe.testing import PhysicsUnderTest
from phframe.testing.physics.paths import CROWD_SWEEP, crowd
from phframe.testing.physics.stand import on_stand

ARM = PlanarArm(PlanarArmOptions())


def fast(scene: Scene, **options: Any) -> Any:
    """A new backend."""
    pytest.importorskip("numba")
    from phframe.backends.fast_.physics import FastOptions, FastPhysics

    return FastPhysics(scene, ARM, ARM.default_base_pose(scene.shelf), FastOptions(**options))


def subject(**options: Any) -> PhysicsUnderTest:
    """What the kit's test stand takes."""
    return PhysicsUnderTest(lambda scene, arm, _: fast(scene, **options), ARM, name="fast")


def swept() -> Transition:
    """What a sweep makes of the crowd."""
    with on_stand(subject(), crowd()) as stand:
        return stand.run(stand.start, CROWD_SWEEP)


def set_moving(physics: Any, row: int, velocity: tuple[float, float, float]) -> None:
    """Give an object a velocity (m/s, m/s, rad/s)."""
    from phframe.backends.fast_ import layout

    physics.world.bodies[row, layout.SPEEDS] = velocity
    physics.world.arm[layout.RESTING] = 0.0


def gripper(state: State) -> FloatArray:
    """Where the fingertip is."""
    assert state.arm is not None
    return np.asarray(state.arm.gripper)
