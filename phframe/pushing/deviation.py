"""What phframe settles where the paper leaves something open, by name."""

from __future__ import annotations

from enum import StrEnum


class Deviation(StrEnum):
    """Phframe's deviations of what the paper leaves open, counted in every plan."""

    FALLBACK_RADIUS = "fallback radius"
    """No radius is usable, so the threshold h itself is taken."""
    ANGLED_EARLY = "angled corridor near a wall"
    """The target is farther than w from the wall, but what is in the straight corridor has no room beside it there."""
    SWEEP_CLAMPED = "sweep clamped to the wall"
    """The arm's true outline would meet a wall before its leading side reaches the corridor's edge."""
    LANE_CLAMPED = "lane clamped to the wall"
    """The lane beside the rectangle is too narrow for the arm, which goes in as near to it as fits."""
    LANE_SHIFTED = "lane shifted past the target"
    """The fingertip would stop short of everything, so it passes the target by instead."""
    TILTED = "arm tilted"
    """At the corridor's angle the walls keep the arm from clearing; at another angle they do not."""
    SPANS_CORRIDOR = "sweep from the nearer wall"
    """The rectangle spans the corridor, and the paper's direction does not clear it."""
    OTHER_DIRECTION = "other direction"
    """Nothing clears, or what does fails when simulated, in the paper's direction."""
    NOT_CLEARING = "sweep does not clear"
    """No sweep takes everything it pushes out of the corridor; this one at least moves it."""
    NEXT_SWEEP = "next sweep"
    """The sweep before it stalled, spilled something or moved nothing when it was simulated, or led to no plan in a search."""
    CUT_SHORT = "sweep cut short"
    """It stalled when it was simulated, so it ends a little before that."""
    GRASP_TURNED = "grasp turned"
    """The gripper deviates from the corridor's axis, past neighbours or a wall."""
    GRASP_TIGHT = "grasp with little room"
    """The fingers open less wide, or go less far past the target, than they would with more room."""
    GRASP_EARLY = "grasp before the corridor is empty"
    """Obstacles are still in the corridor, but none blocks the grasp; only with ``grasp_first``."""
    GRASP_BLOCKED = "grasp blocked"
    """The corridor is empty, but what stands beside the target keeps the fingers out; it joined the members."""
