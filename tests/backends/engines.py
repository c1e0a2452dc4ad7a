"""The engines in space, by name, for tests of what they have in common and of what is particular to one."""

from __future__ import annotations

import math
from importlib import import_module
from typing import Any

import numpy as np
import pytest

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import Scene, State
from phframe.runtime.scenes import scene_names
from phframe.testing import SPATIAL, PhysicsUnderTest
from phframe.testing.physics.paths import CROWD_SWEEP, crowd, cylinder
from phframe.testing.physics.stand import on_stand

ARM = PlanarArm(PlanarArmOptions())
TARGET = cylinder("target", 0.5, 0.5)
PUBLISHED = [name for name in scene_names() if name.startswith(("vieira", "papallas"))]
CLASSES = {"mujoco": "MujocoPhysics", "pybullet": "PybulletPhysics"}

each_engine = pytest.mark.parametrize(
    "engine", [pytest.param(name, marks=getattr(pytest.mark, f"needs_{name}")) for name in CLASSES]
)


def physics(engine: str, scene: Scene, arm: Any = ARM, **options: Any) -> Any:
    """A new backend with an arm at its default base pose."""
    pytest.importorskip(engine)
    backend = getattr(import_module(f"phframe.backends.{engine}_.physics"), CLASSES[engine])
    return backend(scene, arm, arm.default_base_pose(scene.shelf), backend.options_type(**options))


def subject(engine: str, **options: Any) -> PhysicsUnderTest:
    """What the kit's test stand takes."""
    return PhysicsUnderTest(lambda scene, arm, _: physics(engine, scene, arm, **options), ARM, SPATIAL, name=engine)


def swept(engine: str, **options: Any) -> Any:
    """What a sweep makes of the crowd."""
    with on_stand(subject(engine, **options), crowd()) as stand:
        return stand.run(stand.start, CROWD_SWEEP)


def let_be(backend: Any, seconds: float) -> State:
    """The world after nobody did anything for a while."""
    world = backend.world
    for tick in range(round(seconds / world.engine.period)):
        world.engine.advance()
        if tick % 10 == 0:
            world.survey()
    state: State = backend.observe()
    return state


def slide(backend: Any, speed: float, angle: float) -> tuple[float, float]:
    """How far (m) and where to (degrees) the first object slides when let go at a speed (m/s) in a direction (degrees)."""
    backend.restore(backend.scene.initial_state())
    before, turned = let_be(backend, 0.1).positions[0], math.radians(angle)
    set_moving(backend, 0, (speed * math.cos(turned), speed * math.sin(turned), 0.0))
    x, y = let_be(backend, 1.0).positions[0] - before
    return math.hypot(x, y), math.degrees(math.atan2(y, x))


def set_moving(backend: Any, row: int, velocity: Any) -> None:
    """Give an object that is awake a velocity (m/s)."""
    engine = backend.world.engine
    if engine.name == "mujoco":
        engine.data.qvel[engine.model.moving[row][:3]] = velocity
    else:
        from phframe.backends.pybullet_.output_capture import bullet

        straight = np.asarray(velocity, dtype=float).tolist()
        bullet.resetBaseVelocity(engine.bodies.objects[row], straight, [0.0] * 3, physicsClientId=engine.client)
