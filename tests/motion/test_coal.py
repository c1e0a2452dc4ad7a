"""The collision model: agrees with an engine that shares nothing with it, and does what it is told."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

pytest.importorskip("pinocchio")

from phframe.core import Condition, FloatArray, Scene, State, compose, inverse, planar_pose
from phframe.motion import coal_
from phframe.motion.coal_ import CollisionModel
from tests.motion.motions import MIDDLE, SHELF, baxter, cylinder, example

pytestmark = pytest.mark.needs_baxter

ARMS = {"left": baxter, "right": lambda: baxter("right"), "example": example}
SCENE = Scene("s", SHELF, (cylinder("near", 0.15, MIDDLE), cylinder("target", 0.4, MIDDLE - 0.1)), "target")


def model_of(arm: Any, scene: Scene = SCENE) -> CollisionModel:
    said = arm.description
    base_pose = arm.default_base_pose(scene.shelf)
    model = CollisionModel(arm.urdf(), said.joints, said.fingers, said.allowed_collisions, scene, base_pose)
    model.place(scene.initial_state())
    model.allow([])
    model.open(np.array([joint.lower for joint in arm.fingers.joints]))
    return model


def configurations(arm: Any, count: int) -> FloatArray:
    """Half of them anywhere within the limits, half near home, where shelf and objects are near."""
    lower, upper = np.array([[joint.lower, joint.upper] for joint in arm.joints]).T
    rng = np.random.default_rng(0)
    anywhere = rng.uniform(lower, upper, (count // 2, len(lower)))
    near = np.clip(arm.home + rng.normal(0.0, 0.3, (count - count // 2, len(lower))), lower, upper)
    return np.vstack([anywhere, near])


def reaching(arm: Any, x: float, y: float) -> FloatArray:
    """Joint values with the fingertip level at a place in the shelf."""
    base = inverse(arm.default_base_pose(SHELF).pose)
    q = arm.inverse(compose(base, planar_pose(x, y, arm.shape.height, 0.0)), arm.home)
    assert q is not None
    return np.asarray(q)


def met(model: CollisionModel, q: FloatArray) -> set[str]:
    return {second for _, second in model.collisions(q)}


@pytest.mark.needs_mujoco
@pytest.mark.parametrize("name", ARMS)
def test_it_agrees_with_mujoco(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("mujoco")
    from tests.motion.judge import Judge

    arm = ARMS[name]()
    kept = model_of(arm)
    monkeypatch.setattr(coal_, "WALL_MARGIN", 0.0)
    monkeypatch.setattr(coal_, "OBJECT_MARGIN", 0.0)
    model, judge = model_of(arm), Judge(arm, SCENE, arm.default_base_pose(SHELF))
    differing, verdicts = [], []
    for q in configurations(arm, 300):
        ours = {(min(pair), max(pair)) for pair in model.collisions(q)}
        theirs = judge.touching(q, arm.shape.min_opening)
        if ours != theirs:
            differing.append((ours ^ theirs, q))
        assert model.is_free(q) == (not ours)
        assert not theirs or not kept.is_free(q), "with margins, all the more"
        verdicts.append(model.is_free(q))
    assert len(differing) <= 1, differing  # what overlaps by less than rounding
    assert 30 < sum(verdicts) < 270


def test_objects_are_where_they_are_placed_and_touched_as_allowed() -> None:
    arm = example()
    model, start = model_of(arm), SCENE.initial_state()
    at_near = reaching(arm, 0.16, MIDDLE)
    assert "near" in met(model, at_near)
    assert not model.is_free(at_near)
    model.allow([0])
    assert model.is_free(at_near)
    model.allow([1])
    assert "near" in met(model, at_near)
    poses = start.poses.copy()
    poses[0, 1] += 0.2
    model.place(State(poses, start.conditions))
    assert model.is_free(at_near)
    model.place(State(start.poses, (Condition.SPILLED, Condition.UPRIGHT)))
    assert model.is_free(at_near), "what has spilled is in nobody's way"
    model.place(start)
    assert not model.is_free(at_near)


def test_open_fingers_take_more_room() -> None:
    arm = example()
    model = model_of(arm)
    beside = reaching(arm, 0.15, MIDDLE + 0.05)
    assert model.is_free(beside)
    model.open(np.array([joint.upper for joint in arm.fingers.joints]))
    assert met(model, beside) == {"near"}
    assert {first for first, _ in model.collisions(beside)} == {"right_finger"}


def test_margins_are_kept() -> None:
    arm = example()
    model, palm = model_of(arm, Scene("s", SHELF, (cylinder("target", 0.5, MIDDLE),), "target")), 0.11 / 2.0
    for gap, free in ((0.001, False), (0.003, True)):
        assert model.is_free(reaching(arm, 0.17, SHELF.width - palm - gap)) == free, gap
    for gap, free in ((0.0005, False), (0.002, True)):
        assert model.is_free(reaching(arm, 0.47 - gap, MIDDLE)) == free, gap


def test_what_touches_at_the_beginning_may_touch_no_deeper_and_only_meanwhile() -> None:
    arm = example()
    model = model_of(arm)
    touching, deeper, away = (reaching(arm, x, MIDDLE) for x in (0.122, 0.130, 0.110))
    wall = reaching(arm, 0.11, 0.05)
    assert met(model, touching) == {"near"}
    with model.tolerating(touching):
        assert model.is_free(touching)
        assert model.is_free(away)
        assert not model.is_free(deeper)
        assert not model.is_free(wall), "all else may not be touched"
    assert not model.is_free(touching)

    class OddError(Exception):
        pass

    with pytest.raises(OddError), model.tolerating(touching):
        raise OddError
    assert not model.is_free(touching)


def test_fingers_may_touch_one_another() -> None:
    """Closed, as they are drawn, they do."""
    arm = example()
    model = model_of(arm)
    assert arm.shape.min_opening == 0.0
    assert not [pair for pair in model.collisions(arm.home) if set(pair) == set(arm.fingers.links)]
