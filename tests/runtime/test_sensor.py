"""What a robot sees is off by as much as was asked for, and could be true."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import ArmState, Condition, Cylinder, Scene, SceneObject, Shelf, State, rotation_matrix
from phframe.core.scene_check import problems_of
from phframe.runtime.noise import Noise
from phframe.runtime.scenes import find_scene, scene_names
from phframe.runtime.sensor import Sensor
from tests.runtime.worlds import BASIC

SHAPE = PlanarArm(PlanarArmOptions()).shape
PUBLISHED = [name for name in scene_names() if name.startswith(("vieira", "papallas"))]


def sensor(scene: Scene, position: float, seed: int = 0) -> Sensor:
    return Sensor(Noise(position=position), scene, SHAPE, seed)


def as_seen(scene: Scene, seen: State) -> list[str]:
    """What would be wrong with the scene, were it as it is seen."""
    pairs = zip(scene.objects, seen.positions, strict=True)
    moved = [replace(item, position=(float(x), float(y))) for item, (x, y) in pairs]
    return problems_of(scene.name, scene.shelf, moved, scene.target, {})


@given(st.sampled_from(PUBLISHED), st.sampled_from([0.001, 0.005, 0.02, 0.05]), st.integers(0, 1000))
def test_what_is_seen_could_be_a_scene(name: str, position: float, seed: int) -> None:
    scene = find_scene(name)
    seen = sensor(scene, position, seed).see(scene.initial_state())
    assert as_seen(scene, seen) == []
    assert (seen.positions != scene.initial_state().positions).any()
    assert (seen.poses[:, 2:] == scene.initial_state().poses[:, 2:]).all()


def test_with_room_around_it_errors_are_gaussian_of_that_size_and_new_every_time() -> None:
    shelf = Shelf(0.6, 0.6)
    alone = Scene("alone", shelf, (SceneObject("a", Cylinder(0.03), (0.3, 0.3)),), "a")
    look, state = sensor(alone, 0.005), alone.initial_state()
    errors = np.array([look.see(state).positions[0] - (0.3, 0.3) for _ in range(2000)])
    assert errors.std(axis=0) == pytest.approx([0.005, 0.005], rel=0.05)
    assert errors.mean(axis=0) == pytest.approx([0.0, 0.0], abs=4e-4)
    assert abs(np.corrcoef(errors.T)[0, 1]) < 0.06


def test_the_same_seed_sees_the_same() -> None:
    state = BASIC.initial_state()
    one, two, other = (sensor(BASIC, 0.005, seed) for seed in (3, 3, 4))
    first = one.see(state)
    assert first == two.see(state)
    assert first != other.see(state)
    assert first != one.see(state)


def test_without_errors_every_state_is_seen_as_it_is() -> None:
    state = BASIC.initial_state()
    assert sensor(BASIC, 0.0).see(state) is state


def test_what_has_left_the_board_or_is_held_is_seen_as_it_is() -> None:
    gone = (Condition.SPILLED, *BASIC.initial_state().conditions[1:])
    arm = ArmState(np.array([-0.05, 0.3, 0.0]), 0.06)
    state = replace(BASIC.initial_state(), conditions=gone, held=BASIC.ids[1], arm=arm)
    seen = sensor(BASIC, 0.01).see(state)
    assert (seen.poses[:2] == state.poses[:2]).all()
    assert (seen.positions[2:] != state.positions[2:]).all()
    assert (seen.conditions, seen.held, seen.arm) == (state.conditions, state.held, state.arm)


@given(st.integers(0, 500), st.floats(-1.5, 1.5))
def test_nothing_is_seen_inside_the_arm(seed: int, yaw: float) -> None:
    shelf = Shelf(0.6, 0.6)
    spot = np.array([0.3, 0.3]) + rotation_matrix(yaw) @ np.array([0.032, 0.0])  # just ahead of the closed fingers
    near = Scene("near", shelf, (SceneObject("a", Cylinder(0.03), (float(spot[0]), float(spot[1]))),), "a")
    state = replace(near.initial_state(), arm=ArmState(np.array([0.3, 0.3, yaw]), SHAPE.min_opening))
    seen = sensor(near, 0.02, seed).see(state).positions[0]
    local = (seen - (0.3, 0.3)) @ rotation_matrix(yaw)
    for outline in SHAPE.closed:
        low, high = outline.vertices.min(axis=0), outline.vertices.max(axis=0)
        if len(outline.vertices) == 4:  # a rectangle along the axes of the fingertip frame
            assert np.linalg.norm(local - np.clip(local, low, high)) >= 0.03 - 1e-12


def test_what_really_overlaps_is_seen_no_deeper() -> None:
    """Engines let what presses on each other overlap a little."""
    shelf = Shelf(0.6, 0.6)
    items = tuple(SceneObject(name, Cylinder(0.03), (0.3, y)) for name, y in (("a", 0.2), ("b", 0.26)))
    scene = Scene("touching", shelf, items, "a")
    poses = scene.initial_state().poses.copy()
    poses[1, 1] -= 1e-4
    state, look = replace(scene.initial_state(), poses=poses), sensor(scene, 0.003)
    for _ in range(200):
        seen = look.see(state).positions
        assert np.linalg.norm(seen[0] - seen[1]) >= 0.06 - 1e-4 - 1e-12
