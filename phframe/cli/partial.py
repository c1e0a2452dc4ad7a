"""What there is of an episode before it ends, so that an interruption loses nothing."""

from __future__ import annotations

from collections.abc import Iterable

from phframe.core import Episode, Plan, RunSpec, Scene, State, Status, Step
from phframe.runtime.observer import MountedArm, Observer
from phframe.runtime.versions import versions_of


class PartialEpisode(Observer):
    """Gathers plans and steps as they come."""

    def __init__(self) -> None:
        self._begun: tuple[Scene, RunSpec] | None = None
        self._plans: list[Plan] = []
        self._steps: list[Step] = []
        self._finished: Episode | None = None

    def begin(self, scene: Scene, spec: RunSpec, arm: MountedArm) -> None:
        """Keep what the episode is about."""
        self._begun = scene, spec

    def planned(self, plan: Plan) -> None:
        """Keep a plan."""
        self._plans.append(plan)

    def stepped(self, step: Step, frames: Iterable[tuple[float, State]]) -> None:
        """Keep a step; its frames are the recorder's."""
        self._steps.append(step)

    def finished(self, episode: Episode) -> None:
        """Keep the whole."""
        self._finished = episode

    def episode(self, reason: str) -> Episode | None:
        """The whole if it is over, else what there is, failed for the reason given; None before it began."""
        if self._finished is not None or self._begun is None:
            return self._finished
        scene, spec = self._begun
        plans, steps = tuple(self._plans), tuple(self._steps)
        return Episode(scene, spec, Status.FAILED, reason, plans, steps, versions=versions_of(spec))
