"""Why a push was chosen: the paper's corridor, persistence diagram, components, rectangle and sweep."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from phframe.core import Decision, Ints, PersistenceDiagram
from phframe.core.value import frozen_ints
from phframe.pushing.corridor import Corridor
from phframe.pushing.grouping import Rectangle
from phframe.pushing.sweep import Sweep


@dataclass(frozen=True, slots=True, eq=False)
class PushDecision(Decision):
    """Why a push, or the grasp at the end of them, was chosen. Fields that a planner has no use for stay empty.

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
        confirmed: Whether what came of it was simulated by the engine that executes, not by the one that plans are made in.
    """

    kind: ClassVar[str] = "push"

    corridor: Corridor | None = None
    members: tuple[str, ...] = ()
    diagram: PersistenceDiagram | None = None
    persistent_radii: tuple[float, ...] = ()
    radius: float | None = None
    labels: Ints | None = None
    chosen: tuple[str, ...] = ()
    rectangle: Rectangle | None = None
    sweep: Sweep | None = None
    confirmed: bool = False

    def __post_init__(self) -> None:
        if self.labels is not None:
            object.__setattr__(self, "labels", frozen_ints(self.labels))

    @classmethod
    def of(cls, decision: Decision | None) -> PushDecision:
        """A decision as one about pushes: itself, or one without the paper's data."""
        if isinstance(decision, PushDecision):
            return decision
        return cls() if decision is None else cls(decision.why, decision.deviations)
