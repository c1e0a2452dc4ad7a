"""What a planner returns: the actions, what is expected of them, why they were chosen, and what that cost."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Self

from phframe.core.action import Action
from phframe.core.decision import Decision
from phframe.core.explored_tree import ExploredTree, SearchNode
from phframe.core.motion import Motion
from phframe.core.state import State
from phframe.core.status import Status
from phframe.core.value import Value


@dataclass(frozen=True, slots=True)
class Cost:
    """What planning cost.

    Attributes:
        total: Wall time (s).
        topology: Of which in the topology engine (s).
        simulation: Of which in simulated actions (s).
        motion_planning: In planning joint trajectories (s).
        simulated_actions: How many actions were simulated.
    """

    total: float = 0.0
    topology: float = 0.0
    simulation: float = 0.0
    motion_planning: float = 0.0
    simulated_actions: int = 0

    def __add__(self, other: Cost) -> Cost:
        return Cost(
            self.total + other.total,
            self.topology + other.topology,
            self.simulation + other.simulation,
            self.motion_planning + other.motion_planning,
            self.simulated_actions + other.simulated_actions,
        )


@dataclass(frozen=True, slots=True)
class Certainty:
    """How sure a plan is.

    Attributes:
        clearance: Least distance that the arm, reaching for the target, keeps from obstacles and walls (m); None: not known.
        samples: In how many samples of the world the plan was simulated; 0: what is believed of it is certain.
        clean: In how many of those it retrieved the target cleanly.
    """

    clearance: float | None = None
    samples: int = 0
    clean: int = 0

    @property
    def share(self) -> float | None:
        """Fraction of the samples in which it was clean; None: there were none."""
        return self.clean / self.samples if self.samples else None


@dataclass(frozen=True, slots=True, eq=False)
class Plan(Value):
    """What a planner returns, success or not: a path through what it has tried.

    Attributes:
        status: How far the actions are expected to get.
        reason: Why no farther, for people; empty where the goal is met.
        tree: What was tried; the chosen path holds the actions. None: nothing was.
        cost: What planning cost; left out when plans are compared.
        certainty: How sure the planner is of it; None: it does not say.
    """

    status: Status
    reason: str = ""
    tree: ExploredTree | None = None
    cost: Cost = field(default=Cost(), compare=False)
    certainty: Certainty | None = None

    @classmethod
    def of(
        cls,
        status: Status,
        reason: str,
        start: State,
        steps: Iterable[tuple[Action, State] | tuple[Action, State, Decision]],
    ) -> Self:
        """A plan of actions one after another, without a search.

        Args:
            status: How far they are expected to get.
            reason: Why no farther.
            start: The state before the first.
            steps: The actions, the state expected after each, and why it was chosen.
        """
        nodes = [SearchNode(start)]
        for action, expected, *given in steps:
            decision = given[0] if given else Decision()
            nodes.append(SearchNode(expected, len(nodes) - 1, action, Motion(0.0), decision))
        return cls(status, reason, ExploredTree(tuple(nodes), len(nodes) - 1))

    @property
    def actions(self) -> tuple[Action, ...]:
        """The actions, in order."""
        return tuple(node.action for node in self._path if node.action is not None)

    @property
    def expected(self) -> tuple[State, ...]:
        """The state expected after each action."""
        return tuple(node.state for node in self._path)

    @property
    def decisions(self) -> tuple[Decision, ...]:
        """Why each action was chosen."""
        return tuple(node.decision for node in self._path if node.decision is not None)

    @property
    def succeeded(self) -> bool:
        """Whether it is worth carrying out."""
        return self.status not in (Status.FAILED, Status.TIMEOUT)

    @property
    def deviations(self) -> Counter[str]:
        """How often each deviation, where the published method leaves something open, was used."""
        return Counter(deviation for decision in self.decisions for deviation in decision.deviations)

    @property
    def _path(self) -> tuple[SearchNode, ...]:
        return () if self.tree is None else self.tree.path
