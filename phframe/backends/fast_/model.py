"""A scene and an arm as arrays, and room for a world of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from phframe.backends.fast_ import layout
from phframe.backends.fast_.layout import FastRun, FastWorld
from phframe.core import (
    GRAZING,
    ArmShape,
    Cylinder,
    FloatArray,
    Scene,
    SceneObject,
    UnknownShapeError,
    drag_on_board,
)


@dataclass(frozen=True, slots=True)
class FastFigures:
    """What a scene and an arm do not say; for what each is, see the options of the backend."""

    step: float
    iterations: int
    object_friction: float
    arm_friction: float
    arm_mass: float
    standing_radius: float
    stall_lag: float


LONGEST_STEP = 0.02
"""No step is longer than this (s)."""


def build_world(scene: Scene, shape: ArmShape, figures: FastFigures) -> FastWorld:
    """Room for a world, with what is constant in it written down.

    Raises:
        UnknownShapeError: If the engine has no primitive for the shape of an object.
    """
    n, p = len(scene.objects), len(shape.closed)
    corners = _corners(shape)
    contacts = n * (n - 1) // 2 + n * (p + 4) + 3 * len(corners) + 2 * p + 3
    return FastWorld(
        bodies=_bodies(scene, figures),
        arm=_settings(scene, shape, figures),
        parts=_parts(shape),
        corners=corners,
        fingers=_fingers(shape),
        rows=np.zeros((contacts, layout.ROW_FIELDS)),
        remembered=np.zeros((n + p + 4, n + p + 4, 3)),
    )


def _bodies(scene: Scene, figures: FastFigures) -> FloatArray:
    bodies = np.zeros((len(scene.objects) + 2, layout.BODY_FIELDS))
    for row, item in enumerate(scene.objects):
        radius, mass = _disc(item), item.mass
        inertia, lever = mass * radius * radius / 2.0, radius * figures.standing_radius
        bodies[row, layout.BY_MASS], bodies[row, layout.BY_INERTIA] = 1.0 / mass, 1.0 / inertia
        most = drag_on_board(scene, item)
        bodies[row, layout.RADIUS : layout.FRICTION_LEVER + 1] = radius, mass, inertia, most, lever
        bodies[row, layout.TOP] = item.shape.height - GRAZING
    return bodies


def _corners(shape: ArmShape) -> FloatArray:
    corners = np.zeros((sum(len(outline.vertices) for outline in shape.closed), layout.CORNER_FIELDS))
    corners[:, layout.OWN_X : layout.OWN_Y + 1] = np.vstack([outline.vertices for outline in shape.closed])
    corners[:, layout.OWN_NX : layout.OWN_NY + 1] = np.vstack([_normals(outline.vertices) for outline in shape.closed])
    return corners


def _parts(shape: ArmShape) -> FloatArray:
    parts = np.zeros((len(shape.closed), layout.PART_FIELDS))
    first = 0
    for row, outline in enumerate(shape.closed):
        end = first + len(outline.vertices)
        parts[row, : layout.REACH + 1] = outline.side, first, end, *_circle(outline.vertices)
        parts[row, layout.BOTTOM] = shape.height + outline.bottom
        first = end
    return parts


def _disc(item: SceneObject) -> float:
    match item.shape:
        case Cylinder(radius=radius):
            return float(radius)
        case _:
            raise UnknownShapeError(item.shape, "the fast backend")


def _normals(corners: FloatArray) -> FloatArray:
    edges = np.roll(corners, -1, axis=0) - corners
    outward = np.column_stack([edges[:, 1], -edges[:, 0]])
    return np.asarray(outward / np.linalg.norm(outward, axis=1)[:, None])


def _circle(corners: FloatArray) -> tuple[float, float, float]:
    middle = (corners.max(axis=0) + corners.min(axis=0)) / 2.0
    return float(middle[0]), float(middle[1]), float(np.linalg.norm(corners - middle, axis=1).max())


def _fingers(shape: ArmShape) -> FloatArray:
    fingers = [outline for outline in shape.closed if outline.side]
    rows = [(f.side, f.vertices[:, 0].min(), f.vertices[:, 0].max(), shape.height + f.bottom) for f in fingers]
    return np.array(rows, dtype=np.float64).reshape(-1, 4)


def _settings(scene: Scene, shape: ArmShape, figures: FastFigures) -> FloatArray:
    settings = np.zeros(layout.SETTINGS)
    settings[layout.STEP], settings[layout.LONGEST_STEP] = figures.step, LONGEST_STEP
    settings[layout.ITERATIONS] = figures.iterations
    settings[layout.OBJECT_FRICTION], settings[layout.ARM_FRICTION] = figures.object_friction, figures.arm_friction
    settings[layout.WALL_FRICTION] = scene.shelf.wall_friction
    settings[layout.ARM_MASS], settings[layout.STALL_LAG] = figures.arm_mass, figures.stall_lag
    settings[layout.DEPTH], settings[layout.WIDTH] = scene.shelf.depth, scene.shelf.width
    settings[layout.MIN_OPENING] = shape.min_opening
    return settings


def make_run(world: FastWorld, phases: int) -> FastRun:
    """Room for what is told of one motion of so many different phases."""
    kinds, parts = len(world.bodies) + 1, len(world.parts)
    return FastRun(
        figures=np.zeros(layout.RUN_FIELDS),
        window=np.zeros((layout.WINDOW_STEPS, 2)),
        seen=np.zeros((phases, parts, kinds)),
        events=np.zeros((phases * parts * kinds, 4)),
    )
