"""How long an arm can move before anything can happen: while all is at rest and the arm is away from the shelf."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from phframe.backends.pymunk_world import World
from phframe.core import FloatArray, GripperTrajectory

EDGE_MARGIN = 2e-3
"""The arm is away when it is farther than this (m) from what may stand out of the mouth."""
TURN_SAMPLES = 9
"""Poses looked at along a leg that turns."""


def quiet_ticks(world: World, trajectory: GripperTrajectory, ticks: Sequence[int]) -> int:
    """Steps until the arm first comes near the shelf.

    Args:
        world: At rest.
        trajectory: Where the arm goes.
        ticks: Steps from the beginning to each of its samples.
    """
    near = -max((item.radius for item in world.items.values()), default=0.0) - EDGE_MARGIN
    vertices = np.vstack([outline.vertices for _, outline in world.arm.parts])
    for leg, (start, end) in enumerate(zip(trajectory.poses[:-1], trajectory.poses[1:], strict=True)):
        fronts = _fronts(vertices, start, end)
        if fronts.max() > near:
            straight = start[2] == end[2] and fronts[0] < near
            share = (near - fronts[0]) / (fronts[-1] - fronts[0]) if straight else 0.0
            return ticks[leg] + math.floor(share * (ticks[leg + 1] - ticks[leg]))
    return ticks[-1]


def _fronts(vertices: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """How far ahead (x, m) the arm stands at some moments between two poses, both included."""
    shares = np.linspace(0.0, 1.0, 2 if start[2] == end[2] else TURN_SAMPLES)
    poses = start + shares[:, None] * (end - start)
    ahead = np.cos(poses[:, 2:]) * vertices[:, 0] - np.sin(poses[:, 2:]) * vertices[:, 1]
    return np.asarray(poses[:, 0] + ahead.max(axis=1))
