"""What came of a trial: how its process ended, what the planner claimed, what the referee saw, and what it cost."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from enum import StrEnum

from phframe.core import InputError, RunSpec, Value

_UNWRITABLE = re.compile("[\0\ud800-\udfff]")
"""What UTF-8 or a database cannot hold: zero characters, and surrogates, as of undecodable output."""


class TrialEnd(StrEnum):
    """How the process of a trial ended."""

    FINISHED = "finished"
    """It gave an episode, whatever its status."""
    ERROR = "error"
    """An exception: bad input, something not installed, a planner or an engine that raised."""
    CRASHED = "crashed"
    """The process died: by a signal, or by an exit that nobody asked for."""
    KILLED = "killed"
    """It ran past its time limit and was killed."""
    MEMORY = "memory"
    """It asked for more memory than it may have."""


@dataclass(frozen=True, slots=True, eq=False)
class TrialResult(Value):
    r"""One row of a bench. Lengths in m, times in s, forces in N.

    Its texts can be written anywhere: a zero character or a lone surrogate in them becomes its escape, as in ``\x00``.

    Attributes:
        key: Of the trial.
        suite: The suite.
        problem: The scene, as ``suite/name``.
        planner: With its options that are not the default, as in ``phia[sweeps=paper]``.
        backend: What carried the plans out.
        arm: The arm that did.
        plan_backend: What was planned in.
        plan_arm: The arm that was planned with.
        seed: Of everything random.
        spec: The whole run as JSON, by which it can be repeated.
        end: How the process ended.
        claimed: What the last plan promised, a status; empty where there was none.
        status: What the referee saw, a status; empty where there is no episode.
        reason: Why no farther, or how the process died; empty where the target was retrieved.
        retrieved: Whether the goal was met, as the referee saw it.
        clean: Retrieved, nothing else toppled or spilled, no wall touched.
        pushes: Pushing actions carried out: the paper's number of actions.
        replans: How often the planner was asked again.
        rejections: Actions that could not be carried out or came to nothing.
        simulations: Simulated actions, of all plans.
        planning_time: Wall time of planning, all plans together.
        topology_time: Of which in the topology engine.
        simulation_time: Of which in simulated actions.
        motion_planning_time: Wall time of planning joint trajectories.
        first_solution_time: Planning time until the first plan that was worth carrying out; None: there was none.
        execution_time: Time the robot moved or waited for rest, in the world's time.
        displacement: Sum over the objects other than the target of how far each ended from where it stood.
        largest_displacement: The worst of these.
        toppled: How many objects other than the target lie on their side.
        spilled: How many left the board.
        target_moved: How far pushing displaced the target before the grasp.
        wall_contact: Whether the arm touched a wall.
        largest_force: Between the arm and what it touched.
        tracking_error: Largest distance of the fingertip from where it was meant to be.
        prediction_error: Median distance of a moved object from where the plan had it; None: nothing was predicted.
        largest_prediction_error: The worst of these.
        deviations: How often each deviation from the published method was used in what was carried out.
        wall_time: Of the whole trial.
        peak_memory: Of its process (bytes); 0: not known.
        started: When, in UTC, ISO 8601.
        environment: Id of where it ran: versions, commit, machine; see ``ResultStore.environments``.
    """

    key: str
    suite: str
    problem: str
    planner: str
    backend: str
    arm: str
    plan_backend: str
    plan_arm: str
    seed: int
    spec: str
    end: TrialEnd
    claimed: str = ""
    status: str = ""
    reason: str = ""
    retrieved: bool = False
    clean: bool = False
    pushes: int = 0
    replans: int = 0
    rejections: int = 0
    simulations: int = 0
    planning_time: float = 0.0
    topology_time: float = 0.0
    simulation_time: float = 0.0
    motion_planning_time: float = 0.0
    first_solution_time: float | None = None
    execution_time: float = 0.0
    displacement: float = 0.0
    largest_displacement: float = 0.0
    toppled: int = 0
    spilled: int = 0
    target_moved: float = 0.0
    wall_contact: bool = False
    largest_force: float = 0.0
    tracking_error: float = 0.0
    prediction_error: float | None = None
    largest_prediction_error: float | None = None
    deviations: Mapping[str, int] = field(default_factory=dict)
    wall_time: float = 0.0
    peak_memory: int = 0
    started: str = ""
    environment: str = ""

    def __post_init__(self) -> None:
        for each in fields(self):
            value = getattr(self, each.name)
            if type(value) is str and _UNWRITABLE.search(value):
                object.__setattr__(self, each.name, _writable(value))
        if any(map(_UNWRITABLE.search, self.deviations)):
            deviations = {_writable(name): count for name, count in self.deviations.items()}
            object.__setattr__(self, "deviations", deviations)


def _writable(text: str) -> str:
    return _UNWRITABLE.sub(lambda found: ascii(found[0])[1:-1], text)


def spec_of(result: TrialResult) -> RunSpec:
    """The run of a trial.

    Raises:
        InputError: If it cannot be read.
    """
    try:
        return RunSpec.from_json(result.spec)
    except InputError as error:
        raise InputError(
            f"the trial {result.key} has no run that can be read: its bench is damaged ({error})"
        ) from None
