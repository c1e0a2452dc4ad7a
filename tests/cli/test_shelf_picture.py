"""The shelf in letters: everything is where it is, at any size."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from phframe.cli.advice import parse_hint
from phframe.cli.shelf_picture import labels, shelf_picture
from phframe.core import Condition, Hint, Question, SceneObject
from phframe.runtime.scenes import find_scene
from tests.pushing.parts import scene_of

SCENE = scene_of((0.4, 0.3), (0.1, 0.1), (0.2, 0.3), (0.2, 0.5))
QUESTION = Question(SCENE, SCENE.initial_state(), "o1", np.array([[0, 0.18], [0.4, 0.18], [0.4, 0.42], [0, 0.42]]))


def drawn(question: Question = QUESTION, columns: int = 62, rows: int = 32) -> list[str]:
    return shelf_picture(question, columns, rows).plain.split("\n")


def test_north_is_left_and_the_mouth_is_below() -> None:
    lines = drawn()
    assert len(lines) == 32
    assert {len(line) for line in lines[1:-1]} == {62}
    inside = [line[1:-1] for line in lines[1:-1]]
    where = {label: [(r, line.index(label)) for r, line in enumerate(inside) if label in line] for label in "012"}
    assert np.allclose(where["0"], [(24.5, 49.5)], atol=1.0)  # 0.1 m deep, 0.1 m from the south
    assert np.allclose(where["2"], [(19.5, 9.5)], atol=1.0)
    assert "target" in inside[9] + inside[10]


def test_blocker_target_and_corridor_are_told_apart() -> None:
    inside = "".join(line[1:-1] for line in drawn()[1:-1])
    cell = 0.01 * 0.02
    disc = np.pi * 0.03**2 / cell
    assert inside.count("x") == pytest.approx(disc - 1, abs=3)
    assert inside.count("*") == pytest.approx(disc - 6, abs=3)
    assert inside.count("o") == pytest.approx(2 * (disc - 1), abs=6)
    assert inside.count(".") == pytest.approx((0.4 * 0.24 - 1.5 * np.pi * 0.03**2) / cell, rel=0.05)


def test_what_has_left_the_board_is_not_drawn() -> None:
    state = SCENE.initial_state()
    gone = replace(state, conditions=(*state.conditions[:3], Condition.SPILLED))
    assert not any("2" in line[1:-1] for line in drawn(replace(QUESTION, state=gone))[1:-1])


@pytest.mark.parametrize(("columns", "rows"), [(20, 8), (100, 40), (30, 40), (100, 8)])
def test_it_keeps_to_its_size_and_shows_every_object(columns: int, rows: int) -> None:
    lines = drawn(columns=columns, rows=rows)
    assert len(lines) <= rows + 1
    assert max(map(len, lines[1:-1])) <= columns + 1
    inside = "".join(line[1:-1] for line in lines[1:-1])
    assert all(label in inside for label in "012")


def test_labels_are_short_and_differ() -> None:
    assert labels(SCENE) == {"target": "target", "o0": "0", "o1": "1", "o2": "2"}
    basic = find_scene("vieira/basic")
    assert len(set(labels(basic).values())) == len(basic.ids)
    assert all(len(label) <= 6 for label in labels(basic).values())
    item: SceneObject = SCENE.objects[1]
    long = replace(SCENE, objects=(SCENE.objects[0], replace(item, id="a very long name"), *SCENE.objects[2:]))
    assert labels(long)["a very long name"] == "1"


@pytest.mark.parametrize(
    ("typed", "hint"),
    [
        ("o0 0.2 0.3\n", Hint("o0", (0.2, 0.3))),
        ("0 0.2 0.3\n", Hint("o0", (0.2, 0.3))),
        ("  2,.2,3e-1 ", Hint("o2", (0.2, 0.3))),
        ("nobody 1 -2\n", Hint("nobody", (1.0, -2.0))),
    ],
)
def test_what_is_typed_is_a_hint(typed: str, hint: Hint) -> None:
    assert parse_hint(typed, QUESTION) == hint


@pytest.mark.parametrize(
    "typed", ["\n", "o0\n", "o0 0.2\n", "o0 0.2 b\n", "o0 0.2 0.3 0.4\n", "o0 nan 0.2\n", "o0 inf 1\n"]
)
def test_what_is_no_hint_is_told_by_an_example(typed: str) -> None:
    assert parse_hint(typed, QUESTION) == "Expected OBJECT X Y, such as: o1 0.20 0.30"
