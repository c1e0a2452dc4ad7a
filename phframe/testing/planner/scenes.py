"""Scenes for the checks of planners: some that can be solved, some that cannot."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from phframe.core import Condition, Cylinder, Scene, SceneObject, Shelf, State

SHELF = Shelf(depth=0.6, width=0.6)
RADIUS = 0.03
APART = 0.066
"""Least distance between centres (m)."""


def cluttered(seed: int, obstacles: int = 6) -> Scene:
    """A target in the middle, deep in the shelf, behind obstacles that a seed scatters before it."""
    rng, centers = np.random.default_rng(seed), [(0.45, 0.3)]
    while len(centers) <= obstacles:
        x, y = (float(value) for value in rng.uniform([0.1, 0.18], [0.42, 0.42]))
        if all(math.dist((x, y), center) > APART for center in centers):
            centers.append((x, y))
    objects = [_object(f"object_{number}", *center) for number, center in enumerate(centers)]
    return Scene(f"cluttered {seed}", SHELF, tuple(objects), "object_0")


def lone_target() -> Scene:
    """Nothing obstructs the target."""
    return Scene("a lone target", SHELF, (_object("target", 0.35, 0.3),), "target")


def reordered(scene: Scene) -> Scene:
    """The same objects in another order."""
    return replace(scene, objects=(*scene.objects[2:], *reversed(scene.objects[:2])))


def hopeless() -> Iterator[tuple[Scene, State]]:
    """Problems without a solution, some of which make no sense."""
    wide = SceneObject("target", Cylinder(0.14), (0.4, 0.3))
    yield _with_start(Scene("a target too wide to grasp", SHELF, (_object("a", 0.15, 0.3), wide), "target"))
    narrow = Shelf(depth=0.6, width=0.1)
    objects = (_object("a", 0.2, 0.05), _object("target", 0.4, 0.05))
    yield _with_start(Scene("a shelf narrower than the arm", narrow, objects, "target"))
    tight = tuple(_object(f"o{i}{j}", 0.035 + 0.066 * i, 0.035 + 0.066 * j) for i in range(6) for j in range(4))
    crammed = Shelf(depth=0.4, width=0.27)
    yield _with_start(Scene("a shelf crammed full", crammed, tight, "o52"))
    corner = (_object("a", 0.1, 0.1), _object("target", 0.031, 0.031))
    yield _with_start(Scene("a target in the mouth's corner", SHELF, corner, "target"))
    for condition in (Condition.SPILLED, Condition.TOPPLED):
        scene = cluttered(1)
        start = scene.initial_state()
        yield (
            replace(scene, name=f"a target that has {condition}"),
            replace(start, conditions=(condition, *start.conditions[1:])),
        )


def _with_start(scene: Scene) -> tuple[Scene, State]:
    return scene, scene.initial_state()


def _object(name: str, x: float, y: float) -> SceneObject:
    return SceneObject(name, Cylinder(RADIUS), (x, y))
