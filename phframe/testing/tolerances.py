"""How exact an implementation has to be: the one place where the kit's tolerances stand."""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class PhysicsTolerances:
    """How exact a physics engine has to be.

    Attributes:
        restored: How far an object may be from where ``restore`` was told to put it (m).
        untouched: How far an object at rest may wander while nothing touches it (m).
        height: How far an upright object's centre may be from half its height above the board (m).
        sunk: How far an object may be pressed into a wall, and the arm into an object (m).
        tracking: How far the fingertip may be from its trajectory in free space (m).
        stopping: Relative error of an object's stopping distance.
        stopping_slack: What a stopping distance may differ besides (m): softness of the contact it starts from.
        force: By which fraction the largest force may exceed the limit.
        load_speed: How fast a load is pushed to see whether it stalls the arm (m/s); slowly where the arm has a mass of its
            own, since what its momentum does to what it hits is not what it presses with.
        preload: Force on a stalled arm that is told to stand still (N).
        phantom_force: Force on an arm that touches nothing (N).
        slipped: How far an object may slip in the hand on its way out (m).
        stands_still: How far a stalled arm may creep in a second (m).
        repeatedly: How often a run is repeated to see whether it gives the same bits.
    """

    restored: float
    untouched: float
    height: float
    sunk: float
    tracking: float
    stopping: float
    stopping_slack: float
    force: float
    load_speed: float
    preload: float
    phantom_force: float
    slipped: float
    stands_still: float
    repeatedly: int = 3


PLANAR = PhysicsTolerances(
    restored=1e-9,
    untouched=1e-6,
    height=1e-9,
    sunk=2e-3,
    tracking=1e-3,
    stopping=0.10,
    stopping_slack=0.0,
    force=0.10,
    load_speed=0.25,
    preload=10.0,
    phantom_force=1e-9,
    slipped=2e-3,
    stands_still=1e-3,
)
"""Of an engine in the plane."""

SPATIAL = PhysicsTolerances(
    restored=1e-4,
    untouched=1e-3,
    height=2e-3,
    sunk=4e-3,
    tracking=8e-3,
    stopping=0.10,
    stopping_slack=1e-3,
    force=0.50,
    load_speed=0.1,
    preload=10.0,
    phantom_force=1.0,
    slipped=1e-2,
    stands_still=3e-3,
)
"""Of an engine in space, where contacts are soft and an arm is held by controllers."""

JOINTED = replace(SPATIAL, force=1.0, preload=25.0)
"""The same with an arm of joints, whose force is limited through their torques while links of some 10 kg move: 72 N of 40 N
were measured where it drives an object into a wall at 0.25 m/s, and 20 N on a stalled arm that is told to stand still."""

DIAGRAM = 2e-6
"""Of deaths, relative and absolute (m): engines compute with float32."""
FORWARD = 1e-4
"""Of a fingertip pose found by inverse kinematics: position (m) and quaternion."""
URDF = 1e-6
"""Between ``forward`` and the URDF's own kinematics: position (m) and quaternion."""
OUTLINE = 1e-3
"""Between an arm's outlines and the widths it declares (m)."""
OVERTIME = 1.0
"""By how much a planner may overrun its time limit (s): one simulated action."""
