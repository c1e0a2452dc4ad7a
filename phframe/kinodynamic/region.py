"""Where a kinodynamic search is to get: regions of the coordinates that it measures distances in."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from phframe.core import FloatArray, State, rotated_in_plane, rotation_matrix
from phframe.kinodynamic.steered_tree import Room

TURN = 0.1
"""A radian of yaw counts as so many metres."""


def pose_coordinates(pose: FloatArray) -> FloatArray:
    """A fingertip pose ``(3,)`` x, y (m), yaw (rad) in metres throughout."""
    return np.asarray(pose * np.array([1.0, 1.0, TURN]))


class Region(ABC):
    """A region that a search is to reach, and the Euclidean space ``(m,)`` (m) in which it measures distances.

    Attributes:
        lower: Least coordinates ``(m,)``.
        upper: Greatest coordinates ``(m,)``.
        tolerance: At this distance or nearer the region is reached (m).
    """

    lower: FloatArray
    upper: FloatArray
    tolerance: float

    @abstractmethod
    def coordinates(self, state: State) -> FloatArray:
        """Where a state is ``(m,)`` (m)."""

    @abstractmethod
    def distance(self, coordinates: FloatArray) -> float:
        """How far coordinates ``(m,)`` are from the middle of the region (m)."""

    @abstractmethod
    def sample(self, rng: np.random.Generator) -> FloatArray:
        """Coordinates ``(m,)`` in the region."""

    def reached(self, state: State) -> bool:
        """Whether a state is in the region."""
        return self.distance(self.coordinates(state)) <= self.tolerance


def gripper_of(state: State) -> FloatArray:
    """Fingertip pose ``(3,)`` of a state whose arm stands somewhere."""
    assert state.arm is not None, "what is steered is not parked"
    return state.arm.gripper


@dataclass(frozen=True, slots=True, eq=False)
class GripperNear(Region):
    """The fingertip near a pose.

    Attributes:
        pose: x, y (m), yaw (rad) ``(3,)``.
        tolerance: Greatest distance, a radian counting as 0.1 m (m).
        lower: Of the fingertip, in metres throughout ``(3,)``.
        upper: Likewise.
    """

    pose: FloatArray
    tolerance: float
    lower: FloatArray
    upper: FloatArray

    @classmethod
    def of(cls, pose: FloatArray, tolerance: float, room: Room) -> GripperNear:
        """The region around a pose in a room."""
        return cls(pose, tolerance, pose_coordinates(room.lower), pose_coordinates(room.upper))

    def coordinates(self, state: State) -> FloatArray:
        """The fingertip's pose."""
        return pose_coordinates(gripper_of(state))

    def distance(self, coordinates: FloatArray) -> float:
        """From the pose."""
        return math.hypot(*(coordinates - pose_coordinates(self.pose)))

    def sample(self, rng: np.random.Generator) -> FloatArray:
        """The pose: the region is small."""
        return pose_coordinates(self.pose)


@dataclass(frozen=True, slots=True, eq=False)
class ObjectNear(Region):
    """An object near a place: a search for it measures the fingertip's pose and the object's position, ``(5,)``.

    Attributes:
        row: Of the object in a state's poses.
        place: Where it is to be ``(2,)`` (m).
        behind: From the object's centre to a fingertip that pushes it there ``(2,)`` (m).
        yaw: Of the fingertip that pushes it there (rad).
        tolerance: How near (m).
        lower: Of fingertip and object ``(5,)``.
        upper: Likewise.
    """

    row: int
    place: FloatArray
    behind: FloatArray
    yaw: float
    tolerance: float
    lower: FloatArray
    upper: FloatArray

    def coordinates(self, state: State) -> FloatArray:
        """The fingertip's pose and the object's position."""
        return np.concatenate([pose_coordinates(gripper_of(state)), state.positions[self.row]])

    def distance(self, coordinates: FloatArray) -> float:
        """Of the object from the place."""
        return math.hypot(*(coordinates[3:] - self.place))

    def sample(self, rng: np.random.Generator) -> FloatArray:
        """The object evenly in the disc around the place, the fingertip where it would have pushed it from."""
        angle, radius = rng.uniform(-math.pi, math.pi), self.tolerance * math.sqrt(rng.random())
        at = self.place + radius * np.array([math.cos(angle), math.sin(angle)])
        return np.concatenate([pose_coordinates(np.array([*(at + self.behind), self.yaw])), at])


@dataclass(frozen=True, slots=True, eq=False)
class TargetInHand(Region):
    """The target between the open fingers, its centre so far behind the fingertips that these hold it.

    A search for it measures the fingertip's pose and the target's position, ``(5,)``.

    Attributes:
        row: Of the target.
        past: How far the fingertips go past its centre (m).
        yaw: Of the fingertip where it aims (rad).
        place: Where the target stands before the reach ``(2,)`` (m).
        tolerance: How far the target may be off the middle between the fingers, and off the depth (m).
        lower: Of fingertip and target ``(5,)``.
        upper: Likewise.
    """

    row: int
    past: float
    yaw: float
    place: FloatArray
    tolerance: float
    lower: FloatArray
    upper: FloatArray

    def coordinates(self, state: State) -> FloatArray:
        """The fingertip's pose and the target's position."""
        return np.concatenate([pose_coordinates(gripper_of(state)), state.positions[self.row]])

    def distance(self, coordinates: FloatArray) -> float:
        """Of the target from where the fingers would hold it."""
        yaw = float(coordinates[2]) / TURN
        local = rotated_in_plane(coordinates[3:] - coordinates[:2], rotation_matrix(yaw))
        return math.hypot(float(local[0]) + self.past, float(local[1]))

    def sample(self, rng: np.random.Generator) -> FloatArray:
        """The target where it is, the fingertip where it would hold it."""
        ahead = np.array([math.cos(self.yaw), math.sin(self.yaw)])
        tip = np.array([*(self.place + self.past * ahead), self.yaw])
        return np.concatenate([pose_coordinates(tip), self.place])
