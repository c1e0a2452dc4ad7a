"""How a scene, a world and a trajectory lie in arrays, for compiled code: names of the columns, and nothing else.

``n`` objects, ``p`` parts of the arm with ``v`` corners in all. Bodies are numbered: the objects as in the scene, then the
arm (``n``), then the walls (``n + 1``). What can touch is numbered for what the engine remembers of contacts: objects, parts
of the arm, what is held (``n + p``), three walls.
"""

from __future__ import annotations

from typing import NamedTuple

from phframe.core import FloatArray

SOUTH, NORTH, BACK = 0, 1, 2
"""Rows of the walls."""
WALL_NAMES = ("south wall", "north wall", "back wall")
WALL_THICKNESS = 0.1

# Columns of FastWorld.arm.
BODY_X, BODY_Y, YAW = 0, 1, 2
"""Where the arm is."""
CARRIER_X, CARRIER_Y, CARRIER_YAW = 3, 4, 5
"""Where it is told to be."""
ARM_VX, ARM_VY = 6, 7
OPENING, COMMAND = 8, 9
HELD = 10
"""Row of what is held, or -1."""
GRIP_X, GRIP_Y, GRIP_YAW = 11, 12, 13
"""Where that is in the fingertip frame."""
PARKED, RESTING, SATURATED = 14, 15, 16
"""Not placed yet; nothing moves; the drive gave all it has in the last step: 1 or 0."""
DRIVE_X, DRIVE_Y = 17, 18
"""The drive's force in the last step (N)."""
DRAG_X, DRAG_Y = 19, 20
"""What the board resists what is held with in the last step (N)."""
STEPS = 21
"""Number of steps since the world was restored, as contacts remember it."""
ARM_FIELDS = 22
"""What a state is; the rest are constants."""
STEP, LONGEST_STEP = 22, 23
ITERATIONS = 24
OBJECT_FRICTION, ARM_FRICTION, WALL_FRICTION = 25, 26, 27
ARM_MASS, STALL_LAG = 28, 29
DEPTH, WIDTH = 30, 31
MIN_OPENING = 32
SETTINGS = 33

# Columns of FastRun.figures.
TIME, BEFORE = 0, 1
"""Since the motion began (s): now, and before what was done last."""
LEG, LEG_TIME = 2, 3
STAGE = 4
FOLLOWING, HALTED, SETTLING, DONE = 0, 1, 2, 3
FOLLOWED = 5
LARGEST_FORCE, LARGEST_LAG, FORCE = 6, 7, 8
STALLED = 9
CAUSE, CAUSE_BODY, CAUSE_FORCE = 10, 11, 12
NO_CAUSE, FORCE_CAUSE, CONTACT_CAUSE = 0, 1, 2
CALM, SETTLE_BEGAN, SETTLED = 13, 14, 15
EVENTS = 16
FROM_X, FROM_Y, FROM_YAW = 17, 18, 19
"""The carrier's pose at the beginning of the leg."""
JUMPED = 20
"""Whether what was done last was a jump over what is free: 1 or 0."""
DIVERGED = 21
"""Row of an object faster than physics allows, or -1."""
WINDOW = 22
"""Next place in the force window."""
RUN_FIELDS = 23

# Columns of FastWorld.bodies. Objects, then arm and walls, of which only speeds and inverse masses are used.
X, Y, TURN = 0, 1, 2
VX, VY, SPIN = 3, 4, 5
PRESENT = 6
"""1 on the board or in the hand, 0 spilled."""
POSES = slice(X, TURN + 1)
SPEEDS = slice(VX, SPIN + 1)
VX_BEFORE, VY_BEFORE, SPIN_BEFORE = 7, 8, 9
"""Speeds at the beginning of the step."""
BY_MASS, BY_INERTIA = 10, 11
"""Inverse mass and inertia, as contacts see them."""
FLOOR_X, FLOOR_Y, FLOOR_TORQUE = 12, 13, 14
"""What the board resisted with in the last step (N, N, Nm)."""
AWAKE, BETWEEN, ORDER = 15, 16, 17
"""1 or 2 for what may move in this step; 1 for what stood between the fingers as they began to close; room for a list."""
RADIUS, MASS, INERTIA, MOST_FRICTION, FRICTION_LEVER = 18, 19, 20, 21, 22
"""Constants: metres, kg, kg m^2; mu m g (N); the lever c at which the board resists turning (m)."""
TOP = 23
"""How tall it is (m), less what only touches."""
BODY_FIELDS = 24

# Columns of FastWorld.parts.
SIDE, FIRST, END = 0, 1, 2
"""Which way it moves as the gripper opens; its first corner, and the one after its last."""
OWN_X, OWN_Y, REACH = 3, 4, 5
"""A circle around it, in the fingertip frame (m)."""
MIDDLE_X, MIDDLE_Y = 6, 7
"""Where that is in the shelf."""
BOTTOM = 8
"""Above the board (m): it passes over what is no taller."""
PART_FIELDS = 9

# Columns of FastWorld.corners; the first two are OWN_X and OWN_Y of a corner.
OWN_NX, OWN_NY = 5, 6
"""The outward normal of the edge that begins there."""
CORNER_X, CORNER_Y, EDGE_NX, EDGE_NY = 7, 8, 9, 10
"""All that in the shelf."""
CORNER_FIELDS = 11

# Columns of FastWorld.rows, the contacts of a step.
BODY_A, BODY_B, NORMAL_X, NORMAL_Y, GAP = 0, 1, 2, 3, 4
LEVER_A, LEVER_B = 5, 6
"""Radii of the discs; 0 for arm and walls."""
GIVEN_N, GIVEN_T = 7, 8
"""Speed of b against a that is given by how arm and fingers turn and open (m/s)."""
FRICTION = 9
IMPULSE_N, IMPULSE_T = 10, 11
LEAST = 12
"""Least speed of b away from a (m/s)."""
MASS_N, MASS_T = 13, 14
TOUCHER_A, TOUCHER_B = 15, 16
"""Numbers of what touches; -1: not remembered."""
ROW_FIELDS = 17

WINDOW_STEPS = 64
"""Steps kept for the mean of the force."""


# Columns of FastPath.legs.
AT, AT_X, AT_Y, AT_YAW, AT_OPENING, PHASE = 0, 1, 2, 3, 4, 5
LEG_FIELDS = 6

# Columns of FastPath.limits.
FORCE_LIMIT, STOP_FORCE, BRAKING, SETTLE_SPEED, SETTLE_HOLD, SETTLE_TIMEOUT = 0, 1, 2, 3, 4, 5
STOPS = 6
"""From here on 1 for each object and wall whose touch ends the motion."""


class FastWorld(NamedTuple):
    """A world, constants included, and room to compute in.

    Attributes:
        bodies: ``(n + 2, 24)``.
        arm: ``(33,)``.
        parts: ``(p, 9)``.
        corners: ``(v, 11)``.
        fingers: ``(f, 4)`` of each moving finger: side, least and greatest x, bottom above the board (m).
        rows: ``(r, 17)`` contacts.
        remembered: ``(t, t, 3)`` normal and tangential force of contacts in the last step they were in (N), and that step.
    """

    bodies: FloatArray
    arm: FloatArray
    parts: FloatArray
    corners: FloatArray
    fingers: FloatArray
    rows: FloatArray
    remembered: FloatArray


class FastPath(NamedTuple):
    """A trajectory, and when to end.

    Attributes:
        legs: ``(k + 1, 6)`` time (s), pose, opening (m), number of the phase of the leg that begins there.
        limits: ``(6 + n + 3,)`` force limit (N), force that stops (N), braking (m/s^2; 0: none), settling: speed (m/s; 0: none),
            hold, timeout (s); stops.
    """

    legs: FloatArray
    limits: FloatArray


class FastRun(NamedTuple):
    """How a motion goes.

    Attributes:
        figures: See the columns above.
        window: ``(64, 2)`` the last steps: their length (s) and the drive's impulse (N s).
        seen: ``(phases, p, n + 3)`` 1 for each contact that was noted.
        events: ``(phases * p * (n + 3), 4)`` those contacts: time (s), part, object or wall, leg.
    """

    figures: FloatArray
    window: FloatArray
    seen: FloatArray
    events: FloatArray
