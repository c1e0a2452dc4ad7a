"""The published scenes, solved once for all tests of a session."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

from phframe.bench.meters.outcomes import Outcome, run_suite
from phframe.core import ROOT, ActionKind, Episode, Plan, Scene, State
from phframe.pushing import Corridor, PushDecision
from phframe.runtime.scenes import scene_names

PLANNERS = ("phia", "ooa")
PUBLISHED = tuple(name for name in scene_names() if name.startswith(("vieira", "papallas")))


@cache
def outcomes(planner: str) -> tuple[Outcome, ...]:
    """One planner on the 31 published scenes."""
    return tuple(run_suite(planner, PUBLISHED, lambda scene: None))


def episodes(planner: str) -> list[Episode]:
    return [outcome.episode for outcome in outcomes(planner)]


def pushes(planner: str) -> Iterator[tuple[Scene, State, PushDecision, Corridor]]:
    """Every push of every plan: the scene, the state before it, why it was chosen, and its corridor."""
    for episode in episodes(planner):
        for plan in episode.plans:
            assert plan.tree is not None
            states = [plan.tree.nodes[ROOT].state, *plan.expected]
            for before, decision, action in zip(states, plan.decisions, plan.actions, strict=False):
                if action.kind is ActionKind.PUSH:
                    assert isinstance(decision, PushDecision)
                    assert decision.corridor is not None
                    yield episode.scene, before, decision, decision.corridor


def plan_of(planner: str, scene: str) -> Plan:
    """The first plan for a published scene."""
    return next(outcome.episode.plans[0] for outcome in outcomes(planner) if outcome.scene == scene)
