"""Sure: a lazy best-first search for the fewest pushes that lead to a clean grasp, at any angle."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from itertools import count
from math import inf
from typing import Annotated, Literal

from pydantic import Field

from phframe.core import ROOT, Infeasible, Plan, Planner, Status, Task
from phframe.pushing import Deviation, Grasp, Proposal, PushingOptions, PushSearch, is_unchanged
from phframe.pushing.fan import WIDE, Drive, drives, swerve
from phframe.pushing.groups import Group, Grouping, Radii, closest_groups
from phframe.pushing.harm import MOVED_TARGET, harm


class SureOptions(PushingOptions):
    half_width: Annotated[float, Field(gt=0.0, le=1.0)] | Literal["auto"] = "auto"
    fan: Literal["paper", "wide"] = "wide"
    grouping: Grouping = "homology"
    radii: Radii = "all"
    directions: Literal["paper", "both"] = "both"
    harmful: Literal["dead-end", "allowed"] = "dead-end"
    grasp: Literal["first", "empty-corridor"] = "first"
    max_nodes: Annotated[int, Field(ge=1, le=1_000_000)] = 400


class Sure(Planner[SureOptions]):
    options_type = SureOptions

    def search(self, task: Task) -> Plan:
        return _LazySearch(task, self.options).run()


@dataclass(frozen=True, slots=True)
class _Candidate:
    """A push that was not simulated yet, or a drive whose pushes were not fitted yet."""

    node: int
    drive: Drive
    push: Proposal | None = None


class _LazySearch:
    def __init__(self, task: Task, options: SureOptions) -> None:
        self._task, self._options = task, options
        self._search = PushSearch(task, options)
        self._pushing, self._tree = self._search.pushing, self._search.tree
        self._queue: list[tuple[float, int, _Candidate]] = []
        self._order = count()
        self._seen: set[bytes] = set()

    def run(self) -> Plan:
        plan = self._expand(ROOT)
        while plan is None and self._queue and len(self._tree) < self._options.max_nodes:
            estimate, _, candidate = heapq.heappop(self._queue)
            if candidate.push is None:
                self._fit(candidate)
            else:
                plan = self._try(candidate, candidate.push)
        if plan is not None:
            return plan
        return self._search.exhausted(self._tree.deepest, "" if not self._queue else f"max_nodes={self._options.max_nodes}")

    def _expand(self, node: int) -> Plan | None:
        found = drives(self._pushing, self._search.state(node), WIDE if self._options.fan == "wide" else ())
        if isinstance(found, Infeasible):
            self._tree.close(node, found.reason)
            return None
        if (plan := self._grasp(node, found)) is not None:
            return plan
        if self._tree.depth(node) >= self._options.max_actions:
            self._tree.close(node, "max actions")
            return None
        for drive in found:
            if len(drive.problem.members) and not drive.by_wall:
                self._add(self._tree.depth(node) + 1 + 0.01 * len(drive.problem.members), _Candidate(node, drive))
        return None

    def _grasp(self, node: int, found: list[Drive]) -> Plan | None:
        grasps = [drive for drive in found if isinstance(drive.grasp, Grasp)]
        if self._options.grasp == "empty-corridor":
            grasps = [drive for drive in grasps if not len(found[0].problem.members)]
        grasps.sort(key=lambda drive: (swerve(self._pushing, drive.grasp) > 0.0, len(drive.problem.members)))
        for drive in grasps:
            end, outcome = self._search.try_grasp(node, drive.grasp)
            made = self._tree[end]
            why = outcome.reason or harm(self._pushing.scene, self._search.state(node), made, None)
            if outcome.status is Status.RETRIEVED and (not why or self._options.harmful == "allowed"):
                self._tree.close_others(end, "a shorter plan was found")
                return self._tree.plan(end, outcome.status, outcome.reason)
            self._tree.close(end, why)
        return None

    def _fit(self, candidate: _Candidate) -> None:
        depth = self._tree.depth(candidate.node)
        problem = candidate.drive.problem
        for group in closest_groups(self._pushing, problem, self._options.grouping, self._options.radii):
            ways = set()
            for rank, (decision, action) in enumerate(self._pushing.sweeps(problem, group.chosen)):
                direction = decision.sweep.direction
                if self._options.directions == "paper" and rank:
                    continue
                left = len(problem.members) - len(group.chosen)
                if Deviation.NOT_CLEARING in decision.deviations:
                    left += len(group.chosen)
                estimate = depth + 1 + (1 if left else 0) + 0.01 * left + 0.05 * rank + 0.02 * (abs(decision.sweep.tilt) > 0.0)
                grouped = replace(decision, radius=group.radius or None, diagram=group.diagram, labels=group.labels)
                self._add(estimate, _Candidate(candidate.node, candidate.drive, (grouped, action)))

    def _try(self, candidate: _Candidate, push: Proposal) -> Plan | None:
        before = self._search.state(candidate.node)
        node = self._search.try_push(candidate.node, *push)
        made = self._tree[node]
        if is_unchanged(before, made.state):
            return None
        if self._options.harmful == "dead-end" and (why := harm(self._pushing.scene, before, made)):
            self._tree.close(node, why)
            return None
        key = (made.state.positions * 500).round().tobytes()
        if key in self._seen:
            self._tree.close(node, "the same state was reached before")
            return None
        self._seen.add(key)
        if made.closed:
            self._search.take(node)
        return self._expand(node)

    def _add(self, estimate: float, candidate: _Candidate) -> None:
        heapq.heappush(self._queue, (estimate, next(self._order), candidate))
