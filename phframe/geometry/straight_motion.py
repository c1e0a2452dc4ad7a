"""What an arm sweeps over as it goes straight in."""

from __future__ import annotations

import numpy as np

from phframe.core import FloatArray


def distances_on_way_in(points: FloatArray, lower: FloatArray, upper: FloatArray, length: float) -> FloatArray:
    """Distances ``(m, n)`` of points from the regions that parts of the arm sweep on a straight way in of a length (m).

    A region is bounded by the box around the part, drawn back along the way: parts are convex and narrow ahead, so the
    box is a close and safe bound.
    """
    ahead, across = (
        np.maximum(np.maximum(low[:, None] - points[:, axis], points[:, axis] - high[:, None]), 0.0)
        for axis, low, high in ((0, lower[:, 0] - length, upper[:, 0]), (1, lower[:, 1], upper[:, 1]))
    )
    return np.asarray(np.hypot(ahead, across))
