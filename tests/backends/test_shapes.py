"""Every engine refuses a shape that it has no primitive for, instead of taking it for another."""

from __future__ import annotations

import pytest

from phframe.core import UnknownShapeError
from tests.backends.engines import ARM, each_engine, physics
from tests.prism import SCENE


@each_engine
def test_engines_of_joints_refuse_an_unknown_shape(engine: str) -> None:
    with pytest.raises(UnknownShapeError, match="backend has no primitive for the shape 'prism'"):
        physics(engine, SCENE).restore(SCENE.initial_state())


def test_pymunk_refuses_an_unknown_shape() -> None:
    from phframe.backends.pymunk_.physics import PymunkOptions, PymunkPhysics

    backend = PymunkPhysics(SCENE, ARM, ARM.default_base_pose(SCENE.shelf), PymunkOptions())
    with pytest.raises(UnknownShapeError, match="the pymunk backend"):
        backend.restore(SCENE.initial_state())
