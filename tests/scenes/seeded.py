"""What holds in every scene that is made from a seed."""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np

from phframe.arms.planar import PlanarArm, PlanarArmOptions
from phframe.core import FloatArray, Scene
from phframe.pushing import Corridor, Grasp, PushingOptions, find_corridor, grasp_action

EPSILON = 1e-9
HALF_WIDTH = 0.12


def corridor_to_target(scene: Scene) -> Corridor:
    """The corridor of Algorithm 1."""
    corridor = find_corridor(target_of(scene), scene.shelf, HALF_WIDTH)
    assert isinstance(corridor, Corridor)
    return corridor


def target_of(scene: Scene) -> FloatArray:
    """Where the target stands ``(2,)``."""
    return np.asarray(scene.initial_state().positions[scene.target_index])


def wall_distance(scene: Scene) -> float:
    """From the target's centre to the nearer side wall (m)."""
    y = float(target_of(scene)[1])
    return min(y, scene.shelf.width - y)


def members(scene: Scene) -> int:
    """Obstacles in the corridor."""
    inside = corridor_to_target(scene).contains(scene.initial_state().positions)
    inside[scene.target_index] = False
    return int(inside.sum())


def alone(scene: Scene) -> Scene:
    """The scene without its obstacles."""
    return Scene(scene.name, scene.shelf, (scene.objects[scene.target_index],), scene.target)


def is_graspable(scene: Scene) -> bool:
    """Whether the planar arm can take the target out as things stand."""
    arm, state = PlanarArm(PlanarArmOptions()).shape, scene.initial_state()
    return isinstance(grasp_action(scene, state, corridor_to_target(scene), arm, PushingOptions()), Grasp)


def check_places(scene: Scene, *, gap: float = 0.002, target_gap: float = 0.02) -> None:
    """Nothing is nearer to anything than it may be, the target is deep in the shelf, and all figures are in steps."""
    shelf, target = scene.shelf, scene.objects[-1]
    assert (scene.target, target.id) == ("target", "target")
    assert 0.66 * shelf.depth < target.position[0] <= 0.9 * shelf.depth
    for item in scene.objects:
        (x, y), margin = item.position, item.radius + gap - EPSILON
        assert margin <= x <= shelf.depth - margin
        assert margin <= y <= shelf.width - margin
        assert item.position == tuple(round(v, 4) for v in item.position)
    for a, b in combinations(scene.objects, 2):
        least = target_gap if target in (a, b) else gap
        assert math.dist(a.position, b.position) - a.radius - b.radius >= least - EPSILON
