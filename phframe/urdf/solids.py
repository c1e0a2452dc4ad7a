"""Solid primitives and what follows from them: masses, centres, moments of inertia and points on their surfaces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product
from typing import Literal

import numpy as np

from phframe.core import FloatArray

Vector = tuple[float, float, float]
ORIGIN: Vector = (0.0, 0.0, 0.0)
FACETS = 48
"""Sides of the prism around something round; it stands out by 0.2 % of the radius."""


@dataclass(frozen=True, slots=True)
class Solid:
    """A box, cylinder or sphere in the frame of a link.

    Attributes:
        kind: Its shape.
        size: Box: lengths along x, y, z (m). Cylinder: radius and length, along its own z. Sphere: radius.
        at: Its centre (m).
        rpy: Its rotation (rad): about the fixed axes x, then y, then z, as in URDF.
        part: What it is of, such as ``barrel``.
        name: Of its element in the URDF, without what it is for; empty: of link and part.
    """

    kind: Literal["box", "cylinder", "sphere"]
    size: tuple[float, ...]
    at: Vector = ORIGIN
    rpy: Vector = ORIGIN
    part: str = ""
    name: str = ""

    @property
    def volume(self) -> float:
        """Cubic metres."""
        match self.kind:
            case "box":
                return float(np.prod(self.size))
            case "cylinder":
                return float(np.pi * self.size[0] ** 2 * self.size[1])
            case _:
                return float(4.0 / 3.0 * np.pi * self.size[0] ** 3)

    def corners(self) -> FloatArray:
        """Points ``(k, 3)`` whose convex hull is the solid, or for round ones close around it, in the link's frame (m)."""
        match self.kind:
            case "box":
                points = np.array(list(product((-0.5, 0.5), repeat=3))) * self.size
            case "cylinder":
                radius, length = self.size
                points = np.vstack([_prism(radius, height) for height in (-length / 2.0, length / 2.0)])
            case _:
                heights = np.linspace(-1.0, 1.0, 9) * self.size[0]
                points = np.vstack([_prism(self.size[0], height) for height in heights])
        return np.asarray(points @ rotation(self.rpy).T + self.at)

    def moments(self, mass: float) -> FloatArray:
        """Inertia ``(3, 3)`` about its centre in the axes of the link (kg m^2), evenly dense."""
        match self.kind:
            case "box":
                squares = np.square(self.size)
                own = (squares.sum() - squares) / 12.0
            case "cylinder":
                radius, length = self.size
                across = radius**2 / 4.0 + length**2 / 12.0
                own = np.array([across, across, radius**2 / 2.0])
            case _:
                own = np.full(3, 0.4 * self.size[0] ** 2)
        axes = rotation(self.rpy)
        return np.asarray(mass * axes @ np.diag(own) @ axes.T)


@dataclass(frozen=True, slots=True)
class Inertia:
    """What a link weighs, and how it resists turning.

    Attributes:
        mass: Kilograms.
        center: Centre of mass in the frame of the link (m).
        moments: About that centre in the axes of the link (kg m^2): xx, xy, xz, yy, yz, zz.
    """

    mass: float
    center: Vector
    moments: tuple[float, float, float, float, float, float]

    @classmethod
    def of(cls, mass: float, center: FloatArray, matrix: FloatArray) -> Inertia:
        """The inertia of a mass (kg), its centre ``(3,)`` (m) and moments as a matrix ``(3, 3)`` (kg m^2)."""
        cells = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
        xx, xy, xz, yy, yz, zz = (float(matrix[cell]) for cell in cells)
        x, y, z = (float(value) for value in center)
        return cls(mass, (x, y, z), (xx, xy, xz, yy, yz, zz))

    @property
    def matrix(self) -> FloatArray:
        """The moments as a matrix ``(3, 3)``."""
        xx, xy, xz, yy, yz, zz = self.moments
        return np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])

    def moved(self, at: Vector, rpy: Vector) -> Inertia:
        """The same body, given in a frame in which its own frame stands at a place (m) and a rotation (rad)."""
        axes = rotation(rpy)
        center = np.asarray(at) + axes @ np.asarray(self.center)
        return Inertia.of(self.mass, center, axes @ self.matrix @ axes.T)


def of_solids(mass: float, solids: Sequence[Solid]) -> Inertia:
    """The inertia of solids of one even density that weigh ``mass`` (kg) together."""
    volume = sum(solid.volume for solid in solids)
    fractions = [mass * solid.volume / volume for solid in solids]
    return together(
        [
            Inertia.of(fraction, np.asarray(solid.at), solid.moments(fraction))
            for fraction, solid in zip(fractions, solids, strict=True)
        ]
    )


def together(parts: Sequence[Inertia]) -> Inertia:
    """The inertia of bodies fixed to one another, all given in the same frame."""
    masses = np.array([part.mass for part in parts])
    centers = np.array([part.center for part in parts])
    center = masses @ centers / masses.sum()
    moments = np.zeros((3, 3))
    for part, arm in zip(parts, centers - center, strict=True):
        moments += part.matrix + part.mass * (np.eye(3) * (arm @ arm) - np.outer(arm, arm))
    return Inertia.of(float(masses.sum()), center, moments)


def _prism(radius: float, height: float) -> FloatArray:
    """Corners ``(FACETS, 3)`` of a regular polygon around a circle about z at a height (m)."""
    angles = np.arange(FACETS) * 2.0 * np.pi / FACETS
    around = radius / np.cos(np.pi / FACETS)
    return np.column_stack([around * np.cos(angles), around * np.sin(angles), np.full(FACETS, height)])


def rotation(rpy: Sequence[float]) -> FloatArray:
    """The rotation matrix ``(3, 3)`` about the fixed axes x, then y, then z (rad)."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def axis_rotation(axis: Sequence[float], angle: float) -> FloatArray:
    """The rotation matrix ``(3, 3)`` about a unit vector ``(3,)`` by an angle (rad): I + sin K + (1 - cos) K^2 (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross)


def roll_pitch_yaw(matrix: FloatArray) -> Vector:
    """The rotation about the fixed axes x, y, z (rad) that a rotation matrix ``(3, 3)`` stands for."""
    pitch = float(np.arcsin(np.clip(-matrix[2, 0], -1.0, 1.0)))
    if abs(matrix[2, 0]) > 1.0 - 1e-12:
        return float(np.arctan2(-matrix[1, 2], matrix[1, 1])), pitch, 0.0
    return float(np.arctan2(matrix[2, 1], matrix[2, 2])), pitch, float(np.arctan2(matrix[1, 0], matrix[0, 0]))
