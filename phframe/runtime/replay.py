"""Repeats an episode from what it says of itself, and tells the first thing that came out otherwise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from phframe.core import Cost, Episode, Hint, Question, RunSpec, State, Step
from phframe.runtime.files import content_of
from phframe.runtime.versions import versions_of


@dataclass(frozen=True, slots=True)
class Difference:
    """The first thing in which two episodes differ.

    Attributes:
        what: What it is, for people.
        step: Number of the step, from 1; None: it is not in a step.
        object: Id of the object that is farthest from where it was, if that is it.
        distance: How far it is from there (m); infinite where it is in another condition; None: nothing is elsewhere.
    """

    what: str
    step: int | None = None
    object: str | None = None
    distance: float | None = None

    def __str__(self) -> str:
        where = "" if self.step is None else f"step {self.step}: "
        how_far = "" if self.distance is None else f" by {self.distance:.3g} m"
        return f"{where}{self.what}{how_far}"


def spec_of(episode: Episode, **others: Any) -> RunSpec:
    """The run that repeats an episode.

    Args:
        episode: The episode, perhaps read from a file.
        others: Parts to take instead, such as ``backend="mujoco"``, with their default options; None: the same part.
            Where the episode was planned with the same arm or backend, so is the repetition, or, where that is another
            one, with what a new run would plan with.
    """
    spec = episode.spec
    wanted = {part: value for part, value in others.items() if value is not None}
    changed = {part for part, value in wanted.items() if value != getattr(spec, part)}
    for part, plan_part in (("arm", "plan_arm"), ("backend", "plan_backend")):
        if part in wanted and plan_part not in wanted and getattr(spec, plan_part) == getattr(spec, part):
            wanted[plan_part] = None if part in changed else wanted[part]
            changed |= {plan_part} if part in changed else set()
    options = {group: given for group, given in spec.options.items() if group not in {*changed, "scenes"}}
    return replace(spec, scene=episode.scene, options=options, **wanted)


class StoredAdvice:
    """Answers as an episode's planner was answered: the hints in its decisions, in the order in which they were given.

    Args:
        episode: The episode.
    """

    def __init__(self, episode: Episode) -> None:
        nodes = (node for plan in episode.plans if plan.tree is not None for node in plan.tree.nodes)
        hints = (node.decision.hint for node in nodes if node.decision is not None)
        self._hints = iter([hint for hint in hints if hint is not None])

    def advise(self, question: Question) -> Hint | None:
        """The next hint; None: there were no more."""
        return next(self._hints, None)


def first_difference(before: Episode, after: Episode) -> Difference | None:
    """The first thing in which an episode differs from the one it repeats; None: the two are the same, bit by bit."""
    for number, (old, new) in enumerate(zip(before.steps, after.steps, strict=False), start=1):
        if (difference := _of_steps(before, number, old, new)) is not None:
            return difference
    if len(before.steps) != len(after.steps):
        return Difference(f"{len(after.steps)} steps instead of {len(before.steps)}")
    if _outcome(before) != _outcome(after):
        return Difference(f"it ended {' '.join(_outcome(after))!r} instead of {' '.join(_outcome(before))!r}")
    return None if _written(before) == _written(after) else Difference("what was planned or decided is not the same")


def differing_versions(episode: Episode) -> dict[str, tuple[str, str]]:
    """Then and now, of all that an episode names and that has another version here."""
    now = versions_of(episode.spec)
    names = dict.fromkeys([*episode.versions, *now])
    pairs = {name: (episode.versions.get(name, "none"), now.get(name, "none")) for name in names}
    return {name: pair for name, pair in pairs.items() if pair[0] != pair[1]}


def _of_steps(episode: Episode, number: int, old: Step, new: Step) -> Difference | None:
    if old.action != new.action:
        return Difference(
            f"the action is {new.action.name!r} instead of {old.action.name!r}, or on another path", number
        )
    if old.trajectory != new.trajectory:
        return Difference("the trajectory is another one", number)
    if old.after != new.after:
        return _of_states(episode.scene.ids, number, old.after, new.after)
    return None if old.motion == new.motion else Difference("contacts, forces or times are not the same", number)


def _of_states(ids: Sequence[str], number: int, old: State, new: State) -> Difference:
    displacement = new.displacement(old)
    worst = int(displacement.argmax())
    if displacement[worst] == 0.0:
        return Difference("a turn, the arm or what is held is not the same", number)
    what = f"{ids[worst]} is elsewhere" if np.isfinite(displacement[worst]) else f"{ids[worst]} is in another condition"
    return Difference(what, number, ids[worst], float(displacement[worst]))


def _outcome(episode: Episode) -> tuple[str, str]:
    return str(episode.status), episode.reason


def _written(episode: Episode) -> Any:
    """All that an episode's file holds but what a repetition may change: wall times, versions, how the run is named."""
    plans = tuple(replace(plan, cost=Cost()) for plan in episode.plans)
    return content_of(replace(episode, spec=RunSpec(), versions={}, motion_planning_time=0.0, plans=plans))
