"""All that ``phframe.core`` names."""

from phframe.core.action import Action, ActionKind
from phframe.core.advisor import NOBODY, Advisor, Hint, Question
from phframe.core.arm import GRAZING, ArmModel, ArmShape, Fingers, Joint, Outline
from phframe.core.condition import condition_of
from phframe.core.decision import Decision
from phframe.core.episode import Episode, Step
from phframe.core.errors import (
    ArmError,
    BudgetExceededError,
    DocumentError,
    IncompatibleError,
    InputError,
    NotInstalledError,
    OptionError,
    PhframeError,
    PluginError,
    SceneError,
    SimulationDivergedError,
    UnknownNameError,
    UnknownShapeError,
)
from phframe.core.explored_tree import ROOT, ExploredTree, SearchNode
from phframe.core.goal import Assessment, Attempt, Goal
from phframe.core.gripper_path import MOUTH_CLEARANCE, Contacts, GripperPath, Phase, PhaseRule, controlled_path
from phframe.core.infeasible import Infeasible
from phframe.core.mesh import LinkMesh
from phframe.core.motion import FORCE_WINDOW, Contact, Motion, StopCause, StopReason, Transition
from phframe.core.motion_planner import MotionPlanner, SupportsMotionPlanning, motion_planner_of
from phframe.core.options import Options
from phframe.core.particle import Particle
from phframe.core.physics import Physics, Settle, Stop, SupportsManySimulations, SupportsPropagation, Watch
from phframe.core.plan import Certainty, Cost, Plan
from phframe.core.planner import Planner
from phframe.core.pose import (
    compose,
    inverse,
    planar_pose,
    rotate,
    rotated_in_plane,
    rotation_matrix,
    seen_from_above,
    tilt_of,
    yaw_of,
)
from phframe.core.rejection import Rejection
from phframe.core.run_spec import Loop, RunSpec
from phframe.core.scene import Scene, coulomb_with_board, drag_on_board
from phframe.core.search_tree import SearchTree
from phframe.core.shape import Cylinder, Shape
from phframe.core.shelf import BasePose, SceneObject, Shelf
from phframe.core.state import ArmState, Condition, State
from phframe.core.state_check import refuse_foreign
from phframe.core.status import Status
from phframe.core.steering import Steering
from phframe.core.stored_name import StoredName
from phframe.core.suite import SceneSuite
from phframe.core.task import Budget, Task
from phframe.core.topology import PersistenceDiagram, TopologyEngine
from phframe.core.trajectory import GripperTrajectory, JointTrajectory, Trajectory, starting_from, time_path
from phframe.core.unreachable import Unreachable
from phframe.core.value import FloatArray, Floats, IntArray, Ints, Value

__all__ = [
    "FORCE_WINDOW",
    "GRAZING",
    "MOUTH_CLEARANCE",
    "NOBODY",
    "ROOT",
    "Action",
    "ActionKind",
    "Advisor",
    "ArmError",
    "ArmModel",
    "ArmShape",
    "ArmState",
    "Assessment",
    "Attempt",
    "BasePose",
    "Budget",
    "BudgetExceededError",
    "Certainty",
    "Condition",
    "Contact",
    "Contacts",
    "Cost",
    "Cylinder",
    "Decision",
    "DocumentError",
    "Episode",
    "ExploredTree",
    "Fingers",
    "FloatArray",
    "Floats",
    "Goal",
    "GripperPath",
    "GripperTrajectory",
    "Hint",
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
    "Particle",
    "PersistenceDiagram",
    "Phase",
    "PhaseRule",
    "PhframeError",
    "Physics",
    "Plan",
    "Planner",
    "PluginError",
    "Question",
    "Rejection",
    "RunSpec",
    "Scene",
    "SceneError",
    "SceneObject",
    "SceneSuite",
    "SearchNode",
    "SearchTree",
    "Settle",
    "Shape",
    "Shelf",
    "SimulationDivergedError",
    "State",
    "Status",
    "Steering",
    "Step",
    "Stop",
    "StopCause",
    "StopReason",
    "StoredName",
    "SupportsManySimulations",
    "SupportsMotionPlanning",
    "SupportsPropagation",
    "Task",
    "TopologyEngine",
    "Trajectory",
    "Transition",
    "UnknownNameError",
    "UnknownShapeError",
    "Unreachable",
    "Value",
    "Watch",
    "compose",
    "condition_of",
    "controlled_path",
    "coulomb_with_board",
    "drag_on_board",
    "inverse",
    "motion_planner_of",
    "planar_pose",
    "refuse_foreign",
    "rotate",
    "rotated_in_plane",
    "rotation_matrix",
    "seen_from_above",
    "starting_from",
    "tilt_of",
    "time_path",
    "yaw_of",
]
