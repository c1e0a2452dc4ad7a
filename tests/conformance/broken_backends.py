"""Backends that each break one promise: pymunk with something in between."""

from __future__ import annotations

from dataclasses import replace
from itertools import count
from typing import Any, ClassVar

import numpy as np

from phframe.backends.pymunk_.chipmunk import polygon
from phframe.backends.pymunk_.physics import PymunkOptions, PymunkPhysics
from phframe.backends.pymunk_.world import WALL
from phframe.core import (
    ArmModel,
    BasePose,
    Condition,
    GripperTrajectory,
    Motion,
    Scene,
    SceneObject,
    Settle,
    State,
    Stop,
    Trajectory,
    Watch,
)


class Altered(PymunkPhysics):
    """A backend between which and the world something stands."""

    def told(self, state: State) -> State:
        return state

    def seen(self, state: State) -> State:
        return state

    def driven(self, trajectory: GripperTrajectory) -> GripperTrajectory:
        return trajectory

    def reported(self, motion: Motion) -> Motion:
        return motion

    def restore(self, state: State) -> State:
        return self.seen(super().restore(self.told(state)))

    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        assert isinstance(trajectory, GripperTrajectory)
        return self.reported(super().execute(self.driven(trajectory), settle=settle, stop=stop, watch=watch))

    def observe(self) -> State:
        return self.seen(super().observe())


def shifted(state: State, by: float) -> State:
    return replace(state, poses=state.poses + np.array([by, 0, 0, 0, 0, 0, 0]))


class RestoresElsewhere(Altered):
    def told(self, state: State) -> State:
        return shifted(state, 1e-3)


class OnTheBoard(Altered):
    """Centres at z = 0."""

    def seen(self, state: State) -> State:
        return replace(state, poses=state.poses * np.array([1, 1, 0, 1, 1, 1, 1]))


class SeesElsewhere(Altered):
    def seen(self, state: State) -> State:
        return shifted(state, 1e-3)


class NeverSpills(Altered):
    def seen(self, state: State) -> State:
        return replace(state, conditions=(Condition.UPRIGHT,) * len(state.conditions))

    told = seen


class TakesAnything(Altered):
    def restore(self, state: State) -> State:
        try:
            return super().restore(state)
        except Exception:  # noqa: BLE001 - what the check has to find
            return super().restore(self.scene.initial_state())


class ClosesOnce(Altered):
    closed = False

    def close(self) -> None:
        if self.closed:
            raise RuntimeError("closed already")
        self.closed = True


class Ages(Altered):
    """Every run, of all instances, leaves a trace."""

    runs: ClassVar[count[int]] = count()
    age = 0

    def reported(self, motion: Motion) -> Motion:
        self.age = next(Ages.runs)
        return motion

    def seen(self, state: State) -> State:
        return shifted(state, 1e-15 * self.age)


class WritesToTrajectories(Altered):
    def driven(self, trajectory: GripperTrajectory) -> GripperTrajectory:
        trajectory.poses.setflags(write=True)
        trajectory.poses[-1, 0] += 1e-9
        return trajectory


class OneBuffer(Altered):
    """All its states are one and the same array."""

    _buffer: Any = None

    def seen(self, state: State) -> State:
        if self._buffer is None:
            self._buffer = state.poses.copy()
        self._buffer[:] = state.poses
        result = replace(state)
        object.__setattr__(result, "poses", self._buffer)
        return result


class DislikesBeingWatched(Altered):
    watched = False

    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        self.watched = watch is not None
        return super().execute(trajectory, settle=settle, stop=stop, watch=watch)

    def seen(self, state: State) -> State:
        return shifted(state, 1e-15 * self.watched)


class WornByLooks(Altered):
    looks = 0

    def observe(self) -> State:
        self.looks += 1
        return shifted(super().observe(), 1e-15 * self.looks)


class Smooths(Altered):
    """Does not go where it is told."""

    def driven(self, trajectory: GripperTrajectory) -> GripperTrajectory:
        poses = trajectory.poses.copy()
        poses[1:-1] = (poses[:-2] + poses[2:]) / 2.0
        poses[-1] -= 0.01
        return replace(trajectory, poses=poses)


class StiffFingers(Altered):
    def driven(self, trajectory: GripperTrajectory) -> GripperTrajectory:
        return replace(trajectory, openings=trajectory.openings * 0.5)


class DoesNothing(Altered):
    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        return Motion(0.0)


class Jumps(Altered):
    """Puts the arm wherever a trajectory begins."""

    def driven(self, trajectory: GripperTrajectory) -> GripperTrajectory:
        arm = super().observe().arm
        poses = trajectory.poses.copy()
        if arm is not None:
            poses[0] = arm.gripper
        return replace(trajectory, poses=poses)


class BackToFront(Altered):
    def reported(self, motion: Motion) -> Motion:
        return replace(motion, contacts=motion.contacts[::-1])


class Without(Altered):
    """Leaves out a part of what it is asked for."""

    left_out: ClassVar[str]

    def execute(self, trajectory: Trajectory, **more: Any) -> Motion:
        return super().execute(trajectory, **{**more, self.left_out: None})


class ShowsNothing(Without):
    left_out = "watch"


class NeverStops(Without):
    left_out = "stop"


class NeverSettles(Without):
    left_out = "settle"


class BrakesOnlyToSettle(Altered):
    """Stops dead at every corner of its path unless somebody waits for rest afterwards."""

    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        self.options = self.options.model_copy(update={"arm_acceleration": None if settle is None else 2.0})
        return super().execute(trajectory, settle=settle, stop=stop, watch=watch)


class WallsWithoutEnd(Altered):
    """Its south wall goes on before the mouth."""

    def restore(self, state: State) -> State:
        restored = super().restore(state)
        world = self._current
        wall = polygon(world.space.board, [(-1.0, -1.0), (0.0, -1.0), (0.0, 0.0), (-1.0, 0.0)])
        world.names[world.space.add_shape(wall, 0.0, WALL)] = "south wall"
        return restored


class NeverOpens(Altered):
    """Its fingers close, and stay so."""

    def driven(self, trajectory: GripperTrajectory) -> GripperTrajectory:
        return replace(trajectory, openings=np.minimum.accumulate(trajectory.openings))


class Drifts(Altered):
    time = 0.0

    def reported(self, motion: Motion) -> Motion:
        self.time += motion.duration
        return motion

    def seen(self, state: State) -> State:
        return shifted(state, 1e-3 * self.time)


class OtherScene(PymunkPhysics):
    """Models another scene than it is given."""

    def __init__(self, scene: Scene, arm: ArmModel[Any], base_pose: BasePose, options: PymunkOptions) -> None:
        objects = tuple(self.altered(item) for item in scene.objects)
        super().__init__(replace(scene, objects=objects, shelf=self.room(scene)), arm, base_pose, options)

    def altered(self, item: SceneObject) -> SceneObject:
        return item

    def room(self, scene: Scene) -> Any:
        return scene.shelf


class Slippery(OtherScene):
    def altered(self, item: SceneObject) -> SceneObject:
        return replace(item, friction=0.8 * (item.friction or 0.25))


class HeavyThingsStick(OtherScene):
    def altered(self, item: SceneObject) -> SceneObject:
        return replace(item, friction=min(0.25 * item.mass / 0.3, 1.0))


class NothingIsHeavy(OtherScene):
    def altered(self, item: SceneObject) -> SceneObject:
        return replace(item, mass=0.3)


class SoftWalls(OtherScene):
    def room(self, scene: Scene) -> Any:
        return replace(scene.shelf, depth=scene.shelf.depth + 0.02, width=scene.shelf.width + 0.02)


class NothingIsLow(OtherScene):
    def altered(self, item: SceneObject) -> SceneObject:
        return replace(item, shape=replace(item.shape, height=0.12))


class ThinObjects(OtherScene):
    def altered(self, item: SceneObject) -> SceneObject:
        return replace(item, shape=replace(item.shape, radius=0.5 * item.radius))


class EndlessStrength(Altered):
    def driven(self, trajectory: GripperTrajectory) -> GripperTrajectory:
        return replace(trajectory, force_limit=1e4)


class FeelsNothing(Altered):
    def reported(self, motion: Motion) -> Motion:
        return replace(motion, largest_force=0.0)


class StuckForGood(Altered):
    """Once stalled, it never moves again."""

    stuck = False

    def driven(self, trajectory: GripperTrajectory) -> GripperTrajectory:
        if not self.stuck:
            return trajectory
        return replace(trajectory, poses=np.repeat(trajectory.poses[:1], len(trajectory.poses), axis=0))

    def reported(self, motion: Motion) -> Motion:
        self.stuck = self.stuck or motion.stalled
        return replace(motion, stalled=self.stuck)


class EmptyHanded(Altered):
    def seen(self, state: State) -> State:
        return replace(state, held=None)


class ForgetsWhatItHolds(Altered):
    def told(self, state: State) -> State:
        return replace(state, held=None)


class ClosesAllTheWay(Altered):
    def seen(self, state: State) -> State:
        return state if state.arm is None else replace(state, arm=replace(state.arm, opening=0.0))


class Claims(Altered):
    """Holds the target whenever the fingers are closed."""

    def seen(self, state: State) -> State:
        closed = state.arm is not None and state.arm.commanded_opening < 0.01
        return replace(state, held=self.scene.target if closed else state.held)


class NeverLetsGo(Altered):
    held: str | None = None

    def told(self, state: State) -> State:
        self.held = state.held
        return state

    def seen(self, state: State) -> State:
        self.held = state.held or self.held
        return state if state.arm is None else replace(state, held=self.held)
