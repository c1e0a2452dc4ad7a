"""Those who look on while an episode runs. They read what is done; nothing depends on them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, ClassVar

from phframe.core import ArmModel, ArmShape, BasePose, Episode, Plan, RunSpec, Scene, State, Step

Frames = Iterable[tuple[float, State]]
"""Seconds since an action began, and the world then: at its beginning, some thirty times a second, and at its end."""


@dataclass(frozen=True, slots=True)
class MountedArm:
    """The arm that carries out an episode, and where it stands.

    Attributes:
        model: The arm.
        base_pose: Where its base stands in the shelf frame.
        by_joints: Whether its joints are driven, so that the states give them; else its outline moves.
    """

    model: ArmModel[Any]
    base_pose: BasePose
    by_joints: bool

    @property
    def shape(self) -> ArmShape:
        """The arm seen from above."""
        return self.model.shape


class Observer:
    """Told of what happens, in this order; each method does nothing unless it is overridden."""

    title: ClassVar[str] = ""
    """What it is called when it fails; empty: as its class."""

    def mounting(self, done: int, of: int) -> None:
        """So many of so many base poses have been looked at, before an episode whose arm is to be mounted for the scene."""

    def begin(self, scene: Scene, spec: RunSpec, arm: MountedArm) -> None:
        """An episode begins."""

    def planning(self, seconds: float) -> None:
        """The planner is asked, the first time or again; it may take so long."""

    def planned(self, plan: Plan) -> None:
        """The planner returned a plan, the first or a replan."""

    def acting(self, seconds: float) -> None:
        """An action is about to be carried out; it may take so long of wall time."""

    def stepped(self, step: Step, frames: Frames) -> None:
        """An action was carried out."""

    def progressed(self, episode: Episode) -> None:
        """What there is of the episode: as it begins, and after every plan and every action."""

    def finished(self, episode: Episode) -> None:
        """The episode is over."""

    def interrupted(self, episode: Episode) -> None:
        """The episode ended early, by Ctrl-C or an error: what there is of it. It goes no further."""

    def close(self) -> None:
        """Nothing more will come, whether the episode is over or was interrupted."""
