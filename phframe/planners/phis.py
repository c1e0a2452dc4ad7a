"""PHIS: persistent homology informed search (Algorithm 5)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, compress
from math import inf
from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from phframe.core import ROOT, Action, Assessment, Infeasible, Plan, Planner, Task, time_path
from phframe.pushing import Deviation, Grasp, Proposal, PushingOptions, PushProblem, PushSearch, by_direction


class PHISOptions(PushingOptions):
    """The shared ones, and how far the search goes.

    Attributes:
        directions: Of every group: ``paper``: the best sweep, in the paper's direction where that fits; ``both``: the best
            one in each.
        max_nodes: Nodes of the search tree after which no further push is tried; the best plan so far counts.
    """

    directions: Literal["paper", "both"] = "paper"
    max_nodes: Annotated[int, Field(ge=1, le=1_000_000)] = 200

    @field_validator("directions")
    @classmethod
    def _one_direction_in_the_paper(cls, directions: str, info: ValidationInfo) -> str:
        if directions == "both" and info.data.get("sweeps") == "paper":
            raise ValueError("the paper's sweep has one direction: leave out sweeps=paper, or directions=both")
        return directions


class PHIS(Planner[PHISOptions]):
    """Searches the sweeps of the closest component at all usable radii; the plan has the least total pushing time."""

    options_type = PHISOptions

    def search(self, task: Task) -> Plan:
        """Breadth-first, level by level, until no push that is left to try can lead to a quicker plan."""
        return _BreadthFirst(task, self.options).run()


_Push = tuple[int, bytes]


@dataclass(frozen=True, slots=True)
class _Choice:
    """Sweeps of one group from one node, best first, those that were tried already left out."""

    node: int
    sweeps: Iterator[Proposal]


class _BreadthFirst:
    """One search. A node's value is the total time of the pushes that lead to it (s)."""

    def __init__(self, task: Task, options: PHISOptions) -> None:
        self._task, self._options = task, options
        self._search = PushSearch(task, options)
        self._tree = self._search.tree
        self._tree.rate(ROOT, 0.0)
        self._left: dict[int, int] = {}  # blocking obstacles at a node
        self._made: dict[_Push, int] = {}  # the node that each simulated push led to
        self._spare: list[_Choice] = []  # of which a sweep was safe, in the order they were tried
        self._best: tuple[int, Assessment] | None = None
        self._best_time = inf
        self._failed_grasp: tuple[int, Assessment] | None = None

    def run(self) -> Plan:
        """Level after level; where that leads to no plan, from the next sweeps of the groups that were pushed."""
        level = self._push(self._choices([ROOT]))
        while level or (self._spare and self._best is None and self._room):
            choices, self._spare = (self._choices(level), self._spare) if level else (self._spare, [])
            level = self._push(choices)
        return self._result()

    def _choices(self, level: Sequence[int]) -> list[_Choice]:
        """What can be pushed at the nodes of a level, the one reached in the least time first; grasp where nothing must be."""
        return [choice for node in sorted(level, key=self._time) for choice in self._choices_at(node)]

    def _choices_at(self, node: int) -> list[_Choice]:
        """None where the node is closed, or grasped from."""
        step = self._search.next_step(node)
        if isinstance(step, Grasp):
            self._grasp(node, step)
        elif isinstance(step, Infeasible):
            self._tree.close(node, step.reason)
        elif why := self._search.hopeless(node, step):
            self._tree.close(node, why)
        elif choices := list(self._groups(node, step)):
            self._left[node] = len(step.members)
            return choices
        else:
            self._tree.close(node, "no sweep fits beside the closest component")
        return []

    def _groups(self, node: int, problem: PushProblem) -> Iterator[_Choice]:
        """The sweeps of the closest component at each radius, if there are any."""
        for found in self._search.pushing.pushes_at_all_radii(problem):
            for sweeps in self._ways(found):
                if (first := next(sweeps, None)) is not None:
                    yield _Choice(node, chain([first], map(_after_another, sweeps)))

    def _ways(self, sweeps: Iterator[Proposal]) -> list[Iterator[Proposal]]:
        """The sweeps of a group, by direction if both are asked for."""
        if self._options.directions == "paper":
            return [sweeps]
        return [iter(way) for way in by_direction(sweeps)]

    @property
    def _room(self) -> int:
        """How many nodes the tree may still get."""
        return max(0, self._options.max_nodes - len(self._tree))

    def _push(self, choices: list[_Choice]) -> list[int]:
        """Simulate the next sweep of each choice, again where that was not safe; returns the nodes of those that were."""
        level: list[int] = []
        while choices and self._room:
            ready, twins = self._ready(choices)
            nodes = self._simulate([(choice.node, sweep) for choice, sweep in ready])
            safe = [not self._tree[node].closed for node in nodes]
            level += compress(nodes, safe)
            self._spare += compress((choice for choice, _ in ready), safe)
            choices = [choice for (choice, _), fine in zip(ready, safe, strict=True) if not fine] + twins
        return level

    def _ready(self, choices: list[_Choice]) -> tuple[list[tuple[_Choice, Proposal]], list[_Choice]]:
        """The next sweep of each choice, and the choices whose next sweep is among these already: they wait for it."""
        ready: dict[_Push, tuple[_Choice, Proposal]] = {}
        twins = []
        for choice in choices:
            if (sweep := self._next(choice)) is None:
                continue
            if (push := _push_of(choice.node, sweep)) in ready:
                twins.append(_Choice(choice.node, chain([sweep], choice.sweeps)))
            else:
                ready[push] = (choice, sweep)
        return list(ready.values())[: self._room], twins

    def _next(self, choice: _Choice) -> Proposal | None:
        """The next sweep that may lead to a quicker plan than the best one; none where another radius led to it, and it is safe."""
        for sweep in choice.sweeps:
            made = self._made.get(_push_of(choice.node, sweep))
            if made is not None and self._search.penalty(made) == 0:
                self._spare.append(choice)
                return None
            if made is None and self._time(choice.node) + _least_time(sweep[1]) < self._best_time:
                return sweep
        return None

    def _simulate(self, pushes: Sequence[tuple[int, Proposal]]) -> list[int]:
        """The nodes that pushes lead to. Where the budget runs out among them, the first ones are in the tree."""
        nodes: list[int] = []
        while len(nodes) < len(pushes):
            made = self._search.try_frontier(pushes[len(nodes) :])
            for (parent, sweep), node in zip(pushes[len(nodes) :], made, strict=False):
                motion = self._tree[node].motion
                self._made[_push_of(parent, sweep)] = node
                self._tree.rate(node, self._time(parent) + (motion.duration if motion is not None else 0.0))
            nodes += made
        return nodes

    def _time(self, node: int) -> float:
        """Of the pushes that lead to a node (s)."""
        return self._tree[node].value or 0.0

    def _grasp(self, node: int, grasp: Grasp) -> None:
        """Grasp from a node, if the pushes that lead to it take less time than those of the best plan so far."""
        if self._time(node) >= self._best_time:
            return
        end, outcome = self._search.try_grasp(node, grasp)
        self._tree.rate(end, self._time(node))
        if outcome.status.is_success:
            self._best, self._best_time = (end, outcome), self._time(node)
            self._task.offer(self._tree.plan(end, outcome.status, outcome.reason))
            return
        self._tree.close(end, outcome.reason)
        self._failed_grasp = self._failed_grasp or (end, outcome)

    def _result(self) -> Plan:
        """The quickest plan that was found, else one whose grasp does not succeed, else how far it got."""
        if (found := self._best or self._failed_grasp) is None:
            nearest = min(self._left, key=lambda node: (self._left[node], node), default=ROOT)
            return self._search.exhausted(nearest, "" if self._room else f"max_nodes={self._options.max_nodes}")
        end, outcome = found
        self._tree.close_others(end, "leads to no quicker plan" if self._best else "leads to no grasp")
        return self._tree.plan(end, outcome.status, outcome.reason)


def _push_of(node: int, sweep: Proposal) -> _Push:
    """What decides what a sweep does: from where, and along which path."""
    return node, sweep[1].path.poses.tobytes()


def _after_another(sweep: Proposal) -> Proposal:
    """A sweep that is only tried where the one before it was not safe, or led to no plan."""
    decision, action = sweep
    return replace(decision, deviations=(*decision.deviations, Deviation.NEXT_SWEEP)), action


def _least_time(action: Action) -> float:
    """What a push takes at least (s): its path at full speed, without the way to its beginning and without settling."""
    return time_path(action.path, action.path.rule(0).opening, 1.0).duration
