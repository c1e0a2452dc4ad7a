"""A plan rehearsed in samples of what the world may be: how sure it is."""

from __future__ import annotations

from collections.abc import Sequence

from phframe.core import Action, ActionKind, Certainty, Particle, State, Transition
from phframe.pushing.harm import harm
from phframe.pushing.push_search import PushSearch


def rehearse(
    search: PushSearch, actions: Sequence[Action], particles: Sequence[Particle], clearance: float | None
) -> Certainty:
    """Simulate a plan in every sample, open loop, and count those in which it retrieves the target cleanly.

    Args:
        search: For whose task it is.
        actions: The plan's.
        particles: The samples.
        clearance: That the grasp keeps (m); None: not known.
    """
    clean = sum(_comes_off(search, actions, particle) for particle in particles)
    return Certainty(clearance, len(particles), clean)


def _comes_off(search: PushSearch, actions: Sequence[Action], particle: Particle) -> bool:
    state = particle.start
    for action in actions:
        made = particle.apply(state, action, None)
        if _fault(search, action, state, made):
            return False
        state = made.state
    return True


def _fault(search: PushSearch, action: Action, before: State, made: Transition) -> str:
    if action.kind is ActionKind.GRASP and (why := search.assess(action, made).reason):
        return why
    return harm(search.pushing.scene, before, made, None)
