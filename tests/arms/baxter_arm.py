"""Both arms of Baxter, and what Rethink Robotics' own model says of their kinematics."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from phframe.arms.baxter import Baxter, BaxterOptions
from phframe.arms.baxter.model import SIDES, Side
from phframe.core import FloatArray
from phframe.urdf.solids import rotation

__all__ = ["GOLDEN", "SIDES", "as_matrix", "baxter", "fingertip"]

GOLDEN: dict[str, Any] = json.loads((Path(__file__).parent / "data" / "baxter.json").read_text("utf-8"))


@cache
def baxter(side: Side) -> Baxter:
    return Baxter(BaxterOptions(side=side))


def fingertip(base_gripper: Any) -> FloatArray:
    """The fingertip's 4x4 pose for Rethink's frame of the gripper, in which z is ahead and x down."""
    turned = np.eye(4)
    turned[:3, :3] = rotation((0.0, -np.pi / 2.0, 0.0))
    return np.asarray(np.array(base_gripper) @ turned)


def as_matrix(pose: FloatArray) -> FloatArray:
    """The 4x4 form of a pose ``(7,)``."""
    w, x, y, z = pose[3:]
    placed = np.eye(4)
    placed[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    placed[:3, 3] = pose[:3]
    return placed
