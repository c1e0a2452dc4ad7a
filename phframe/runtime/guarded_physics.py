"""A foreign backend under watch: it is given copies, and what it returns is checked before anybody relies on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from phframe.core import (
    FloatArray,
    Motion,
    Options,
    Physics,
    Scene,
    Settle,
    State,
    Stop,
    SupportsManySimulations,
    SupportsPropagation,
    Trajectory,
    Transition,
    Watch,
)
from phframe.registry import Kind
from phframe.runtime.blame import is_own, title_of
from phframe.runtime.border import checked_motion, checked_state, deepcopy_of_state


def guarded(physics: Physics[Any], scene: Scene, name: Any) -> Physics[Any]:
    """A backend as it is to be used: phframe's own as it is, another under watch.

    Args:
        physics: The backend.
        scene: What it models; the backend was given a copy.
        name: What it was asked for by.
    """
    if is_own(physics):
        return physics
    many, steered = isinstance(physics, SupportsManySimulations), isinstance(physics, SupportsPropagation)
    guard = {(False, False): GuardedPhysics, (True, False): _Many, (False, True): _Steered, (True, True): _Both}
    return guard[many, steered](physics, scene, title_of(Kind.BACKEND, name))


class GuardedPhysics(Physics[Options]):
    """Does what another backend does.

    Args:
        physics: The other.
        scene: What it models.
        title: What it is called in errors.
    """

    def __init__(self, physics: Physics[Any], scene: Scene, title: str) -> None:
        super().__init__(scene, physics.arm, physics.base_pose, physics.options)
        self.__wrapped__: Any = physics
        self._title = title

    def restore(self, state: State) -> State:
        """The other's."""
        return self._state(self.__wrapped__.restore(deepcopy_of_state(state)))

    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        """The other's; who looks on sees checked copies."""
        looks = None if watch is None else Watch(watch.period, self._look(watch))
        motion = self.__wrapped__.execute(_copied(trajectory), settle=settle, stop=stop, watch=looks)
        return checked_motion(motion, self._title)

    def observe(self) -> State:
        """The other's."""
        return self._state(self.__wrapped__.observe())

    def close(self) -> None:
        """The other's."""
        self.__wrapped__.close()

    def _look(self, watch: Watch) -> Any:
        return lambda time, state: watch.look(float(time), self._state(state))

    def _state(self, state: Any) -> State:
        return checked_state(state, self.scene, self._title)

    def _transition(self, found: Transition) -> Transition:
        return Transition(self._state(found.state), checked_motion(found.motion, self._title))


def _copied(trajectory: Trajectory) -> Trajectory:
    return trajectory.__reduce__()[0](*trajectory.__reduce__()[1])  # type: ignore[return-value]


class _Many(GuardedPhysics):
    """One that simulates many at once."""

    def simulate_many(
        self,
        states: Sequence[State],
        trajectories: Sequence[Trajectory],
        *,
        settle: Settle | None = Settle(),  # noqa: B008 - immutable
        stop: Stop | None = None,
    ) -> list[Transition]:
        """The other's."""
        given = [deepcopy_of_state(state) for state in states], [_copied(each) for each in trajectories]
        found = self.__wrapped__.simulate_many(*given, settle=settle, stop=stop)
        return [self._transition(each) for _, each in zip(states, found, strict=True)]


class _Steered(GuardedPhysics):
    """One that steers at control level; its snapshots are its own."""

    def snapshot(self) -> Any:
        """The other's."""
        return self.__wrapped__.snapshot()

    def state_of(self, snapshot: Any) -> State:
        """The other's."""
        return self._state(self.__wrapped__.state_of(snapshot))

    def propagate(
        self, snapshot: Any, twist: FloatArray, dt: float, *, opening: float | None = None, stop: Stop | None = None
    ) -> tuple[Any, Motion]:
        """The other's."""
        after, motion = self.__wrapped__.propagate(snapshot, twist.copy(), dt, opening=opening, stop=stop)
        return after, checked_motion(motion, self._title)


class _Both(_Many, _Steered):
    """One that does both."""
