"""A plan carried out, closed loop."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from phframe.core.action import Action, ActionKind
from phframe.core.decision import AnyDecision
from phframe.core.motion import Motion
from phframe.core.plan import Cost, Plan
from phframe.core.rejection import Rejection
from phframe.core.run_spec import AnyRunSpec
from phframe.core.scene import Scene
from phframe.core.state import Condition, State
from phframe.core.status import Status
from phframe.core.trajectory import Trajectory
from phframe.core.value import FloatArray, Value

MOVED = 1e-3
"""An object that an action displaced by more than this (m) was moved by it."""


@dataclass(frozen=True, slots=True, eq=False)
class Step(Value):
    """One action carried out.

    Attributes:
        action: What was to be done.
        trajectory: What was driven.
        before: The world before it, as it was.
        after: The world after it, as it was.
        expected: What the plan expected after it; None where nothing was predicted.
        motion: What happened.
        decision: Why the action was chosen.
        plan: Index of the episode's plan it comes from.
        seen: The world after it as the robot saw it; None: as it was.
    """

    action: Action
    trajectory: Trajectory
    before: State
    after: State
    expected: State | None
    motion: Motion
    decision: AnyDecision
    plan: int
    seen: State | None = None

    @property
    def prediction_errors(self) -> FloatArray:
        """Distance ``(k,)`` between expected and observed centre, of each object that moved or should have (m)."""
        if self.expected is None:
            return np.zeros(0)
        return prediction_errors(self.before, self.expected, self.after)


@dataclass(frozen=True, slots=True, eq=False)
class Episode(Value):
    """A plan carried out, closed loop: what was planned, what was done, what became of it.

    Attributes:
        scene: The scene.
        spec: With what it was run: registered names wherever there are, and options as values that differ from the defaults.
        status: How far it got.
        reason: Why no farther; empty where the target was retrieved.
        plans: All plans, the replans included.
        steps: All actions carried out.
        rejections: The actions that could not be carried out or came to nothing, and why.
        motion_planning_time: Wall time for planning joint trajectories (s); left out when episodes are compared.
        versions: Of Python, phframe, the plugins used, and the libraries behind them; left out likewise.
    """

    scene: Scene
    spec: AnyRunSpec
    status: Status
    reason: str
    plans: tuple[Plan, ...]
    steps: tuple[Step, ...]
    rejections: tuple[Rejection, ...] = ()
    motion_planning_time: float = field(default=0.0, compare=False)
    versions: Mapping[str, str] = field(default_factory=dict, compare=False)

    @property
    def final_state(self) -> State:
        """The world at the end."""
        return self.steps[-1].after if self.steps else self.scene.initial_state()

    @property
    def pushes(self) -> int:
        """Number of pushing actions carried out: the paper's number of actions."""
        return self.count(ActionKind.PUSH)

    def count(self, kind: ActionKind) -> int:
        """Number of actions of one kind carried out."""
        return sum(step.action.kind is kind for step in self.steps)

    @property
    def replans(self) -> int:
        """How often the planner was asked again."""
        return max(len(self.plans) - 1, 0)

    @property
    def cost(self) -> Cost:
        """What all plans together cost, and the planning of all joint trajectories."""
        plans = sum((plan.cost for plan in self.plans), Cost())
        return replace(plans, motion_planning=self.motion_planning_time)

    @property
    def execution_time(self) -> float:
        """Time the robot moved or waited for rest (simulated or real s)."""
        return sum((step.motion.duration for step in self.steps), 0.0)

    @property
    def tracking_error(self) -> float:
        """Largest distance between where the fingertip was meant to be and where it was (m)."""
        return max((step.motion.tracking_error for step in self.steps), default=0.0)

    @property
    def prediction_errors(self) -> FloatArray:
        """Distance between expected and observed centre of each object that an action moved, or should have (m)."""
        errors = [step.prediction_errors for step in self.steps if step.expected is not None]
        return np.concatenate(errors) if errors else np.zeros(0)

    @property
    def deviations(self) -> Counter[str]:
        """How often each deviation was used in the actions carried out."""
        return Counter(deviation for step in self.steps for deviation in step.decision.deviations)

    @property
    def toppled(self) -> tuple[str, ...]:
        """Ids of the objects that lie on their side."""
        return self._in_condition(Condition.TOPPLED)

    @property
    def spilled(self) -> tuple[str, ...]:
        """Ids of the objects that left the board, without a retrieved target."""
        return self._in_condition(Condition.SPILLED)

    def _in_condition(self, condition: Condition) -> tuple[str, ...]:
        pairs = zip(self.scene.ids, self.final_state.conditions, strict=True)
        return tuple(name for name, found in pairs if found is condition)

    @property
    def target_moved(self) -> float:
        """How far pushing displaced the target before the grasp (m)."""
        row, start = self.scene.target_index, self.scene.initial_state()
        pushed = [step.after for step in self.steps if step.action.kind is not ActionKind.GRASP]
        last = pushed[-1] if pushed else start
        return float(((last.poses[row, :3] - start.poses[row, :3]) ** 2).sum() ** 0.5)

    @property
    def wall_contact(self) -> bool:
        """Whether the arm ever touched a wall."""
        return any(step.motion.wall_contacts for step in self.steps)

    @property
    def clean(self) -> bool:
        """Retrieved, and no object other than the target toppled or left the board, and the arm touched no wall."""
        disordered = {*self.toppled, *self.spilled} - {self.scene.target}
        return self.status is Status.RETRIEVED and not disordered and not self.wall_contact


def prediction_errors(before: State, expected: State, after: State) -> FloatArray:
    """Distance ``(k,)`` between expected and observed centre, of each object that moved or should have (m)."""
    start, predicted, observed = (state.poses[:, :3] for state in (before, expected, after))
    moved = np.maximum(_distance(start, observed), _distance(start, predicted)) > MOVED
    return _distance(observed, predicted)[moved]


def _distance(a: FloatArray, b: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.norm(a - b, axis=1))
