"""One sample of what the world may be, where what is believed of it is uncertain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from phframe.core.action import Action
from phframe.core.motion import Transition
from phframe.core.physics import Stop
from phframe.core.state import State

Apply = Callable[[State, Action, Stop | None], Transition]
"""What an action makes of a state, in some world."""


@dataclass(frozen=True, slots=True, eq=False)
class Particle:
    """A sample of the world.

    Attributes:
        start: Where everything may really stand.
        apply: What actions make of states, were the friction what it is in this sample.
    """

    start: State
    apply: Apply
