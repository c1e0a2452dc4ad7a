"""What an earlier plan's search tree knows already: transitions that need not be simulated anew, and what was still to be done."""

from __future__ import annotations

import numpy as np

from phframe.core import Action, ActionKind, ExploredTree, State, Transition
from phframe.pushing.push_decision import PushDecision
from phframe.pushing.push_search import Proposal

Key = tuple[bytes, tuple[str, ...], str | None, bytes, bytes]


class KnownTransitions:
    """The transitions of a search tree. ``apply`` is pure, so one from the very same state need not be simulated again.

    What the engine that executes made of a state (see ``Confirmed``) is left out: ``apply`` is of another.

    Args:
        earlier: The tree, from where the world was expected to be now; None: nothing is known.
    """

    def __init__(self, earlier: ExploredTree | None) -> None:
        self._made: dict[Key, Transition] = {}
        self.still_to_do: Proposal | None = None
        """The push that was to come next."""
        if earlier is None:
            return
        for node in earlier.nodes:
            if PushDecision.of(node.decision).confirmed:
                continue
            if node.action is not None and node.motion is not None and node.parent is not None:
                key = _key(earlier.nodes[node.parent].state, node.action)
                self._made.setdefault(key, Transition(node.state, node.motion))
        following = next(iter(earlier.path), None)
        if following is not None and following.action is not None and following.action.kind is ActionKind.PUSH:
            self.still_to_do = PushDecision.of(following.decision), following.action

    def of(self, state: State, action: Action) -> Transition | None:
        """What an action makes of a state; None: that is not known."""
        return self._made.get(_key(state, action)) if self._made else None


def _key(state: State, action: Action) -> Key:
    """What decides what an action does: objects, what is held, the gripper, and the path."""
    arm = b"" if state.arm is None else state.arm.gripper.tobytes() + np.float64(state.arm.commanded_opening).tobytes()
    return state.poses.tobytes(), tuple(state.conditions), state.held, arm, action.path.poses.tobytes()
