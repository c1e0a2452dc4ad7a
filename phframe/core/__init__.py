"""The language of phframe: data types, the abstract interfaces, Task and the errors. Depends on nothing else of ours."""

from phframe.core.arm import ArmModel, ArmShape, Fingers, Joint, Outline
from phframe.core.condition import condition_of
from phframe.core.corridor import Corridor, Rectangle, Sweep
from phframe.core.episode import Episode, Loop, Setup, Step
from phframe.core.errors import (
    ArmError,
    BudgetExceededError,
    IncompatibleError,
    InputError,
    NotInstalledError,
    OptionError,
    PhframeError,
    PluginError,
    SceneError,
    SimulationDivergedError,
    UnknownNameError,
)
from phframe.core.gripper_path import MOUTH_CLEARANCE, Action, Contacts, GripperPath, Phase, PhaseRule
from phframe.core.infeasible import Infeasible
from phframe.core.mesh import LinkMesh
from phframe.core.motion import FORCE_WINDOW, Contact, Motion, Transition
from phframe.core.motion_planner import MotionPlanner, Unreachable
from phframe.core.options import Options
from phframe.core.physics import Physics, Settle, Stop, SupportsPropagation, Watch
from phframe.core.plan import Cost, Decision, Plan, Status
from phframe.core.planner import Planner
from phframe.core.pose import compose, inverse, planar_pose, rotate, rotation_matrix, tilt_of, yaw_of
from phframe.core.scene import BasePose, Cylinder, Scene, SceneObject, Shape, Shelf, coulomb_with_board
from phframe.core.state import ArmState, Condition, State
from phframe.core.state_check import refuse_foreign
from phframe.core.suite import SceneSuite
from phframe.core.task import Budget, Task
from phframe.core.topology import PersistenceDiagram, TopologyEngine
from phframe.core.trajectory import GripperTrajectory, JointTrajectory, Trajectory, starting_from, time_path
from phframe.core.value import FloatArray, Floats, IntArray, Ints, Value

__all__ = [
    "FORCE_WINDOW",
    "MOUTH_CLEARANCE",
    "Action",
    "ArmError",
    "ArmModel",
    "ArmShape",
    "ArmState",
    "BasePose",
    "Budget",
    "BudgetExceededError",
    "Condition",
    "Contact",
    "Contacts",
    "Corridor",
    "Cost",
    "Cylinder",
    "Decision",
    "Episode",
    "Fingers",
    "FloatArray",
    "Floats",
    "GripperPath",
    "GripperTrajectory",
    "IncompatibleError",
    "Infeasible",
    "InputError",
    "IntArray",
    "Ints",
    "Joint",
    "JointTrajectory",
    "LinkMesh",
    "Loop",
    "Motion",
    "MotionPlanner",
    "NotInstalledError",
    "OptionError",
    "Options",
    "Outline",
    "PersistenceDiagram",
    "Phase",
    "PhaseRule",
    "PhframeError",
    "Physics",
    "Plan",
    "Planner",
    "PluginError",
    "Rectangle",
    "Scene",
    "SceneError",
    "SceneObject",
    "SceneSuite",
    "Settle",
    "Setup",
    "Shape",
    "Shelf",
    "SimulationDivergedError",
    "State",
    "Status",
    "Step",
    "Stop",
    "SupportsPropagation",
    "Sweep",
    "Task",
    "TopologyEngine",
    "Trajectory",
    "Transition",
    "UnknownNameError",
    "Unreachable",
    "Value",
    "Watch",
    "compose",
    "condition_of",
    "coulomb_with_board",
    "inverse",
    "planar_pose",
    "refuse_foreign",
    "rotate",
    "rotation_matrix",
    "starting_from",
    "tilt_of",
    "time_path",
    "yaw_of",
]
