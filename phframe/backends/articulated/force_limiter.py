"""Limits the net contact force of an arm through the torques of its joints.

An arm at rest that is pressed by a force F gives the torques tau = J^T F besides those that carry its weight (J: Jacobian
of the point of contact; Siciliano et al., Robotics: Modelling, Planning and Control, 2009, section 3.6). They are linear
in F: with all of them scaled by limit / |F|, the force is the limit.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from phframe.backends.articulated.engine import JointEngine
from phframe.core import ArmModel, FloatArray

MOMENT_ARM = 1.0
"""A joint that turns pushes at no more than this distance (m); one that slides pushes directly."""
ACCELERATION = 2.0
"""Acceleration (rad/s^2 or m/s^2) for which a joint keeps effort besides what the limit takes."""
LEAST_EFFORT = 0.05
"""Fraction of its effort that a joint keeps in any case, to hold itself."""
BRAKE = 1.5
"""Fraction of the limit above which the arm brakes."""
RECOVERY = 1.3
"""Factor by which joints get back their effort in every control step in which the force is below the limit."""


class ForceLimiter:
    """Takes effort from the joints while the arm touches something, and more while it presses harder than its limit.

    Args:
        engine: That moves the arm.
        arm: The arm.
        limit: Of the net contact force (N).
    """

    def __init__(self, engine: JointEngine, arm: ArmModel[Any], limit: float) -> None:
        self._engine, self._limit = engine, limit
        self._effort = np.array([joint.effort for joint in arm.joints])
        # |tau| <= |F| r for a joint that turns at a distance r; M qdd besides, so that it can still be moved.
        self._pushing = np.minimum(self._effort, limit * MOMENT_ARM + engine.arm().inertias * ACCELERATION)
        self._least = LEAST_EFFORT * self._effort
        self._caps: FloatArray | None = self._least
        self.release()

    def heed(self, force: float, *, touched: bool) -> bool:
        """Take or give back effort, after a control step.

        Args:
            force: On the arm, as the step ended (N).
            touched: Whether the arm has touched anything of late; what is hit may part from it for a moment.

        Returns:
            Whether the arm must brake with all it has: something hit hard takes the arm's momentum, too.
        """
        if force > BRAKE * self._limit:
            self.release()
            self._caps = self._least
            return True
        if force > self._limit:
            self._take(np.minimum(self._allowed, self._engine.arm().efforts * (self._limit / force)))
        elif not touched:
            self.release()
        elif self._caps is not self._pushing:
            more = self._allowed * RECOVERY
            self._take(self._pushing if (more >= self._pushing).all() else np.minimum(more, self._pushing))
        return False

    def release(self) -> None:
        """Give all joints their whole effort."""
        if self._caps is not None:
            self._engine.cap(self._effort)
            self._caps = None

    @property
    def _allowed(self) -> FloatArray:
        return self._effort if self._caps is None else self._caps

    def _take(self, caps: FloatArray) -> None:
        self._caps = caps if caps is self._pushing else np.maximum(caps, self._least)
        self._engine.cap(self._caps)
