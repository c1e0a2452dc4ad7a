"""Random push: the floor that every other planner must beat."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from phframe.core import ROOT, Plan, Planner, Task
from phframe.pushing import Deviation, Proposal, PushingOptions, PushProblem, PushSearch, by_direction, is_unchanged


class RandomPush(Planner[PushingOptions]):
    """Sweeps a random obstacle of the corridor, alone, in a random direction, until the target is free.

    A sweep that moves nothing is left out of the plan, but counts as one of the ``max_actions`` attempts. ``patience`` is
    not used: chance may yet help.
    """

    options_type = PushingOptions

    def search(self, task: Task) -> Plan:
        """Sweep at random until the gripper can grasp the target."""
        search, node = PushSearch(task, self.options, grasp_rounds=self.options.max_actions), ROOT
        for attempts_left in range(self.options.max_actions, -1, -1):
            step = search.next_step(node)
            if not isinstance(step, PushProblem):
                return search.finish(node, step)
            if not attempts_left:
                break
            if (proposal := _propose(search, step)) is None:
                return search.fail(node, "no sweep fits beside any obstacle")
            tried = search.try_push(node, *proposal)
            if not is_unchanged(search.state(node), search.state(tried)):
                search.take(tried)
                node = tried
        return search.fail(node, f"the target is not free; attempts made: {self.options.max_actions}")


def _propose(search: PushSearch, problem: PushProblem) -> Proposal | None:
    """A random direction of the first obstacle, in random order, beside which a sweep fits."""
    for member in search.task.rng.permutation(len(problem.members)):
        ways = by_direction(search.pushing.sweeps(problem, np.array([member])))
        if ways:
            return _drawn(ways[search.task.rng.integers(len(ways))][0])
    return None


def _drawn(proposal: Proposal) -> Proposal:
    """The sweep as one that chance has drawn: its direction deviates from nothing."""
    decision, action = proposal
    deviations = tuple(each for each in decision.deviations if each != Deviation.OTHER_DIRECTION)
    return replace(decision, why="a random obstacle, in a random direction", deviations=deviations), action
