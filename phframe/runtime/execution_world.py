"""The world that plans are carried out in: it goes on from where it is, as a real robot does."""

from __future__ import annotations

from phframe.core import Motion, State, Trajectory
from phframe.runtime.world import World


class ExecutionWorld(World):
    """Executes one trajectory after another."""

    def start(self) -> State:
        """Put the world in the scene's initial state."""
        return self.physics.restore(self.scene.initial_state())

    def execute(self, trajectory: Trajectory) -> Motion:
        """Follow a trajectory from where the world is."""
        return self.follow(trajectory)

    def observe(self) -> State:
        """The world as it is now."""
        return self.physics.observe()
