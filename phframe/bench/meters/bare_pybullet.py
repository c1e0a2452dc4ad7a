"""A bare PyBullet loop that takes a world through what a backend took it through: the same commands, the same steps."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass, field
from typing import Any
from unittest.mock import patch

from phframe.backends.pybullet_.engine import PybulletEngine
from phframe.backends.pybullet_.output_capture import bullet
from phframe.backends.pybullet_.physics import PybulletPhysics

STEP = "stepSimulation"
WRITING = (
    STEP,
    "applyExternalForce",
    "changeConstraint",
    "changeDynamics",
    "createConstraint",
    "removeBody",
    "removeConstraint",
    "resetBasePositionAndOrientation",
    "resetBaseVelocity",
    "setCollisionFilterGroupMask",
    "setCollisionFilterPair",
    "setJointMotorControl2",
    "setJointMotorControlArray",
)
"""PyBullet's functions that change a world."""

Call = tuple[Callable[..., Any], tuple[Any, ...], dict[str, Any]]


@dataclass(slots=True)
class PybulletTape:
    """What a backend told the engine, in order.

    Attributes:
        calls: Functions of the engine and what they were given.
        steps: How many of them were steps.
        end: Where every body was in the end.
    """

    calls: list[Call] = field(default_factory=list)
    steps: int = 0
    end: tuple[Any, ...] = ()


def note(physics: PybulletPhysics, run: Callable[[], object]) -> PybulletTape:
    """Run something on a backend, and note what it tells the engine."""
    tape = PybulletTape()
    with ExitStack() as stack:
        for name in WRITING:
            stack.enter_context(patch.object(bullet, name, _noting(tape, name)))
        run()
    tape.end = _places(physics)
    return tape


def play(physics: PybulletPhysics, tape: PybulletTape) -> float:
    """Seconds of the bare loop, from where the backend's world is; it ends where the backend did, bit by bit."""
    calls = tape.calls
    began = time.process_time()
    for function, arguments, named in calls:
        function(*arguments, **named)
    seconds = time.process_time() - began
    assert _places(physics) == tape.end, "the bare loop ends where the backend did"
    return seconds


def _noting(tape: PybulletTape, name: str) -> Callable[..., Any]:
    function = getattr(bullet, name)

    def noting(*arguments: Any, **named: Any) -> Any:
        tape.calls.append((function, arguments, named))
        tape.steps += name == STEP
        return function(*arguments, **named)

    return noting


def _places(physics: PybulletPhysics) -> tuple[Any, ...]:
    engine = physics.world.engine
    assert isinstance(engine, PybulletEngine)
    client = engine.client
    bodies = [bullet.getBodyUniqueId(index, client) for index in range(bullet.getNumBodies(client))]
    return tuple(bullet.getBasePositionAndOrientation(body, client) for body in bodies)
