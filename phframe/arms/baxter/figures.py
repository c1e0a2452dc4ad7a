"""Every figure of Baxter in one table. Metres, kilograms, radians, newtons, newton metres.

Kinematics, limits, masses and inertias are those of Rethink Robotics' model (baxter_common 1.2.0, the file with the
electric grippers); the collision geometry is primitives fitted to the surfaces of its meshes, not that model's own collision
cylinders, which are thinner than what they stand for. Frames are those of that model, except for the gripper's: see ``TIP_TURN``.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from phframe.urdf.solids import Inertia, Solid, Vector

RIGHT_ANGLE = pi / 2.0


@dataclass(frozen=True, slots=True)
class JointFigures:
    """A joint of an arm and the link that it carries; all turn about their own z.

    Attributes:
        joint: Its name, without the side.
        link: Its link's name, without the side.
        at: Of the joint in the link before (m).
        rpy: Rotation of the joint in the link before (rad).
        lower: Limit (rad).
        upper: Limit (rad).
        velocity: Limit (rad/s).
        effort: Limit (Nm).
        inertia: Of the link.
        collision_geometry: Of the link.
    """

    joint: str
    link: str
    at: Vector
    rpy: Vector
    lower: float
    upper: float
    velocity: float
    effort: float
    inertia: Inertia
    collision_geometry: tuple[Solid, ...]


def _along_x(part: str, radius: float, start: float, end: float) -> Solid:
    return Solid("cylinder", (radius, end - start), ((start + end) / 2.0, 0.0, 0.0), (0.0, RIGHT_ANGLE, 0.0), part)


def _along_z(part: str, radius: float, start: float, end: float) -> Solid:
    return Solid("cylinder", (radius, end - start), (0.0, 0.0, (start + end) / 2.0), part=part)


def _box(part: str, size: Vector, at: Vector) -> Solid:
    return Solid("box", size, at, part=part)


def _rail(part: str, y: float) -> Solid:
    """One of the two springs beside the shoulder, which lean forwards."""
    return Solid("box", (0.036, 0.03, 0.28), (0.081, y, 0.233), (0.0, 0.233, 0.0), part)


SHOULDER_AT: Vector = (0.024645, 0.219645, 0.118588)
"""Of the left arm on the torso; the right arm's y is negative."""
SHOULDER_YAW = 0.7854
"""Of the left arm; the right arm's is negative."""

SEGMENTS = (
    JointFigures(
        "s0",
        "upper_shoulder",
        (0.055695, 0.0, 0.011038),
        (0.0, 0.0, 0.0),
        lower=-1.70167993878,
        upper=1.70167993878,
        velocity=1.5,
        effort=50.0,
        inertia=Inertia(
            5.70044,
            (0.01783, 0.00086, 0.19127),
            (0.04709102262, 0.00012787556, 0.00614870039, 0.03766976455, 0.00078086899, 0.03595988478),
        ),
        collision_geometry=(
            _along_z("column", 0.088, 0.03, 0.33),
            Solid("cylinder", (0.066, 0.14), (0.069, 0.0, 0.27), (RIGHT_ANGLE, 0.0, 0.0), "nose"),
            _rail("left spring", 0.1265),
            _rail("right spring", -0.1265),
        ),
    ),
    JointFigures(
        "s1",
        "lower_shoulder",
        (0.069, 0.0, 0.27035),
        (-RIGHT_ANGLE, 0.0, 0.0),
        lower=-2.147,
        upper=1.047,
        velocity=1.5,
        effort=100.0,  # the model's 50 leaves out the spring that carries much of the 56 Nm of the arm's own weight
        inertia=Inertia(
            3.22698,
            (0.06845, 0.00269, -0.00529),
            (0.01175209419, -0.00030096398, 0.00207675762, 0.0278859752, -0.00018821993, 0.02078749298),
        ),
        collision_geometry=(_along_z("barrel", 0.073, -0.0975, 0.0975), _along_x("tail", 0.0762, 0.0, 0.121)),
    ),
    JointFigures(
        "e0",
        "upper_elbow",
        (0.102, 0.0, 0.0),
        (RIGHT_ANGLE, 0.0, RIGHT_ANGLE),
        lower=-3.05417993878,
        upper=3.05417993878,
        velocity=1.5,
        effort=50.0,
        inertia=Inertia(
            4.31272,
            (-0.00276, 0.00132, 0.18086),
            (0.02661733557, 0.00029270634, 0.00392189887, 0.02844355207, 0.0010838933, 0.01248008322),
        ),
        collision_geometry=(
            _along_z("tube", 0.079, 0.012, 0.20),
            _box("fork", (0.125, 0.154, 0.126), (-0.0295, 0.0, 0.263)),
            _box("fork's nose", (0.1, 0.082, 0.126), (0.083, 0.0, 0.263)),
        ),
    ),
    JointFigures(
        "e1",
        "lower_elbow",
        (0.069, 0.0, 0.26242),
        (-RIGHT_ANGLE, -RIGHT_ANGLE, 0.0),
        lower=-0.05,
        upper=2.618,
        velocity=1.5,
        effort=50.0,
        inertia=Inertia(
            2.07206,
            (0.02611, 0.00159, -0.01117),
            (0.00711582686, 0.00036036173, 0.0007459496, 0.01318227876, -0.00019663418, 0.00926852064),
        ),
        collision_geometry=(_along_z("barrel", 0.069, -0.0945, 0.0945), _along_x("tail", 0.070, 0.0, 0.092)),
    ),
    JointFigures(
        "w0",
        "upper_forearm",
        (0.10359, 0.0, 0.0),
        (RIGHT_ANGLE, 0.0, RIGHT_ANGLE),
        lower=-3.059,
        upper=3.059,
        velocity=4.0,
        effort=15.0,
        inertia=Inertia(
            2.24665,
            (-0.00168, 0.0046, 0.13952),
            (0.01667742825, 0.00018403705, 0.00018657629, 0.01675457264, -0.00064732352, 0.0037463115),
        ),
        collision_geometry=(
            _along_z("tube", 0.0742, -0.018, 0.215),
        ),  # the fork beyond it lies inside the next link's barrel
    ),
    JointFigures(
        "w1",
        "lower_forearm",
        (0.01, 0.0, 0.2707),
        (-RIGHT_ANGLE, -RIGHT_ANGLE, 0.0),
        lower=-1.57079632679,
        upper=2.094,
        velocity=4.0,
        effort=15.0,
        inertia=Inertia(
            1.60979,
            (0.06041, 0.00697, 0.006),
            (0.00387607152, -0.00044384784, -0.00021115038, 0.00700537914, 0.00015348067, 0.0055275524),
        ),
        collision_geometry=(_along_z("barrel", 0.059, -0.0856, 0.0824), _along_x("tube", 0.066, 0.055, 0.168)),
    ),
    JointFigures(
        "w2",
        "wrist",
        (0.115975, 0.0, 0.0),
        (RIGHT_ANGLE, 0.0, RIGHT_ANGLE),
        lower=-3.059,
        upper=3.059,
        velocity=4.0,
        effort=15.0,
        inertia=Inertia(
            0.35093,
            (0.00198, 0.00125, 0.01855),
            (0.00025289155, 0.00000575311, -0.00000159345, 0.0002688601, -0.00000519818, 0.0003074118),
        ),
        collision_geometry=(
            _along_z("flange", 0.0565, 0.054, 0.062),
            _along_z("neck", 0.039, 0.062, 0.1135),
            _box("camera", (0.030, 0.040, 0.0515), (0.040, 0.0, 0.08775)),
        ),
    ),
)
"""The seven joints of an arm, from the shoulder to the wrist, and their links."""

# --- the electric gripper, in the frame of the hand: z ahead, y across the fingers ---

HAND_AT: Vector = (0.0, 0.0, 0.11355)
"""Of the hand on the wrist."""
TIP_AT: Vector = (0.0, 0.0, 0.1577)
"""Of the fingertip on the hand: what Rethink's model calls ``left_gripper``. The rubber of the pads ends 3 mm farther."""
TIP_TURN: Vector = (0.0, -RIGHT_ANGLE, 0.0)
"""From Rethink's gripper frame (z ahead, y left, x down with a level gripper) to ours (x ahead, y left, z up)."""
HAND = Inertia(
    0.19125,
    (0.01093, 0.00042, -0.01532),
    (0.00017588, 0.00000147073, 0.0000243633, 0.00021166377, 0.00000172689, 0.00023745397),
)
GRIPPER_MASS = 0.3  # the model's moments are placeholders
GRIPPER_BODY = _box("body", (0.066, 0.1055, 0.0534), (-0.00565, 0.0, 0.0242))

# --- a narrow, extended finger in slot 3, in the axes of the fingertip (x ahead, y left), at its base; left ---

FINGER_MASS = 0.03  # the finger and its pad; the model's moments are placeholders
FINGER_LENGTH = 0.1127
FINGER_SLOT = 0.008
"""How far the closed finger's joint is from the middle: slot 3, so that things of 60 mm fit."""
FINGER_TRAVEL = 0.020833
FINGER_VELOCITY = 5.0  # nominal
FINGER_EFFORT = 20.0
FINGER_GEOMETRY = (
    _box("bar", (0.10755, 0.0135, 0.010), (0.058925, 0.01725, 0.0)),
    _box("pad", (0.0335, 0.0065, 0.042), (0.09595, 0.01275, 0.0)),
    _box("knuckle", (0.017, 0.048, 0.009), (0.0083, -0.002, 0.005)),
)
MIN_OPENING = 0.035
"""Between the pads of the closed fingers."""

# --- what stands still, in the frame of the base, which is the torso's ---

TORSO = Inertia(35.336455, (0.0, 0.0, 0.0), (1.849155, -0.000354, -0.154188, 1.662671, 0.003292, 0.802239))
TORSO_GEOMETRY = (
    _box("mounts", (0.156, 0.672, 0.16), (0.065, 0.0, 0.08)),
    _box("back", (0.205, 0.452, 0.64), (-0.1055, 0.0, 0.26)),
    _box("belt", (0.205, 0.32, 0.06), (0.0985, 0.0, 0.19)),
    _box("ledge", (0.05, 0.3, 0.02), (0.021, 0.0, 0.23)),
    _box("chest", (0.131, 0.15, 0.36), (0.0615, 0.0, 0.4)),
)
PEDESTAL = Inertia(
    60.86397744, (0.0, 0.0, 0.0), (5.0635929, 0.00103417, 0.80199628, 6.08689388, 0.00105311, 4.96191932)
)
PEDESTAL_GEOMETRY = (
    _box("feet", (0.914, 0.822, 0.3142), (-0.042, 0.0, -0.7671)),
    _along_z("post", 0.104, -0.61, -0.21),
    _along_z("cap", 0.19, -0.21, -0.06),
)
HEAD_AT: Vector = (0.06, 0.0, 0.686)
HEAD = Inertia(0.547767, (0.0, 0.0, 0.0), (0.004641, 0.000159, 0.000242, 0.003295, -0.001324, 0.003415))
HEAD_GEOMETRY = (Solid("sphere", (0.22,), (-0.02, -0.04, 0.064)), Solid("sphere", (0.22,), (-0.02, 0.04, 0.064)))
SCREEN_AT: Vector = (0.1227, 0.0, 0.0)
SCREEN_RPY: Vector = (1.75057, 0.0, RIGHT_ANGLE)
SCREEN = Inertia(0.440171, (0.0, 0.0, 0.0), (0.004006, 0.00023, 0.000002, 0.0028, 0.000029, 0.001509))

ALLOWED_COLLISIONS = (
    ("base", "{side}_upper_shoulder"),
    ("base", "{side}_lower_shoulder"),
    ("{side}_upper_shoulder", "{side}_upper_elbow"),
    ("{side}_upper_elbow", "{side}_upper_forearm"),
)
"""Links that the joints' limits keep apart on the real robot, though their geometry here, which is simpler, overlaps."""

IDLE = (1.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0)
"""Joints of the left arm parked outwards while the other one works."""

# --- how the left arm is used ---

HOME = (1.241881, 0.32302, -1.102181, 2.481017, 0.582613, -0.535103, 1.547004)
"""Gripper level, 3 cm before the mouth, 0.1 m outwards of its middle, 0.05 m below the gripper plane, where every
joint has room."""
MOUTH_AT: Vector = (0.675, 0.35, 0.2)
"""Middle of the shelf's mouth at the board, in the base; for the right arm y is negative. From maps of either arm at bases
5 and 10 cm aside, lower and farther away: with this one the right arm gets at all of the 31 published targets and out
again. Lower, the arm has to fold too much before the mouth; nearer, too; farther, the deep
corners are lost."""
GRIPPER_HEIGHT = 0.10
"""Of the gripper plane above the board: the forearm's barrel is 0.086 m from its axis."""
SEED_CONFIGURATIONS = (
    (1.21, 0.58, -1.4, 2.07, -0.44, -0.16, 2.6),
    (1.03, 0.69, -1.18, 2.41, -2.78, 0.69, -1.11),
)
"""Found among 100 that were tried on the pushes and grasps of the published scenes: one of these two leads to all that
any of them does, at the path's own yaw; the first to 92 %."""
FORCE_LIMIT = 40.0
"""What the fingertips can push sideways (N): the wrist gives 15 Nm, 0.387 m behind them."""
WIDTHS = (
    (0.219, 0.0665),  # the tube before the wrist
    (0.315, 0.067),
    (0.315, 0.075),  # the barrel, its axis nearly upright
    (0.42, 0.08),
    (0.44, 0.085),  # the forearm
    (0.75, 0.09),
)
"""Half-width by distance behind the fingertip of configurations that keep the forearm behind the gripper. The arm can
also be held wider; who plans its motion must choose."""
HALF_HEIGHT = 0.087
"""Of the arm behind the gripper, about the gripper plane."""
