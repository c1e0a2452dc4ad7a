"""Whether what a file says is an episode can be one: what runs are checked for while they are made."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import fields

from phframe.core import Cost, Episode, Plan, State, Step
from phframe.runtime.border import problem_of_action, problem_of_motion, problem_of_state, problems_of_plan


def problem_of_episode(episode: Episode) -> str | None:
    """Why something is no episode, in words that say where; None: it is one."""
    return next(_problems(episode), None)


def _problems(episode: Episode) -> Iterator[str]:
    if not 0.0 <= episode.motion_planning_time < math.inf:
        yield f"motion_planning_time is {episode.motion_planning_time!r}"
    for number, plan in enumerate(episode.plans):
        yield from (f"plans.{number}: {problem}" for problem in _of_plan(plan, episode))
    for number, step in enumerate(episode.steps):
        yield from (f"steps.{number}: {problem}" for problem in _of_step(step, episode))
    for number, rejection in enumerate(episode.rejections):
        if not 0 <= rejection.plan < len(episode.plans):
            yield f"rejections.{number}: there is no plan {rejection.plan}"


def _of_plan(plan: Plan, episode: Episode) -> Iterator[str]:
    yield from _of_cost(plan.cost)
    yield from problems_of_plan(plan, episode.scene)


def _of_cost(cost: Cost) -> Iterator[str]:
    for each in fields(cost):
        figure = getattr(cost, each.name)
        if not 0 <= figure < math.inf:
            yield f"the cost {each.name} is {figure!r:.60}"


def _of_step(step: Step, episode: Episode) -> Iterator[str]:
    if not 0 <= step.plan < len(episode.plans):
        yield f"there is no plan {step.plan}"
    states: dict[str, State | None] = {name: getattr(step, name) for name in ("before", "after", "expected", "seen")}
    for name, state in states.items():
        if state is not None and (problem := problem_of_state(state, episode.scene)) is not None:
            yield f"{name}: {problem}"
    for problem in (problem_of_action(step.action, episode.scene), problem_of_motion(step.motion)):
        if problem is not None:
            yield problem
