"""The loop of GRTC (Papallas and Dogar 2020): drive straight at the target, move aside what that meets, drive again."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar

from phframe.core import ROOT, FloatArray, Hint, Infeasible, Phase, Plan, State, Task
from phframe.pushing.push_decision import PushDecision
from phframe.pushing.push_search import PushSearch
from phframe.pushing.straight_drive import StraightDrive, first_blocker, straight_drive
from phframe.pushing.straight_push import StraightPusher, StraightPushOptions


class GrtcDeviation(StrEnum):
    """Phframe's deviations of what the source of GRTC leaves open to straight pushes, counted in every plan."""

    MET_OTHERS = "others met on the way in"
    """Straight ways cannot go around: what stands in the arm's way to behind the object is pushed along."""


@dataclass(frozen=True, slots=True, eq=False)
class StraightPushDecision(PushDecision):
    """Why a single object is pushed straight to a place.

    Attributes:
        place: Where it is to stand: x, y in the shelf frame (m).
        hint: What the planner was told when it asked; None: it did not.
    """

    kind: ClassVar[str] = "straight push"

    place: tuple[float, float] | None = None
    hint: Hint | None = None


@dataclass(frozen=True, slots=True)
class Obstruction:
    """What blocks the straight drive at a node of the search.

    Attributes:
        node: The node.
        state: The world there.
        drive: The straight drive at the target.
        blocker: Id of the object that it meets first.
    """

    node: int
    state: State
    drive: StraightDrive
    blocker: str


MoveAside = Callable[[Obstruction], int | str]
"""The node to go on from once something was moved aside, or why that fails."""


class GrtcSearch:
    """One run of the loop for one task.

    Args:
        task: The task.
        options: The planner's.

    Attributes:
        search: The tree of what was tried.
        pusher: Makes the pushes.
    """

    def __init__(self, task: Task, options: StraightPushOptions) -> None:
        self._task, self._options = task, options
        self.search = PushSearch(task, options.pushing)
        self.pusher = StraightPusher(self.search.pushing, options)

    def run(self, move_aside: MoveAside) -> Plan:
        """Move aside what the straight drive meets until it meets nothing, then grasp.

        Args:
            move_aside: What tells one planner of this family from another.
        """
        node = ROOT
        while True:
            state, pushing = self.search.state(node), self.search.pushing
            drive = straight_drive(pushing, state)
            blocker = drive if isinstance(drive, Infeasible) else first_blocker(pushing, state, drive)
            if isinstance(drive, Infeasible) or isinstance(blocker, Infeasible):
                return self.search.fail(node, _reason(drive, blocker))
            if blocker is None:
                return self.search.grasp(node, drive.grasp)
            moved = self._moved(Obstruction(node, state, drive, blocker), move_aside)
            if isinstance(moved, str):
                return self.search.fail(node, moved)
            node = moved

    @property
    def spent(self) -> bool:
        """Whether as many pushes were simulated as may be."""
        return len(self.search.tree) > self._options.max_tries

    def _moved(self, met: Obstruction, move_aside: MoveAside) -> int | str:
        if (actions := self.search.tree.depth(met.node)) >= self._options.max_actions:
            return f"the straight drive still meets {met.blocker} after {actions} actions"
        if self.spent:
            return f"the straight drive still meets {met.blocker} after {self._options.max_tries} simulated pushes"
        return move_aside(met)

    def push(self, met: Obstruction, name: str, place: FloatArray, hint: Hint | None = None) -> int | str:
        """Try to push an object to a place; the new node, or why not. What was simulated stays in the tree, closed.

        Args:
            met: Where it is tried, and why.
            name: Id of the object.
            place: Where it is to stand ``(2,)`` (m).
            hint: What the planner was told, if it asked.
        """
        row, corridor = self.search.pushing.scene.index(name), met.drive.grasp.corridor
        action = self.pusher.push(met.state, row, place, corridor.angle)
        if isinstance(action, Infeasible):
            return action.reason
        if (rejection := self._task.rejects(action)) is not None:
            return f"{action.name} was rejected before: {rejection.reason}"
        decision = StraightPushDecision(
            f"the straight drive meets {met.blocker} first",
            corridor=corridor,
            members=(name,),
            chosen=(name,),
            place=(float(place[0]), float(place[1])),
            hint=hint,
        )
        tried = self.search.try_push(met.node, decision, action)
        return self._judged(tried, row, place)

    def _judged(self, node: int, row: int, place: FloatArray) -> int | str:
        """Close a push that did not do what it should; note what it met on the way in where it did."""
        found, tree, name = self.search.tree[node], self.search.tree, self.search.pushing.scene.ids[row]
        short = math.hypot(*(found.state.positions[row] - place))
        if not found.closed and not self.pusher.is_there(found.state, row, place):
            tree.close(node, f"{name} ended {short:.2f} m from its place")
        if closed := tree[node].closed:
            return f"{found.action.name if found.action else name}: {closed}"
        contacts = found.motion.contacts if found.motion else ()
        if any(contact.phase is Phase.INSERT and contact.body != name for contact in contacts):
            self.search.take(node, GrtcDeviation.MET_OTHERS)
        return node


def _reason(*answers: object) -> str:
    return next(answer.reason for answer in answers if isinstance(answer, Infeasible))
