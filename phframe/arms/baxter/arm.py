"""Baxter as an articulated arm: its table of figures as a URDF and a description."""

from __future__ import annotations

from typing import Self

from phframe.arms.articulated import ArticulatedArm
from phframe.arms.baxter import figures
from phframe.arms.baxter.model import SIDES, Side, arm_joints, baxter_robot, fingers, mirrored
from phframe.core import LinkMesh
from phframe.motion.options import ArticulatedOptions
from phframe.urdf.description import ArmDescription, Section, Stand
from phframe.urdf.model import Robot


class BaxterOptions(ArticulatedOptions):
    """Which arm works, and how it moves.

    Attributes:
        side: Left or right; the other one is parked outwards. The shelf stands before the one that works. Where the mount
            is ``auto``, the side is chosen with it.
    """

    side: Side = "right"


class Baxter(ArticulatedArm[BaxterOptions]):
    """One arm of Baxter, with the electric gripper: narrow fingers, 0.11 m long, for things 35 to 76 mm wide."""

    options_type = BaxterOptions

    def describe(self) -> tuple[ArmDescription, Robot]:
        """From the table of figures."""
        side = self.options.side
        return _description(side), baxter_robot(side)

    def variants(self) -> tuple[Self, ...]:
        """Either arm, the chosen one first."""
        sides = sorted(SIDES, key=lambda side: side != self.options.side)
        return tuple(type(self)(self.options.model_copy(update={"side": side})) for side in sides)

    def meshes(self) -> tuple[LinkMesh, ...]:
        """Rethink's, where the extra ``meshes`` is installed."""
        from phframe.arms.baxter.meshes import baxter_meshes

        return baxter_meshes(self.options.side)


def _description(side: Side) -> ArmDescription:
    left, (x, y, z) = side == "left", figures.MOUTH_AT
    finger_joints = fingers(side).joints
    half = figures.HALF_HEIGHT
    return ArmDescription(
        joints=tuple(joint.name for joint in arm_joints(side)),
        fingers=(finger_joints[0].name, finger_joints[1].name),
        min_opening=figures.MIN_OPENING,
        home=figures.HOME if left else mirrored(figures.HOME),
        shelf=Stand(at=(x, y if left else -y, z)),
        height=figures.GRIPPER_HEIGHT,
        seed_configurations=tuple(q if left else mirrored(q) for q in figures.SEED_CONFIGURATIONS),
        force_limit=figures.FORCE_LIMIT,
        behind=(Section(part="forearm", widths=figures.WIDTHS, bottom=-half, top=half),),
        allowed_collisions=tuple(
            (a.format(side=arm), b.format(side=arm)) for arm in SIDES for a, b in figures.ALLOWED_COLLISIONS
        ),
    )
