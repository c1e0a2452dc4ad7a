"""Sure: a lazy best-first search for the fewest harmless pushes that lead to a clean grasp, at any angle."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import count
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from phframe.core import (
    ROOT,
    Action,
    Infeasible,
    Motion,
    Plan,
    Planner,
    State,
    Status,
    StopCause,
    Task,
    Transition,
)
from phframe.pushing import (
    WIDE_FAN,
    Confirmed,
    Deviation,
    Drive,
    Grasp,
    Grouping,
    KnownTransitions,
    Proposal,
    PushDecision,
    PushingOptions,
    PushSearch,
    Radii,
    ReachOfTarget,
    Rehearsals,
    closest_groups,
    cut_short,
    displacement_allowed,
    drives,
    harm,
    is_unchanged,
    target_pushes,
)

NEXT_BEST, TILTED, CUT, OF_TARGET, BY_WALL = 0.05, 0.02, 0.3, 3.0, 3.0
"""What a sweep that is not the best of its group, is tilted, is cut short, pushes the target, or makes way for a drive that a
wall blocks too adds to it (pushes)."""
AMPLE = 0.01
"""A grasp that keeps this clearance is as good as one that keeps more (m)."""
ALIKE = 0.002
"""States whose objects stand less than about this far apart are one (m)."""


class SureOptions(PushingOptions):
    """The shared ones, and one for each ingredient of the search.

    Attributes:
        half_width: Of the corridors, w (m); ``auto``: half the arm's link, the largest obstacle's radius and 4 mm.
        fan: Angles at which the target is driven at: ``wide``: the paper's and 0, 15, 30 and 45 degrees to either side;
            ``paper``: the paper's alone.
        grouping: Of what blocks a drive: ``homology``: the closest component at every radius that counts; ``single``: the
            closest object alone.
        radii: At which to group: ``all``: the usable radii, the threshold h, the last death, and each object alone;
            ``smallest``: PHIA's.
        directions: Of the sweeps of a group: ``both``, or the ``paper``'s best one.
        harmful: What becomes of a push that topples or spills something, stalls, touches a wall or moves the target by more
            than 20 mm, and of a grasp that is not clean: ``dead-end`` or ``allowed``.
        grasp: When the search ends: at the ``first`` grasp that is clean when it is simulated, or with an
            ``empty-corridor``, the paper's.
        target_pushes: Whether the target itself may be pushed where nothing else helps.
        confirm: Whether a plan is simulated in the engine that executes it, if that is another one, before the arm moves;
            one that does not come true there is a dead end.
        particles: Samples of the world in which a plan is rehearsed where noise is declared; 0: none.
        certain: Fraction of the samples in which a plan must be clean to be carried out at once.
        rehearsals: Plans that are rehearsed at most: then the surest of them is carried out.
        max_nodes: Nodes of the search tree after which to give up.
    """

    half_width: Annotated[float, Field(gt=0.0, le=1.0)] | Literal["auto"] = "auto"
    fan: Literal["paper", "wide"] = "wide"
    grouping: Grouping = "homology"
    radii: Radii = "all"
    directions: Literal["paper", "both"] = "both"
    harmful: Literal["dead-end", "allowed"] = "dead-end"
    grasp: Literal["first", "empty-corridor"] = "first"
    target_pushes: bool = True
    confirm: bool = True
    particles: Annotated[int, Field(ge=0, le=1000)] = 8
    certain: Annotated[float, Field(ge=0.0, le=1.0)] = 0.9
    rehearsals: Annotated[int, Field(ge=1, le=1000)] = 10
    max_nodes: Annotated[int, Field(ge=1, le=1_000_000)] = 400


class Sure(Planner[SureOptions]):
    """Searches for the fewest harmless pushes that lead to a clean grasp at any angle, and confirms them before the arm moves."""

    options_type = SureOptions

    def search(self, task: Task) -> Plan:
        """Best first, and lazily: drives are fitted with sweeps, and sweeps simulated, only when it is their turn."""
        return _LazySearch(task, self.options).run()


@dataclass(frozen=True, slots=True, eq=False)
class _Candidate:
    """What is to be tried from a node.

    Attributes:
        node: The node.
        drive: A drive to whose blocking obstacles sweeps are to be fitted; None: the target itself is to be pushed.
        push: A push that is to be simulated; None: it must be fitted first.
    """

    node: int
    drive: Drive | None = None
    push: Proposal | None = None


class _LazySearch:
    """One search. The estimate of a candidate is how many pushes a plan through it will have."""

    def __init__(self, task: Task, options: SureOptions) -> None:
        self._task, self._options = task, options
        self._search = PushSearch(task, options)
        self._pushing, self._tree = self._search.pushing, self._search.tree
        self._fan = WIDE_FAN if options.fan == "wide" else ()
        self._reach = ReachOfTarget(task, self._pushing, self._fan)
        self._known = KnownTransitions(task.earlier)
        confirmed = Confirmed(task, self._search, harmful=options.harmful == "allowed")
        self._confirmed = confirmed if options.confirm and task.confirms else None
        self._queue: list[tuple[float, int, _Candidate]] = []
        self._order = count()
        self._least: dict[int, int] = {}  # obstacles that block the freest drive, at each node
        self._seen = {_alike(task.start)}
        self._replaced: set[int] = set()  # nodes from whose twins the search goes on in their place
        self._rehearsals = Rehearsals(
            task, self._search, particles=options.particles, certain=options.certain, most=options.rehearsals
        )

    def run(self) -> Plan:
        """Try what promises the fewest pushes until a grasp succeeds."""
        plan = self._expand(ROOT)
        if (push := self._known.still_to_do) is not None and self._task.rejects(push[1]) is None:
            self._add(0.0, _Candidate(ROOT, push=push))
        while plan is None and self._queue and self._room and not self._reach.never:
            estimate, _, candidate = heapq.heappop(self._queue)
            if self._is_refuted(candidate.node):
                continue
            if candidate.push is None:
                self._fit(candidate)
            else:
                plan = self._push(estimate, candidate, candidate.push)
        return plan or self._rehearsals.surest() or self._failure()

    @property
    def _room(self) -> bool:
        return len(self._tree) < self._options.max_nodes

    def _failure(self) -> Plan:
        if self._reach.never:
            return self._search.fail(ROOT, self._reach.never)
        if self._room and len(self._tree) == 1 and not self._tree[ROOT].closed:
            return self._search.fail(ROOT, f"nothing that can be pushed helps: {self._obstruction()}")
        return self._search.exhausted(self._tree.deepest, "" if self._room else f"max_nodes={self._options.max_nodes}")

    def _obstruction(self) -> str:
        """What keeps the arm from the target at the start, on the first drive."""
        found = drives(self._pushing, self._task.start, self._fan)
        first = found[0].grasp if isinstance(found, list) and found else self._pushing.problem(self._task.start)
        return first.reason if isinstance(first, Infeasible) else "the corridor is not empty"

    def _expand(self, node: int) -> Plan | None:
        """Grasp from a node if that can be done; else queue what can be pushed there."""
        found = self._drives(node)
        if isinstance(found, Infeasible):
            self._tree.close(node, found.reason)
            return None
        if (plan := self._grasp(node, found)) is not None or self._is_over(node):
            return plan
        depth = self._tree.depth(node)
        if why := self._hopeless(node, found):
            self._tree.close(node, why)
            return None
        for drive in found:
            if drive.blocking and not self._reach.refuses(drive):
                cost = NEXT_BEST * drive.blocking + BY_WALL * drive.by_wall
                self._add(depth + 1 + cost, _Candidate(node, drive))
        if self._options.target_pushes:
            self._add(depth + 1 + (0.0 if all(drive.by_wall for drive in found) else OF_TARGET), _Candidate(node))
        return None

    def _hopeless(self, node: int, found: list[Drive]) -> str:
        """Why nothing more is to be pushed at a node, by the options ``max_actions`` and ``patience``; empty: go on."""
        self._least[node] = min((drive.blocking for drive in found), default=0)
        path = [ROOT, *self._tree.rows(node)]
        if len(path) > self._options.max_actions:
            return f"no grasp is clean after {len(path) - 1} actions"
        least = [self._least.get(row, len(self._pushing.scene.objects)) for row in path]
        idle = len(least) - 1 - least.index(min(least))
        return f"the last {idle} pushes took nothing out of the way" if idle >= self._options.patience else ""

    def _grasp(self, node: int, found: list[Drive]) -> Plan | None:
        """The plan that ends with a clean grasp from a node; a way out that stays between the walls comes first."""
        if self._options.grasp == "empty-corridor" and any(drive.blocking for drive in found[:1]):
            return None
        tried: set[bytes] = set()
        questions = self._reach.questions
        while (free := _least_hazard(found, tried)) is not None and not self._is_over(node):
            tried.add(_poses(free[1]))
            if (plan := self._try_grasp(node, *free)) is not None:
                return plan
            if (
                self._reach.questions > questions
            ):  # the arm reaches less than was thought: less deep grasps may take the place
                questions, again = self._reach.questions, self._drives(node)
                found = found if isinstance(again, Infeasible) else again
        return None

    def _drives(self, node: int) -> list[Drive] | Infeasible:
        state = self._search.state(node)
        return drives(self._pushing, state, self._fan, self._reach.rejects(state))

    def _try_grasp(self, node: int, drive: Drive, grasp: Grasp) -> Plan | None:
        """The plan that ends with a grasp from a node, if it is clean and comes true."""
        end, outcome = self._search.try_grasp(node, grasp)
        why = outcome.reason or harm(self._pushing.scene, self._search.state(node), self._made(end), None)
        if not why or (outcome.status is Status.RETRIEVED and self._options.harmful == "allowed"):
            return self._carried_out(node, end, drive, grasp)
        self._tree.close(end, why)
        self._learn(node, drive, grasp, self._tree[end].motion)
        return None

    def _is_over(self, node: int) -> bool:
        """Whether nothing is to be tried from a node any more: it does not come true, or not quite as it is."""
        return node in self._replaced or self._is_refuted(node)

    def _is_refuted(self, node: int) -> bool:
        """Whether what leads to a node does not come true where it is confirmed, or in too few samples of the world."""
        if self._confirmed is None:
            return self._rehearsals.refutes(node)
        return self._confirmed.refutes(node) or self._rehearsals.refutes(self._confirmed.known(node))

    def _carried_out(self, node: int, end: int, drive: Drive, grasp: Grasp) -> Plan | None:
        """The plan that ends with a grasp from a node, if it comes true in the engine and by the arm that execute."""
        if self._confirmed is None:
            unreachable = self._task.reachable(grasp.action, self._search.state(node))
            if unreachable is None:
                return self._sure(end, grasp)
            self._tree.close(end, unreachable.why)
            self._reach.ask(self._search.state(node), drive, grasp.action)
            return None
        twin = self._confirmed.of(node)
        if twin is None:
            return None
        if twin != node:  # the world is a little different there: look anew
            self._replaced.add(node)
            self._tree.close(node, "looked at anew as the engine that executes makes it")
            return self._expand(twin)
        confirmed, why = self._confirmed.apply(node, grasp.action, self._tree[end].decision)
        if not why:
            return self._sure(confirmed, grasp)
        self._tree.close(end, f"when confirmed: {why}")
        self._learn(node, drive, grasp, self._tree[confirmed].motion)
        return None

    def _learn(self, node: int, drive: Drive, grasp: Grasp, motion: Motion | None) -> None:
        """Where the arm could not follow a grasp from a node, look at what it can do."""
        if motion is not None and motion.stopped is not None and motion.stopped.cause is StopCause.UNREACHABLE:
            self._reach.ask(self._search.state(node), drive, grasp.action)

    def _sure(self, end: int, grasp: Grasp) -> Plan | None:
        """The plan that ends with a grasp; None where samples of the world make it so unsure that others are looked at."""
        return self._rehearsals.surest() if self._rehearsals.rehearse(end, grasp.clearance) else None

    def _fit(self, candidate: _Candidate) -> None:
        """Queue the sweeps that fit."""
        depth = self._tree.depth(candidate.node)
        for cost, push in self._of_target(candidate.node) if candidate.drive is None else self._sweeps(candidate.drive):
            self._add(depth + 1 + cost, replace(candidate, push=push))

    def _sweeps(self, drive: Drive) -> Iterator[tuple[float, Proposal]]:
        """The sweeps of all groups that block a drive, with what they add to the estimate."""
        problem = drive.problem
        for group in closest_groups(self._pushing, problem, self._options.grouping, self._options.radii):
            sweeps = list(self._pushing.sweeps(problem, group.chosen))
            if self._options.directions == "paper":
                sweeps = [each for each in sweeps if _direction(each) == _direction(sweeps[0])]
            for rank, (decision, action) in enumerate(sweeps):
                clears = Deviation.NOT_CLEARING not in decision.deviations
                left = drive.blocking - (len(group.chosen) if clears else 0)
                yield NEXT_BEST * rank + _cost(decision, left), (group.told_in(decision), action)

    def _of_target(self, node: int) -> Iterator[tuple[float, Proposal]]:
        """The pushes of the target itself, with what they add to the estimate."""
        for rank, push in enumerate(target_pushes(self._pushing, self._search.state(node))):
            yield OF_TARGET + NEXT_BEST * rank, push

    def _push(self, estimate: float, candidate: _Candidate, push: Proposal) -> Plan | None:
        """Simulate a push, and go on from where it leads unless that is a dead end."""
        parent, (decision, action) = candidate.node, push
        before = self._search.state(parent)
        made = self._known.of(before, action) or self._task.apply(before, action)
        node = self._tree.child(parent, action, made, decision)
        if why := self._dead_end(before, made, action):
            self._tree.close(node, why)
            shorter = cut_short(push, made, self._options) if made.motion.stalled else None
            if shorter is not None and self._task.rejects(shorter[1]) is None:
                self._add(estimate + CUT, replace(candidate, push=shorter))
            return None
        self._seen.add(_alike(made.state))
        return self._expand(node)

    def _dead_end(self, before: State, made: Transition, action: Action) -> str:
        """Why not to go on from a push; empty: go on."""
        if is_unchanged(before, made.state):
            return "nothing moved"
        scene = self._pushing.scene
        allowed = displacement_allowed(scene, action)
        if self._options.harmful == "dead-end" and (why := harm(scene, before, made, allowed)):
            return why
        return "leads to a state that was reached before" if _alike(made.state) in self._seen else ""

    def _made(self, node: int) -> Transition:
        found = self._tree[node]
        assert found.motion is not None, "it was simulated"
        return Transition(found.state, found.motion)

    def _add(self, estimate: float, candidate: _Candidate) -> None:
        heapq.heappush(self._queue, (estimate, next(self._order), candidate))


def _hazard(free: tuple[Drive, Grasp]) -> tuple[bool, float, int]:
    """What makes one grasp worse than another: its way out leads past a wall, little room, obstacles in the corridor."""
    drive, grasp = free
    return not grasp.withdraws_between_walls, -round(min(grasp.clearance, AMPLE), 3), drive.blocking


def _least_hazard(found: list[Drive], tried: set[bytes]) -> tuple[Drive, Grasp] | None:
    """The best grasp that was not tried, be it along another drive; None: there is none left."""
    free = ((drive, drive.grasp) for drive in found if isinstance(drive.grasp, Grasp))
    return min((each for each in free if _poses(each[1]) not in tried), key=_hazard, default=None)


def _poses(grasp: Grasp) -> bytes:
    return bytes(grasp.action.path.poses.tobytes())


def _cost(decision: PushDecision, left: int) -> float:
    """What a sweep adds to the estimate: a push for each obstacle that it leaves in the way."""
    tilted = decision.sweep is not None and decision.sweep.tilt != 0.0
    return left + TILTED * tilted


def _direction(push: Proposal) -> int:
    return 0 if push[0].sweep is None else push[0].sweep.direction


def _alike(state: State) -> bytes:
    """The same for states in which everything stands at about the same place."""
    return bytes(np.round(state.positions / ALIKE).astype(np.int64).tobytes())
