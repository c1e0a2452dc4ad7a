"""Those who look on while an episode runs. They read what is done; nothing depends on them."""

from __future__ import annotations

from collections.abc import Iterable

from phframe.core import ArmShape, Episode, Plan, Scene, Setup, State, Step

Frames = Iterable[tuple[float, State]]
"""Seconds since an action began, and the world then; replayed when they are asked for."""


class Observer:
    """Told of what happens, in this order; each method does nothing unless it is overridden."""

    def begin(self, scene: Scene, setup: Setup, arm: ArmShape) -> None:
        """An episode begins."""

    def planned(self, plan: Plan) -> None:
        """The planner returned a plan, the first or a replan."""

    def stepped(self, step: Step, frames: Frames) -> None:
        """An action was carried out."""

    def finished(self, episode: Episode) -> None:
        """The episode is over."""

    def close(self) -> None:
        """Nothing more will come, whether the episode is over or was interrupted."""
