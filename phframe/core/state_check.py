"""Whether a state is one of a scene and an arm: asked by every backend before it restores one."""

from __future__ import annotations

import numpy as np

from phframe.core.arm import ArmShape
from phframe.core.errors import InputError
from phframe.core.scene import Scene
from phframe.core.state import ArmState, State

GIVE = 5e-3
"""Fingers that are driven by forces overshoot their limits by less than this (m)."""


def refuse_foreign(scene: Scene, shape: ArmShape, state: State) -> None:
    """Refuse a state that cannot be restored.

    Args:
        scene: What the backend models.
        shape: Of its arm.
        state: To be restored.

    Raises:
        InputError: If it has another number of objects, poses that are not finite, or holds what is not there.
        ArmError: If the gripper cannot open as far as the state says.
    """
    count = len(scene.objects)
    if len(state.poses) != count:
        raise InputError(f"a state of {len(state.poses)} objects is not one of {scene.name!r}, which has {count}")
    if not np.isfinite(state.poses).all():
        raise InputError("a state holds poses that are not finite numbers")
    if state.held is not None and not state.on_board[scene.index(state.held)]:
        raise InputError(f"{state.held!r} cannot be held, since it has spilled")
    if state.arm is not None:
        _refuse_arm(shape, state.arm)


def _refuse_arm(shape: ArmShape, arm: ArmState) -> None:
    numbers = (*arm.gripper, arm.opening, arm.commanded_opening, *(() if arm.joints is None else arm.joints))
    if not np.isfinite(numbers).all():
        raise InputError("a state holds an arm whose pose, opening or joints are not finite numbers")
    if not shape.min_opening - GIVE <= arm.opening <= shape.max_opening + GIVE:
        shape.outlines(arm.opening)
