"""What a planner returns: the actions, what is expected of them, why they were chosen, and what that cost."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from enum import StrEnum

from phframe.core.corridor import Corridor, Rectangle, Sweep
from phframe.core.errors import InputError
from phframe.core.gripper_path import Action
from phframe.core.state import State
from phframe.core.topology import PersistenceDiagram
from phframe.core.value import Ints, Value, frozen_ints


class Status(StrEnum):
    """How far it got."""

    RETRIEVED = "retrieved"
    """The target is out of the shelf and in the hand."""
    REACHED = "reached"
    """The gripper was at a grasp pose with the link free (the paper's success), but did not bring the target out."""
    CLEARED = "cleared"
    """The corridor is empty."""
    FAILED = "failed"
    """Nothing was found, or the target was lost; the reason says why."""
    TIMEOUT = "timeout"
    """The budget ran out first."""


@dataclass(frozen=True, slots=True, eq=False)
class Decision(Value):
    """Why an action was chosen. Fields that a planner has no use for stay empty.

    Attributes:
        corridor: The strip to be emptied.
        members: Ids of the obstacles considered, in the order of ``labels``: those in the corridor, and those that
            blocked the grasp.
        diagram: Of the members' centres.
        persistent_radii: Those that pass the margin test, ascending (m).
        radius: The one chosen (m).
        labels: The component of each member at that radius.
        chosen: Ids of the members of the component chosen.
        rectangle: Around the chosen.
        sweep: The push.
        deviations: Which of phframe's own deviations of what the paper leaves open were used, by name.
        parent: Index, among the plan's decisions, of the one before it in the search tree; None: it starts from the root.
    """

    corridor: Corridor | None = None
    members: tuple[str, ...] = ()
    diagram: PersistenceDiagram | None = None
    persistent_radii: tuple[float, ...] = ()
    radius: float | None = None
    labels: Ints | None = None
    chosen: tuple[str, ...] = ()
    rectangle: Rectangle | None = None
    sweep: Sweep | None = None
    deviations: tuple[str, ...] = ()
    parent: int | None = None

    def __post_init__(self) -> None:
        if self.labels is not None:
            object.__setattr__(self, "labels", frozen_ints(self.labels))


@dataclass(frozen=True, slots=True)
class Cost:
    """What planning cost.

    Attributes:
        total: Wall time (s).
        topology: Of which in the topology engine (s).
        simulation: Of which in simulated actions (s).
        motion_planning: Of which in motion planning (s).
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


@dataclass(frozen=True, slots=True, eq=False)
class Plan(Value):
    """What a planner returns, success or not.

    Attributes:
        status: How far the actions are expected to get.
        reason: Why no farther, for people; empty where the target is retrieved.
        actions: In order. The last may be the grasp.
        expected: The state expected after each action.
        decisions: Why each action was chosen, one per action.
        cost: What planning cost; left out when plans are compared.

    Raises:
        InputError: If there is not one expected state and one decision per action.
    """

    status: Status
    reason: str = ""
    actions: tuple[Action, ...] = ()
    expected: tuple[State, ...] = ()
    decisions: tuple[Decision, ...] = ()
    cost: Cost = field(default=Cost(), compare=False)

    def __post_init__(self) -> None:
        lengths = len(self.actions), len(self.expected), len(self.decisions)
        if len(set(lengths)) > 1:
            raise InputError(f"a plan needs one expected state and one decision per action, not {lengths}")

    @property
    def succeeded(self) -> bool:
        """Whether it is worth carrying out."""
        return self.status not in (Status.FAILED, Status.TIMEOUT)

    @property
    def deviations(self) -> Counter[str]:
        """How often each of phframe's own deviations of what the paper leaves open was used."""
        return Counter(deviation for decision in self.decisions for deviation in decision.deviations)
