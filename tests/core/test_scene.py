"""Scenes that cannot be say every reason, with the amounts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from phframe.core import (
    BasePose,
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
from phframe.core.scene_limits import MOST_OBJECTS

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


def test_what_engines_leave_in_contact_is_touching_and_no_more() -> None:
    rim = 0.4 - 0.06 + CONTACT_TOLERANCE
    tall = replace(T, shape=Cylinder(0.03, SHELF.height + CONTACT_TOLERANCE / 2.0))
    Scene("pressed", SHELF, (at(rim - 1e-6, 0.2), tall, replace(A, id="w", position=(0.2, 0.0291))), "t")
    assert problems(at(rim + 1e-6, 0.2), T) == ("objects 'a' and 't' overlap by 1.0 mm",)
    assert problems(replace(T, shape=Cylinder(0.03, SHELF.height + 2 * CONTACT_TOLERANCE))) == (
        "object 't' is 0.402 m tall; the shelf is 0.4 m high",
    )


@pytest.mark.parametrize(
    ("item", "problem"),
    [
        (replace(A, mass=1e-20), "object 'a': mass is 1e-20 kg; the least is 0.001 kg: engines"),
        (replace(A, mass=1e20), "object 'a': mass is 1e+20 kg; the most is 1000 kg: no arm"),
        (replace(A, friction=1e9), "object 'a': friction is 1e+09; the most is 10: "),
        (replace(A, shape=Cylinder(1e-9)), "object 'a': radius is 1e-09 m; the least is 0.001 m: "),
        (replace(A, shape=Cylinder(0.03, 1e9)), "object 'a': height is 1e+09 m; the most is 10 m: "),
        (replace(A, yaw=1e300), "object 'a': yaw is 1e+300; headings (rad) are from -100 to 100"),
    ],
)
def test_what_engines_do_not_bear_is_refused_with_the_reason(item: SceneObject, problem: str) -> None:
    (found,) = problems(item, T)
    assert found.startswith(problem)


@pytest.mark.parametrize("name", ["depth", "width", "height"])
@pytest.mark.parametrize("figure", [1e-6, 1000.0])
def test_a_shelf_is_of_the_size_of_one(name: str, figure: float) -> None:
    (found,) = problems(A, T, shelf=replace(SHELF, **{name: figure}))
    assert found.startswith(f"shelf {name} is {figure:g} m; the ")


def test_of_many_problems_ten_are_told_and_the_others_not_looked_for() -> None:
    crowd = [replace(A, id=f"o{number}") for number in range(MOST_OBJECTS - 1)]
    found = problems(*crowd, T)
    assert (len(found), found[0], found[-1]) == (11, "objects 'o0' and 'o1' overlap by 60.0 mm", "and more")
    (refused,) = problems(*crowd, T, replace(A, id="one more"))
    assert refused.startswith("it has 1001 objects; at most 1000")


@pytest.mark.parametrize(
    "bad",
    ["", " a", "a\nb", "x" * 101, "\u202e", "\ud800", "\x1b[2J", "a" * 10**6],
    ids=lambda bad: bad[:9].encode("ascii", "backslashreplace").hex(),
)
def test_names_are_short_lines_that_can_be_shown(bad: str) -> None:
    named: list[tuple[str, SceneObject, dict[str, BasePose]]] = [
        (bad, T, {}),
        ("s", replace(T, id=bad), {}),
        ("s", T, {bad: BasePose(0.0, 0.0, 0.0, 0.0)}),
    ]
    for name, item, base_poses in named:
        with pytest.raises(SceneError) as caught:
            Scene(name, SHELF, (item,), item.id, base_poses)
        assert str(caught.value).isprintable()
        assert len(str(caught.value)) < 400


@pytest.mark.parametrize("figure", [1e300, float("nan")])
def test_a_base_stands_near_the_shelf(figure: float) -> None:
    with pytest.raises(SceneError, match="base pose of 'planar': "):
        Scene("s", SHELF, (T,), "t", {"planar": BasePose(figure, 0.0, 0.0, 0.0)})


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
