"""An arm in a shelf, seen at the yaws that planning asks for; each is worked out once."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from phframe.core import ArmShape, Outline, Shelf
from phframe.geometry.parts import Angles, stacked
from phframe.geometry.silhouette import Silhouette
from phframe.geometry.wall_clearance import WallClearance

KEPT_ANGLES, KEPT_VIEWS = 32, 32
"""How many angles, or lists of them, a view keeps, and how many views are kept: those used last."""


class ArmView:
    """The outlines of an arm between the walls of a shelf.

    Args:
        shelf: The shelf.
        outlines: Of the arm, with its fingers as they are while it moves.
        margin: Distance to be kept from the walls (m).
    """

    def __init__(self, shelf: Shelf, outlines: Sequence[Outline], margin: float) -> None:
        self.shelf, parts = shelf, stacked(outlines)

        @lru_cache(maxsize=KEPT_ANGLES)
        def walls(yaws: Angles) -> WallClearance:
            return WallClearance(shelf, parts, yaws, margin)

        @lru_cache(maxsize=KEPT_ANGLES)
        def silhouette(angles: Angles) -> Silhouette:
            return Silhouette(parts, angles)

        self.walls = walls
        """The walls as seen by the arm at a yaw in the shelf frame, or at several (rad)."""
        self.silhouette = silhouette
        """The arm turned by an angle against the frame it is looked at in, or by several (rad)."""
        self.boxes = parts.min(axis=1), parts.max(axis=1)
        """Least and greatest x and y of each part ``(m, 2)``, in the fingertip frame (m)."""


@lru_cache(maxsize=KEPT_VIEWS)
def arm_view(shelf: Shelf, arm: ArmShape, opening: float, margin: float) -> ArmView:
    """The view of an arm with its fingers ``opening`` (m) apart; the same one for the same shelf, arm, opening and margin.

    Raises:
        ArmError: If the gripper cannot open that far.
    """
    return ArmView(shelf, arm.outlines(opening), margin)
