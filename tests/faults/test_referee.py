"""Who writes into what it was given changes nothing that is judged, measured or stored: the referee keeps its own copies."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from phframe.backends.pymunk_.physics import PymunkPhysics
from phframe.core import Episode, Motion, Plan, RunSpec, Scene, Settle, State, Status, Stop, Task, Trajectory, Watch
from phframe.planners.phia import PHIA
from phframe.runtime.run import run

SCENE = "vieira/simple-07"


def moved(state: State) -> None:
    """Everything but the first object is out of the way."""
    state.poses.setflags(write=True)
    state.poses[1:, 0] -= 5.0


def forced(value: Any, **fields: Any) -> None:
    for name, field in fields.items():
        object.__setattr__(value, name, field)


def held(state: State, scene: Scene) -> None:
    forced(state, held=scene.target)


DEEDS: dict[str, Callable[[Task, Plan], None]] = {
    "moves the start": lambda task, plan: moved(task.start),
    "holds the target at the start": lambda task, plan: held(task.start, task.scene),
    "moves the objects of the scene": lambda task, plan: forced(task.scene.objects[0], position=(-5.0, 0.1)),
    "empties the scene": lambda task, plan: forced(task.scene, objects=()),
    "wants another target": lambda task, plan: forced(task.scene, target=task.scene.ids[0]),
    "makes the shelf vast": lambda task, plan: forced(task.scene.shelf, depth=99.0, width=99.0),
    "wants another object of the goal": lambda task, plan: forced(task.goal, options=None),
    "narrows the arm": lambda task, plan: forced(task.arm, closed=(), link_width=0.0),
    "lifts the limits": lambda task, plan: forced(task.budget, seconds=1e9, simulations=10**9),
    "takes another scene": lambda task, plan: setattr(task, "scene", None),
}


def planner_of(deed: Callable[[Task, Plan], None]) -> Any:
    class Writes(PHIA):
        def search(self, task: Task) -> Plan:
            plan = super().search(task)
            deed(task, plan)
            return plan

    return Writes


@pytest.fixture(scope="module")
def expected() -> Episode:
    return run(RunSpec(SCENE))


def without_names(episode: Episode) -> tuple[Any, ...]:
    return (
        episode.scene,
        episode.status,
        episode.reason,
        episode.plans,
        episode.steps,
        episode.rejections,
        episode.clean,
    )


@pytest.mark.parametrize("name", DEEDS)
def test_a_planner_that_writes_into_what_it_was_given_changes_nothing(name: str, expected: Episode) -> None:
    assert without_names(run(RunSpec(SCENE, planner=planner_of(DEEDS[name])))) == without_names(expected)


def test_a_plan_that_is_changed_after_it_was_returned_stays_as_it_was(expected: Episode) -> None:
    kept: list[Plan] = []

    class Keeps(PHIA):
        def search(self, task: Task) -> Plan:
            kept.append(super().search(task))
            return kept[-1]

    class Late(PymunkPhysics):
        """Carries on when the plan is changed, as its author can do at any time."""

        def execute(
            self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
        ) -> Motion:
            for plan in kept:
                forced(plan, status=Status.FAILED, tree=None)
            return super().execute(trajectory, settle=settle, stop=stop, watch=watch)

    found = run(RunSpec(SCENE, planner=Keeps, backend=Late, plan_backend="pymunk"))
    assert without_names(found) == without_names(expected)


def test_a_backend_that_writes_into_what_it_was_given_or_gave_changes_nothing(expected: Episode) -> None:
    given: list[Any] = []

    class Writes(PymunkPhysics):
        def restore(self, state: State) -> State:
            found = super().restore(state)
            given.extend((state, found))
            return found

        def execute(
            self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
        ) -> Motion:
            motion = super().execute(trajectory, settle=settle, stop=stop, watch=watch)
            given.extend((trajectory, motion))
            return motion

        def observe(self) -> State:
            for each in given:
                spoil(each)
            given.append(super().observe())
            return given[-1]  # type: ignore[no-any-return]

    found = run(RunSpec(SCENE, backend=Writes, plan_backend="pymunk"))
    assert without_names(found) == without_names(expected)


def spoil(value: Any) -> None:
    """Make a value nonsense in place, as far as it goes."""
    for name in ("poses", "times", "openings"):
        array = getattr(value, name, None)
        if isinstance(array, np.ndarray):
            array.setflags(write=True)
            array[:] = np.nan
    for name, figure in (("duration", -1.0), ("stalled", True), ("held", "x"), ("force_limit", -1.0)):
        if hasattr(value, name) and not isinstance(getattr(type(value), name, None), property):
            object.__setattr__(value, name, figure)


def test_a_planner_cannot_lift_its_limits() -> None:
    class Insists(PHIA):
        simulated = 0

        def search(self, task: Task) -> Plan:
            forced(task.budget, simulations=None)
            first = super().search(task).actions[0]
            for _ in range(100):
                task.apply(task.start, first)
                Insists.simulated += 1
            raise AssertionError("unreachable")

    from phframe.core import Loop

    episode = run(RunSpec(SCENE, planner=Insists, loop=Loop(simulations=20)))
    assert (episode.status, Insists.simulated) == (
        Status.TIMEOUT,
        20 - (episode.cost.simulated_actions - Insists.simulated),
    )
    assert episode.cost.simulated_actions <= 20
