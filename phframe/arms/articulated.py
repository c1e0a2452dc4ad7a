"""An arm of any joints: a URDF and a description say all there is to say, so that another robot is data, not code."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from phframe.core import (
    ArmError,
    ArmModel,
    ArmShape,
    BasePose,
    Fingers,
    FloatArray,
    Joint,
    MotionPlanner,
    NotInstalledError,
    Outline,
    Scene,
    Shelf,
    State,
    Unreachable,
    rotation_matrix,
)
from phframe.core.arm import LEAST_SERVED
from phframe.core.value import frozen_floats
from phframe.motion.mount_map import Told, best_mount, mount_map
from phframe.motion.options import AUTO, ArticulatedOptions
from phframe.motion.pinocchio_ import Kinematics
from phframe.motion.reachability import reachability
from phframe.motion.straight_reach import StraightReach
from phframe.urdf.description import ArmDescription, Section, read_description
from phframe.urdf.driven import driven_robot
from phframe.urdf.model import Robot
from phframe.urdf.outlines import gripper_outlines
from phframe.urdf.writer import robot_urdf

FRONT = 1e-3
"""What begins within this of the fingertips (m) goes in first."""

EXAMPLE = Path(__file__).parent / "example" / "arm.yaml"

OptionsT = TypeVar("OptionsT", bound=ArticulatedOptions)


class ArticulatedArm(ArmModel[OptionsT]):
    """An arm that is a URDF and a description."""

    @abstractmethod
    def describe(self) -> tuple[ArmDescription, Robot]:
        """The description, and the robot as its URDF has it.

        Raises:
            InputError: If they cannot be had.
        """

    @property
    def description(self) -> ArmDescription:
        """What is said of the arm besides its URDF."""
        return self._described[0]

    @property
    def robot(self) -> Robot:
        """The robot as it is driven, with the link ``fingertip``.

        Raises:
            InputError: If description and URDF cannot be had, or do not agree.
        """
        return self._described[1]

    def urdf(self) -> str:
        """The robot as it is driven; meshes are named by absolute paths."""
        return self._text

    @cached_property
    def joints(self) -> tuple[Joint, ...]:
        """As the URDF has them."""
        return tuple(_joint(self.robot, name) for name in self.description.joints)

    @cached_property
    def fingers(self) -> Fingers:
        """As the URDF has them."""
        left, right = (self.robot.joint(name) for name in self.description.fingers)
        names = self.description.fingers
        return Fingers((_joint(self.robot, names[0]), _joint(self.robot, names[1])), (left.child, right.child))

    @property
    def force_limit(self) -> float:
        """As described (N)."""
        return self.description.force_limit

    @cached_property
    def home(self) -> FloatArray:
        """As described."""
        return frozen_floats(self.description.home)

    @cached_property
    def shape(self) -> ArmShape:
        """The collision geometry that moves with the fingertip, and what is described of the arm behind.

        Raises:
            ArmError: If a finger has none, or nothing of the gripper is at the fingertip.
        """
        gripper = gripper_outlines(self.robot, self.tip_link, self.description.fingers)
        behind = (outline for section in self.description.behind for outline in _section(section))
        closed = (*gripper, *behind)
        front = max(float(outline.vertices[:, 0].max()) for outline in gripper)
        if front <= -FRONT:
            raise ArmError(
                f"the gripper's collision geometry ends {-front:.4g} m behind the fingertip: put 'tip' where the fingers end"
            )
        first = [outline for outline in gripper if outline.vertices[:, 0].max() > -FRONT]
        left = self.fingers.joints[0]
        travel = 2.0 * (left.upper - left.lower)
        return ArmShape(
            closed,
            _width([outline.opened(travel) for outline in closed]),
            _width(first),
            self.description.min_opening + travel,
            self.description.min_opening,
            self.description.height,
        )

    def forward(self, q: ArrayLike) -> FloatArray:
        """By the URDF's kinematics."""
        return self.kinematics.forward(self._joint_values(q))

    def inverse(self, pose: ArrayLike, seed: ArrayLike | None = None) -> FloatArray | None:
        """By descent from the seed, else from the nearest of thirty other starting points that gets there."""
        target = np.asarray(pose, dtype=np.float64)
        if target.shape != (7,) or not np.isfinite(target).all() or not target[3:].any():
            raise ArmError("a pose needs seven finite numbers: x y z, and a quaternion qw qx qy qz that is not zero")
        target = np.concatenate([target[:3], target[3:] / np.linalg.norm(target[3:])])
        return self.kinematics.inverse(target, None if seed is None else self._joint_values(seed))

    def default_base_pose(self, shelf: Shelf) -> BasePose:
        """So that the middle of the mouth is where the description wants it."""
        stand = self.description.shelf
        x, y = -rotation_matrix(-stand.yaw) @ np.array(stand.at[:2])
        return BasePose(float(x), shelf.width / 2.0 + float(y), -stand.at[2], 0.0 - stand.yaw)

    def motion_planner(self, scene: Scene, base_pose: BasePose) -> MotionPlanner[Any]:
        """Follows paths in the shelf, and plans collision-free joint paths with OMPL.

        Raises:
            UnknownNameError: If there is no such planner.
            NotInstalledError: If OMPL or TOPP-RA is not installed.
        """
        try:
            from phframe.motion.articulated import ArticulatedMotionPlanner
        except ModuleNotFoundError as error:
            library = (error.name or "phframe").partition(".")[0]
            if library == "phframe":
                raise
            wheels = "Linux x86-64 only" if library == "toppra" else "Linux and macOS"
            remedy = f'pip install "phframe[baxter]" (wheels for {wheels})'
            raise NotInstalledError(f"motion planning for {type(self).__name__}", library, remedy) from error

        return ArticulatedMotionPlanner(
            scene, self, base_pose, self.options, self.description, self.robot, self.kinematics
        )

    @property
    def mount(self) -> BasePose | None:
        """As the options have it."""
        return self.options.base_pose

    def variants(self) -> tuple[Self, ...]:
        """The arm with each of the options that a mount is chosen for, its own first."""
        return (self,)

    def mounted(self, scene: Scene, told: Told = lambda done, of: None) -> Self:
        """The arm where the reach of the scene's target is best, if that is to be looked for; else the arm itself."""
        if self.options.mount != AUTO:
            return self
        best = best_mount(mount_map(self.variants(), scene, told), scene, LEAST_SERVED)
        arm, base_pose = (self, self.default_base_pose(scene.shelf)) if best is None else (best.arm, best.base_pose)
        figures = base_pose.x, base_pose.y, base_pose.z, base_pose.yaw
        return type(self)(arm.options.model_copy(update={"mount": figures}))

    def out_of_reach(self, scene: Scene, state: State, base_pose: BasePose, object_id: str) -> Unreachable | None:
        """How far it gets towards an object at best; None: there is a yaw at which it gets there."""
        row = scene.index(object_id)
        reach = self.straight_reach(scene.shelf, base_pose)
        return reach.out_of_reach(state.positions[row].tolist(), float(scene.radii[row]))

    def straight_reach(self, shelf: Shelf, base_pose: BasePose) -> StraightReach:
        """Its straight ways into a shelf, empty."""
        parts = self.description, self.robot, self.kinematics, self.options
        return StraightReach(shelf, self, base_pose, *parts)

    def fraction_served(self, shelf: Shelf, base_pose: BasePose, enough: float = 1.0) -> float:
        """As ``phframe arm reach`` says it."""
        return reachability(shelf, self, base_pose, enough=enough).fraction

    @cached_property
    def kinematics(self) -> Kinematics:
        """Of the chain from the base to the fingertip."""
        return Kinematics(self.urdf(), self.description.joints, self.tip_link, self.home)

    @cached_property
    def _described(self) -> tuple[ArmDescription, Robot]:
        """The description and the robot as it is driven, found to agree."""
        description, robot = self.describe()
        return description, driven_robot(description, robot)

    @cached_property
    def _text(self) -> str:
        return robot_urdf(self.robot)

    def _joint_values(self, q: ArrayLike) -> FloatArray:
        values = np.asarray(q, dtype=np.float64)
        dof = len(self.description.joints)
        if values.shape != (dof,) or not np.isfinite(values).all():
            raise ArmError(f"the arm needs {dof} finite joint values ({', '.join(self.description.joints)})")
        return values


class DescribedArmOptions(ArticulatedOptions):
    """Where the description is, and how the arm moves.

    Attributes:
        description: A YAML file; it names the URDF's file. By default an example, to copy and to try.
    """

    description: Path = EXAMPLE


class DescribedArm(ArticulatedArm[DescribedArmOptions]):
    """The arm that a file describes."""

    options_type = DescribedArmOptions

    def describe(self) -> tuple[ArmDescription, Robot]:
        """What the files say."""
        return read_description(self.options.description)


def _joint(robot: Robot, name: str) -> Joint:
    joint = robot.joint(name).joint
    assert joint is not None, "found by its joint"
    return joint


def _section(section: Section) -> Iterator[Outline]:
    """A described part, straight between one width and the next; two at one distance are a step."""
    for (near, half_near), (far, half_far) in pairwise(section.widths):
        corners = [(-far, -half_far), (-near, -half_near), (-near, half_near), (-far, half_far)]
        if far > near:
            yield Outline(section.part, np.array(corners), 0, section.bottom, section.top)


def _width(outlines: list[Outline]) -> float:
    """Of the narrowest strip about the x axis that holds all outlines (m)."""
    return 2.0 * max(float(np.abs(outline.vertices[:, 1]).max()) for outline in outlines)
