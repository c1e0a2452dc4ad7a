"""What an engine leaves at rest is a scene again: for planning from where a run ended, and for exports."""

from __future__ import annotations

from dataclasses import replace
from itertools import chain

import pytest

import phframe
from phframe.core import Condition, Scene, State, Step

ENGINES = [
    "pymunk",
    pytest.param("fast", marks=pytest.mark.needs_fast),
    pytest.param("mujoco", marks=pytest.mark.needs_mujoco),
    pytest.param("pybullet", marks=pytest.mark.needs_pybullet),
]


def _standing(steps: tuple[Step, ...]) -> list[State]:
    """The states after each action in which everything stands on the board."""
    states = (step.after for step in steps)
    return [each for each in states if each.held is None and set(each.conditions) == {Condition.UPRIGHT}]


def _again(scene: Scene, state: State) -> Scene:
    places = [(float(x), float(y)) for x, y in state.positions]
    objects = (replace(item, position=place) for item, place in zip(scene.objects, places, strict=True))
    return replace(scene, objects=tuple(objects))


@pytest.mark.slow
@pytest.mark.parametrize("engine", ENGINES)
def test_what_is_left_at_rest_is_a_scene_again(engine: str) -> None:
    library = {"fast": "numba"}.get(engine, engine)
    pytest.importorskip(library)
    options = {"scenes": {"count": 14}}
    episodes = [phframe.solve(f"random/{number}", backend=engine, options=options) for number in range(2)]
    scenes = [[_again(each.scene, state) for state in _standing(each.steps)] for each in episodes]
    assert len(list(chain(*scenes))) > 2
