"""Sweeps that PHIA plans, and what becomes of them: what a backend predicts against what another one observes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any

import numpy as np

from phframe.bench.meters.tasks import retrieval_task
from phframe.core import Action, ActionKind, Scene, State
from phframe.core.episode import prediction_errors
from phframe.pushing import Corridor, PushDecision
from phframe.registry import Kind, create
from phframe.runtime.planning_world import PlanningWorld
from phframe.runtime.scenes import find_scene
from phframe.runtime.world import WorldSpec


@dataclass(frozen=True, slots=True, eq=False)
class PlannedSweep:
    """One planned sweep.

    Attributes:
        scene: Where.
        start: The state it starts from.
        action: What is done.
        corridor: What it is to clear.
    """

    scene: Scene
    start: State
    action: Action
    corridor: Corridor


@dataclass(frozen=True, slots=True)
class Prediction:
    """How well one sweep was predicted.

    Attributes:
        scene: Where.
        errors: Distances between predicted and observed centres of the objects that moved or should have (m).
        same_corridor: Whether the same objects are in the corridor afterwards.
    """

    scene: str
    errors: tuple[float, ...]
    same_corridor: bool


@dataclass(frozen=True, slots=True)
class Score:
    """How well some sweeps were predicted.

    Attributes:
        sweeps: How many.
        objects: How many objects moved or should have.
        median: Of the errors of all of them (m).
        mean: Likewise (m).
        worst: Likewise (m).
        fit: What is fitted: the geometric mean of error and 1 mm together, less 1 mm (m); a mean would be of the worst.
        same_corridor: In how many sweeps the same objects are in the corridor afterwards.
    """

    sweeps: int
    objects: int
    median: float
    mean: float
    worst: float
    fit: float
    same_corridor: int


def planned_sweeps(
    names: Sequence[str], options: Mapping[str, Any], *, scenes: Mapping[str, Any] | None = None, first: bool = False
) -> list[PlannedSweep]:
    """What PHIA plans in pymunk, the first sweep of each scene or all, whether the plan succeeds or not.

    Args:
        names: Of the scenes.
        options: Of pymunk.
        scenes: Options of the generator of scenes.
        first: Whether only the first sweep counts.
    """
    planner = create(Kind.PLANNER, "phia")
    found = []
    for name in names:
        scene = find_scene(name, scenes or {})
        with PlanningWorld(WorldSpec(scene, backend_options=options)) as world:
            plan = planner.plan(retrieval_task(world))
        state, sweeps = scene.initial_state(), []
        for action, expected, decision in zip(plan.actions, plan.expected, plan.decisions, strict=True):
            corridor = PushDecision.of(decision).corridor
            if action.kind is ActionKind.PUSH and corridor is not None:
                sweeps.append(PlannedSweep(scene, state.parked(), action, corridor))
            state = expected
        found += sweeps[:1] if first else sweeps
    return found


def outcomes(sweeps: Sequence[PlannedSweep], backend: str, options: Mapping[str, Any] | None = None) -> list[State]:
    """What a backend makes of each sweep."""
    found = []
    for sweep in sweeps:
        with PlanningWorld(WorldSpec(sweep.scene, backend, backend_options=options or {})) as world:
            found.append(world.apply(sweep.start, sweep.action).state)
    return found


def compare(sweeps: Sequence[PlannedSweep], predicted: Sequence[State], observed: Sequence[State]) -> list[Prediction]:
    """How well each sweep was predicted."""
    return [
        Prediction(
            sweep.scene.name,
            tuple(prediction_errors(sweep.start, expected, after).tolist()),
            bool((sweep.corridor.contains(expected.positions) == sweep.corridor.contains(after.positions)).all()),
        )
        for sweep, expected, after in zip(sweeps, predicted, observed, strict=True)
    ]


def score(predictions: Sequence[Prediction]) -> Score:
    """All sweeps together."""
    errors = np.array([error for prediction in predictions for error in prediction.errors])
    return Score(
        sweeps=len(predictions),
        objects=len(errors),
        median=float(median(errors)),
        mean=float(errors.mean()),
        worst=float(errors.max()),
        fit=float(np.exp(np.log(errors + 1e-3).mean()) - 1e-3),
        same_corridor=sum(prediction.same_corridor for prediction in predictions),
    )
