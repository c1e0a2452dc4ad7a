"""The straight push of a single object to a place, and the places that are free for it (GRTC; Papallas and Dogar 2020)."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from phframe.core import (
    MOUTH_CLEARANCE,
    Action,
    Contacts,
    FloatArray,
    GripperPath,
    Infeasible,
    Options,
    Phase,
    PhaseRule,
    Scene,
    State,
    rotated_in_plane,
    rotation_matrix,
)
from phframe.geometry.arm_view import arm_view
from phframe.geometry.straight_motion import distances_on_way_in
from phframe.pushing.options import Clearance, PushingOptions, Speed
from phframe.pushing.pushing import Pushing
from phframe.pushing.straight_drive import StraightDrive

Length = Annotated[float, Field(gt=0.0, le=1.0)]


class StraightPushOptions(Options):
    """Figures that planners which push single objects straight to a place have in common.

    Attributes:
        half_width: Of the corridor, w (m); ``auto``: half the arm's link, the largest obstacle's radius and 4 mm.
        max_actions: Pushes after which to give up.
        max_tries: Pushes simulated in all after which to give up.
        apart: Room between an object at its new place and every other one (m); 0.01 keeps centres 0.07 apart at radius 0.03.
        behind: Distance from the object's centre at which the fingertip begins to push (radii).
        goal_radius: How far from its place an object may end (m).
        insert_speed: Going in and out (m/s).
        sweep_speed: Pushing (m/s).
        reach_speed: Reaching for the target and drawing it out (m/s).
        wall_clearance: Kept between the pushing arm and the walls (m).
        neighbour_clearance: Kept between the reaching arm and the walls (m).
        max_grasp_turn: Greatest deviation of the reaching gripper from the corridor's axis (rad).
        withdrawal: How far outside the mouth the whole target is drawn (m).
    """

    half_width: Length | Literal["auto"] = 0.12
    max_actions: Annotated[int, Field(ge=1, le=1000)] = 30
    max_tries: Annotated[int, Field(ge=1, le=100_000)] = 300
    apart: Clearance = 0.01
    behind: Annotated[float, Field(ge=1.5, le=10.0)] = 2.1
    goal_radius: Length = 0.05
    insert_speed: Speed = 0.25
    sweep_speed: Speed = 0.2
    reach_speed: Speed = 0.25
    wall_clearance: Clearance = 0.002
    neighbour_clearance: Clearance = 0.002
    max_grasp_turn: Annotated[float, Field(ge=0.0, le=math.pi / 4.0)] = 0.2618
    withdrawal: Length = 0.10

    @property
    def pushing(self) -> PushingOptions:
        """The figures that it has in common with the paper's method: those of corridor and grasp."""
        return PushingOptions(**self.model_dump(include=set(PushingOptions.model_fields)))


class StraightPusher:
    """Straight pushes of single objects, for one task. Holds nothing that changes.

    Args:
        pushing: The task's geometry.
        options: The planner's.
    """

    def __init__(self, pushing: Pushing, options: StraightPushOptions) -> None:
        self._pushing, self._scene, self._options = pushing, pushing.scene, options
        arm = pushing.task.arm
        self._met = arm.met(self._scene)
        self._view = arm_view(self._scene.shelf, arm, arm.min_opening, options.wall_clearance)

    def free_places(self, state: State, row: int, drive: StraightDrive, spacing: float) -> FloatArray:
        """Places ``(k, 2)`` for an object (m): on a grid, apart from all others, outside the corridor, off the drive.

        Args:
            state: The world at rest.
            row: Of the object.
            drive: At the target.
            spacing: Of the grid (m).
        """
        shelf, radius = self._scene.shelf, float(self._scene.radii[row])
        axes = [np.arange(radius, length - radius + 1e-9, spacing) for length in (shelf.depth, shelf.width)]
        grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
        inside = drive.grasp.corridor.contains(grid) | drive.meets(grid, radius)
        there = np.linalg.norm(grid - state.positions[row], axis=1) <= self._options.goal_radius
        return np.asarray(grid[~(inside | there | self._taken(state, row, grid).any(axis=1))])

    def is_there(self, state: State, row: int, place: FloatArray) -> bool:
        """Whether an object is as near to a place ``(2,)`` (m) as a push to it must take it."""
        return math.hypot(*(place - state.positions[row])) <= self._options.goal_radius

    def refusal(self, state: State, row: int, place: FloatArray) -> str:
        """Why an object is not to be pushed to a place ``(2,)`` (m); empty: it may."""
        name = self._scene.ids[row]
        if outside := outside_shelf(self._scene, row, place):
            return outside
        if not state.on_board[row]:
            return f"{name} has left the board"
        if not self._met[row]:
            return f"{name} is so low that the arm passes over it"
        if self.is_there(state, row, place):
            return f"{name} is at ({place[0]:g}, {place[1]:g}) already, to within {self._options.goal_radius:g} m"
        taken = np.flatnonzero(self._taken(state, row, place[None])[0])
        names = ", ".join(self._scene.ids[other] for other in taken)
        return f"({place[0]:g}, {place[1]:g}) is too near to {names}" if names else ""

    def push(self, state: State, row: int, place: FloatArray, yaw: float) -> Action | Infeasible:
        """Straight in to behind an object, straight on until it is at its place, straight out; the fingers closed.

        Args:
            state: The world at rest.
            row: Of the object.
            place: Where it is to stand ``(2,)`` (m).
            yaw: Of the arm (rad), which it keeps.
        """
        name, at, radius = self._scene.ids[row], state.positions[row], float(self._scene.radii[row])
        way = place - at
        along = way / math.hypot(*way)
        ahead = np.array([math.cos(yaw), math.sin(yaw)])
        half_width = (
            self._pushing.task.arm.insertion_width / 2.0 * abs(float(ahead[0] * along[1] - ahead[1] * along[0]))
        )
        begin, end = at - self._options.behind * radius * along, place - (radius + half_width) * along
        entry, leave = (self._way_out(tip, yaw) for tip in (begin, end))
        points = np.array([begin - entry * ahead, begin, end, end - leave * ahead])
        if obstruction := self._obstruction(points, at, radius, yaw):
            return Infeasible(f"{name} cannot be pushed straight to ({place[0]:.2f}, {place[1]:.2f}): {obstruction}")
        poses = np.column_stack([points, np.full(len(points), yaw)])
        path = GripperPath(poses, (Phase.INSERT, Phase.SWEEP, Phase.RETREAT), self._rules())
        return Action(f"push {name} to ({place[0]:.2f}, {place[1]:.2f})", path, (name,))

    def _taken(self, state: State, row: int, points: FloatArray) -> NDArray[np.bool_]:
        """Mask ``(k, n)`` of the objects that are too near to points ``(k, 2)`` for another one to stand there."""
        distances = np.linalg.norm(points[:, None] - state.positions[None], axis=2)
        near = (distances < self._scene.radii + self._scene.radii[row] + self._options.apart) & state.on_board
        near[:, row] = False
        return np.asarray(near)

    def _way_out(self, tip: FloatArray, yaw: float) -> float:
        """Length of the straight way from a fingertip position to where the whole arm is before the mouth (m)."""
        front = float(self._view.silhouette(yaw).front)
        return max(0.0, float(tip[0]) + front + MOUTH_CLEARANCE) / math.cos(yaw)

    def _obstruction(self, points: FloatArray, at: FloatArray, radius: float, yaw: float) -> str:
        """What keeps the arm from getting behind the object and through the push, if anything: a wall, or the object."""
        walls, (outside, begin, *_) = self._view.walls(yaw), points
        for first, last in pairwise(points):
            length = math.hypot(*(last - first))
            if not walls.is_free(first) or (length and walls.travel(first, (last - first) / length, length) < length):
                return "a wall is in the arm's way"
        local, entry = rotated_in_plane((at - begin)[None], rotation_matrix(yaw)), math.hypot(*(begin - outside))
        met = distances_on_way_in(local, *self._view.boxes, entry).min() < radius
        return "the arm cannot get behind it without touching it" if met else ""

    def _rules(self) -> dict[Phase, PhaseRule]:
        closed = self._pushing.task.arm.min_opening
        insert = PhaseRule(self._options.insert_speed, closed, Contacts.OBJECTS)
        sweep = PhaseRule(self._options.sweep_speed, closed, Contacts.OBJECTS)
        return {Phase.INSERT: insert, Phase.SWEEP: sweep, Phase.RETREAT: insert}


def outside_shelf(scene: Scene, row: int, place: FloatArray) -> str:
    """Why a place ``(2,)`` (m) is not one inside the shelf for an object; empty: it is."""
    shelf, radius, (x, y) = scene.shelf, float(scene.radii[row]), place
    if radius <= x <= shelf.depth - radius and radius <= y <= shelf.width - radius:
        return ""
    spans = f"x from {radius:g} to {shelf.depth - radius:g}, y from {radius:g} to {shelf.width - radius:g}"
    return f"({x:g}, {y:g}) is not inside the shelf for {scene.ids[row]}: {spans}"
