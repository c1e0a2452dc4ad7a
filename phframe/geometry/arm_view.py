"""An arm in a shelf, seen at the yaws that planning asks for; each is worked out once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np

from phframe.core import Outline, Shelf
from phframe.geometry.silhouette import Silhouette
from phframe.geometry.wall_clearance import WallClearance


class ArmView:
    """The outlines of an arm between the walls of a shelf.

    Args:
        shelf: The shelf.
        outlines: Of the arm, with its fingers as they are while it moves.
        margin: Distance to be kept from the walls (m).
    """

    def __init__(self, shelf: Shelf, outlines: Sequence[Outline], margin: float) -> None:
        self.shelf = shelf
        self.walls = cache(lambda yaw: WallClearance(shelf, outlines, yaw, margin))
        """The walls as seen by the arm at a yaw in the shelf frame (rad)."""
        self.silhouette = cache(lambda angle: Silhouette(outlines, angle))
        """The arm turned by an angle against the frame it is looked at in (rad)."""
        vertices = [outline.vertices for outline in outlines]
        self.boxes = (
            np.array([part.min(axis=0) for part in vertices]),
            np.array([part.max(axis=0) for part in vertices]),
        )
        """Least and greatest x and y of each part ``(m, 2)``, in the fingertip frame (m)."""
