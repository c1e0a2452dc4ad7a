"""Collision checking: agrees with an engine that shares nothing with it, and depends on the context alone."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

pytest.importorskip("pinocchio")

from phframe.core import Condition, Contacts, FloatArray, Scene, State, UnknownShapeError, compose, inverse, planar_pose
from phframe.motion.coal_ import CollisionChecker, CollisionModel
from phframe.motion.collision_checking import CollisionContext, allowed_objects
from tests import prism
from tests.motion.motions import MIDDLE, SHELF, baxter, cylinder, example

pytestmark = pytest.mark.needs_baxter

ARMS = {"left": baxter, "right": lambda: baxter("right"), "example": example}
SCENE = Scene("s", SHELF, (cylinder("near", 0.15, MIDDLE), cylinder("target", 0.4, MIDDLE - 0.1)), "target")
START = SCENE.initial_state()
MARGINS = 0.0015, 0.001


def model_of(arm: Any, scene: Scene = SCENE, margins: tuple[float, float] = MARGINS) -> CollisionModel:
    return CollisionModel(
        arm, arm.description, scene.shelf, scene.objects, arm.default_base_pose(scene.shelf), *margins
    )


def checker_of(arm: Any, state: State = START, opening: float | None = None, **more: Any) -> CollisionChecker:
    """A fresh one, with the fingers closed and nothing to be touched if nothing else is said."""
    least = arm.shape.min_opening if opening is None else opening
    return model_of(arm).checker(CollisionContext(state, least, **more))


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


def met(checker: CollisionChecker, q: FloatArray) -> set[str]:
    return {second for _, second in checker.collisions(q)}


@pytest.mark.needs_mujoco
@pytest.mark.parametrize("name", ARMS)
def test_it_agrees_with_mujoco(name: str) -> None:
    pytest.importorskip("mujoco")
    from tests.motion.judge import Judge

    arm = ARMS[name]()
    kept = checker_of(arm)
    checker = model_of(arm, margins=(0.0, 0.0)).checker(CollisionContext(START, arm.shape.min_opening))
    judge = Judge(arm, SCENE, arm.default_base_pose(SHELF))
    differing, verdicts = [], []
    for q in configurations(arm, 300):
        ours = {(min(pair), max(pair)) for pair in checker.collisions(q)}
        theirs = judge.touching(q, arm.shape.min_opening)
        if ours != theirs:
            differing.append((ours ^ theirs, q))
        assert checker.is_free(q) == (not ours)
        assert not theirs or not kept.is_free(q), "with margins, all the more"
        verdicts.append(checker.is_free(q))
    assert len(differing) <= 1, differing  # what overlaps by less than rounding
    assert 30 < sum(verdicts) < 270


def moved(dy: float) -> State:
    poses = START.poses.copy()
    poses[0, 1] += dy
    return State(poses, START.conditions)


def test_the_context_says_where_objects_are_and_what_may_be_touched() -> None:
    arm = example()
    at_near = reaching(arm, 0.16, MIDDLE)
    assert "near" in met(checker_of(arm), at_near)
    assert not checker_of(arm).is_free(at_near)
    assert checker_of(arm, allowed=frozenset({"near"})).is_free(at_near)
    assert "near" in met(checker_of(arm, allowed=frozenset({"target"})), at_near)
    assert checker_of(arm, moved(0.2)).is_free(at_near)
    spilled = State(START.poses, (Condition.SPILLED, Condition.UPRIGHT))
    assert checker_of(arm, spilled).is_free(at_near), "what has spilled is in nobody's way"


CONTEXTS = [
    {"state": moved(dy), "opening": opening, "allowed": frozenset(allowed), "begin": begin}
    for dy in (0.0, 0.2)
    for opening in (0.0, 0.08)
    for allowed in ((), ("near",), ("near", "target"))
    for begin in (None, 0.122)
]


@cache
def looked_at() -> Sequence[FloatArray]:
    arm = example()
    return [
        arm.home,
        *(reaching(arm, x, y) for x in (0.11, 0.122, 0.13, 0.16) for y in (MIDDLE, MIDDLE + 0.05, 0.05)),
        reaching(arm, 0.4, MIDDLE - 0.1),
    ]


def context_of(number: int) -> CollisionContext:
    said = dict(CONTEXTS[number])
    begin = said.pop("begin")
    return CollisionContext(**said, start=None if begin is None else reaching(example(), begin, MIDDLE))  # type: ignore[arg-type]


@cache
def fresh_verdicts(number: int) -> Sequence[tuple[bool, tuple[tuple[str, str], ...]]]:
    checker = model_of(example()).checker(context_of(number))
    return [(checker.is_free(q), checker.collisions(q)) for q in looked_at()]


@cache
def used_checkers() -> tuple[CollisionModel, dict[int, CollisionChecker]]:
    return model_of(example()), {}


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(questions=st.lists(st.tuples(st.integers(0, len(CONTEXTS) - 1), st.integers(0, 13), st.booleans()), max_size=30))
def test_what_was_asked_before_changes_no_answer(questions: list[tuple[int, int, bool]]) -> None:
    """Checkers of one model, made and asked in any order, in turns."""
    model, checkers = used_checkers()
    for number, place, again in questions:
        if again or number not in checkers:
            checkers[number] = model.checker(context_of(number))
        q = looked_at()[place]
        assert (checkers[number].is_free(q), checkers[number].collisions(q)) == fresh_verdicts(number)[place]


def test_verdicts_differ_by_context() -> None:
    """What the test above would not notice otherwise."""
    verdicts = {tuple(fresh_verdicts(number)) for number in range(len(CONTEXTS))}
    assert len(verdicts) == 6


def test_a_context_cannot_be_changed() -> None:
    context = CollisionContext(START, 0.0)
    with pytest.raises(AttributeError):
        context.opening = 0.1  # type: ignore[misc]


def test_rules_allow_contacts_by_name() -> None:
    assert allowed_objects(Contacts.NONE, SCENE, "near") == set()
    assert allowed_objects(Contacts.MANIPULAND, SCENE, "near") == {"near"}
    assert allowed_objects(Contacts.MANIPULAND, SCENE, None) == set()
    assert allowed_objects(Contacts.OBJECTS, SCENE, None) == {"near", "target"}


def test_obstacles_are_what_must_not_be_touched() -> None:
    spilled = State(START.poses, (Condition.SPILLED, Condition.UPRIGHT))
    found = CollisionContext(START, 0.0, frozenset({"target"})).obstacles(SCENE)
    np.testing.assert_allclose(found, [[0.15, MIDDLE, 0.03, SCENE.objects[0].shape.height]])
    assert CollisionContext(spilled, 0.0).obstacles(SCENE)[0, 2] == -np.inf
    assert len(CollisionContext(START, 0.0, frozenset(SCENE.ids)).obstacles(SCENE)) == 0


def test_open_fingers_take_more_room() -> None:
    arm = example()
    beside = reaching(arm, 0.15, MIDDLE + 0.05)
    assert checker_of(arm).is_free(beside)
    opened = checker_of(arm, opening=arm.shape.max_opening)
    assert met(opened, beside) == {"near"}
    assert {first for first, _ in opened.collisions(beside)} == {"right_finger"}


@pytest.mark.parametrize("wider", [0.0, 0.004])
def test_margins_are_kept(wider: float) -> None:
    arm, palm = example(), 0.11 / 2.0
    scene = Scene("s", SHELF, (cylinder("target", 0.5, MIDDLE),), "target")
    model = model_of(arm, scene, (MARGINS[0] + wider, MARGINS[1] + wider))
    checker = model.checker(CollisionContext(scene.initial_state(), arm.shape.min_opening))
    for gap, free in ((0.001, False), (0.003, True)):
        assert checker.is_free(reaching(arm, 0.17, SHELF.width - palm - gap - wider)) == free, gap
    for gap, free in ((0.0005, False), (0.002, True)):
        assert checker.is_free(reaching(arm, 0.47 - gap - wider, MIDDLE)) == free, gap


def test_what_touches_at_the_start_may_touch_no_deeper() -> None:
    arm = example()
    touching, deeper, away = (reaching(arm, x, MIDDLE) for x in (0.122, 0.130, 0.110))
    assert met(checker_of(arm), touching) == {"near"}
    tolerating = checker_of(arm, start=touching)
    assert tolerating.is_free(touching)
    assert tolerating.is_free(away)
    assert not tolerating.is_free(deeper)
    assert not tolerating.is_free(reaching(arm, 0.11, 0.05)), "all else may not be touched"
    assert checker_of(arm, start=away).collisions(touching), "nothing touches there"


def test_fingers_may_touch_one_another() -> None:
    """Closed, as they are drawn, they do."""
    arm = example()
    assert arm.shape.min_opening == 0.0
    assert not [pair for pair in checker_of(arm).collisions(arm.home) if set(pair) == set(arm.fingers.links)]


def test_a_shape_that_is_not_known_is_refused() -> None:
    with pytest.raises(UnknownShapeError, match="collision checking has no primitive for the shape 'prism'"):
        model_of(example(), prism.SCENE)
