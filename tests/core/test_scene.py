"""Scenes that cannot be say every reason, with the amounts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from phframe.core import (
    Condition,
    Cylinder,
    Scene,
    SceneError,
    SceneObject,
    Shelf,
    condition_of,
    coulomb_with_board,
    planar_pose,
)
from phframe.core.scene_check import CONTACT_TOLERANCE

SHELF = Shelf(0.6, 0.5)
A = SceneObject("a", Cylinder(0.03), (0.2, 0.2))
T = SceneObject("t", Cylinder(0.03), (0.4, 0.2))


def problems(*objects: SceneObject, shelf: Shelf = SHELF, target: str = "t") -> tuple[str, ...]:
    with pytest.raises(SceneError) as caught:
        Scene("bad", shelf, objects, target)
    assert str(caught.value).startswith("bad: ")
    return caught.value.problems


def at(x: float, y: float) -> SceneObject:
    return replace(A, position=(x, y))


@pytest.mark.parametrize(
    ("item", "problem"),
    [
        (at(0.2, 0.024), "object 'a' is 6.0 mm inside the south wall"),
        (at(0.2, 0.48), "object 'a' is 10.0 mm inside the north wall"),
        (at(0.575, 0.4), "object 'a' is 5.0 mm inside the back wall"),
        (at(-0.01, 0.2), "object 'a' is 10.0 mm outside the mouth with its centre"),
        (at(0.347, 0.2), "objects 'a' and 't' overlap by 7.0 mm"),
        (replace(A, shape=Cylinder(0.03, 0.5)), "object 'a' is 0.5 m tall; the shelf is 0.4 m high"),
        (replace(A, shape=Cylinder(0.0)), "object 'a': radius is 0; it must be a finite number above 0"),
        (replace(A, shape=Cylinder(0.03, -1.0)), "object 'a': height is -1; it must be a finite number above 0"),
        (replace(A, mass=float("inf")), "object 'a': mass is inf; it must be a finite number above 0"),
        (replace(A, friction=-0.1), "object 'a': friction is -0.1; it must be a finite number of 0 or more"),
        (replace(A, yaw=float("nan")), "object 'a': yaw is nan, not a finite number"),
        (at(float("inf"), 0.2), "object 'a': x is inf, not a finite number"),
        (replace(A, id="t"), "the id 't' is used 2 times; ids must be unique"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_a_problem_is_told_with_the_amount(item: SceneObject, problem: str) -> None:
    assert problems(item, T) == (problem,)


def test_a_friction_that_is_not_a_number_is_told() -> None:
    assert problems(replace(A, friction=float("nan")), T) == (
        "object 'a': friction is nan; it must be a finite number of 0 or more",
    )


def test_all_problems_are_told_at_once() -> None:
    found = problems(at(0.2, 0.02), replace(T, position=(0.59, 0.2)), replace(A, id="b", position=(0.21, 0.02)))
    assert len(found) == 4


def test_a_missing_target_is_told_with_what_there_is() -> None:
    assert problems(A, T, target="x") == ("the target 'x' is not among the objects: a, t",)
    assert problems(target="x") == ("the target 'x' is not among the objects: there are none",)


@pytest.mark.parametrize("name", ["depth", "width", "height", "board_friction", "wall_friction"])
def test_bad_shelves_are_told(name: str) -> None:
    (found,) = problems(A, T, shelf=replace(SHELF, **{name: -1.0}))
    assert found.startswith(f"shelf {name} is -1; it must be a finite number")


def test_touching_is_no_problem() -> None:
    scene = Scene(
        "touching", SHELF, (at(0.34 + CONTACT_TOLERANCE / 2.0, 0.2), T, replace(A, id="w", position=(0.2, 0.03))), "t"
    )
    assert scene.ids == ("a", "t", "w")


def test_a_scene_knows_its_rows() -> None:
    scene = Scene("two", SHELF, (A, replace(T, friction=0.4)), "t")
    assert (scene.target_index, scene.index("a")) == (1, 0)
    with pytest.raises(SceneError, match="two: no object 'x'; there is: a, t"):
        scene.index("x")
    assert [coulomb_with_board(scene, item) for item in scene.objects] == [0.25, 0.4]
    state = scene.initial_state()
    np.testing.assert_allclose(state.poses[:, :3], [[0.2, 0.2, 0.06], [0.4, 0.2, 0.06]])
    assert state.on_board.tolist() == [True, True]
    assert state.arm is None


TOPPLED = np.array([0.2, 0.2, 0.03, np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])


@pytest.mark.parametrize(
    ("pose", "held", "condition"),
    [
        (planar_pose(0.2, 0.2, 0.06), False, Condition.UPRIGHT),
        (planar_pose(-0.01, 0.2, 0.06), False, Condition.SPILLED),
        (planar_pose(-0.01, 0.2, 0.06), True, Condition.UPRIGHT),
        (planar_pose(0.2, 0.2, -0.3), False, Condition.SPILLED),
        (TOPPLED, False, Condition.TOPPLED),
        (TOPPLED, True, Condition.TOPPLED),
    ],
    ids=["stands", "before the mouth", "in the hand", "below", "lies", "lies in the hand"],
)
def test_conditions(pose: np.ndarray, held: bool, condition: Condition) -> None:
    assert condition_of(pose, held=held) is condition
