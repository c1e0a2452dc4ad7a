"""The paper's method: corridor, persistence, grouping, sweeps, grasp, and the goal to retrieve.

This is the public list: what planners, phframe's own and those of plugins, are made of.
"""

from phframe.pushing.clearing import ChooseRadius, Clearing
from phframe.pushing.corridor import Corridor, corridor_half_width, find_corridor
from phframe.pushing.deviation import Deviation
from phframe.pushing.grasp import Grasp, GraspFinder, grasp_action
from phframe.pushing.grouping import Rectangle, bounding_rectangle, closest_component
from phframe.pushing.grtc import GrtcDeviation, GrtcSearch, Obstruction, StraightPushDecision
from phframe.pushing.options import ClearingOptions, PushingOptions
from phframe.pushing.persistence import persistent_radii, usable_radii, usable_threshold
from phframe.pushing.push_decision import PushDecision
from phframe.pushing.push_problem import PushProblem
from phframe.pushing.push_search import UNCHANGED, Proposal, PushSearch, by_direction, is_unchanged
from phframe.pushing.pushing import Pushing
from phframe.pushing.retrieve import Retrieve, RetrieveOptions, is_cleared
from phframe.pushing.straight_drive import StraightDrive, first_blocker, straight_drive
from phframe.pushing.straight_push import StraightPusher, StraightPushOptions
from phframe.pushing.sweep import Sweep, push_action
from phframe.pushing.sweep_generator import SweepGenerator
from phframe.pushing.tilted_sweep import Push

__all__ = [
    "UNCHANGED",
    "ChooseRadius",
    "Clearing",
    "ClearingOptions",
    "Corridor",
    "Deviation",
    "Grasp",
    "GraspFinder",
    "GrtcDeviation",
    "GrtcSearch",
    "Obstruction",
    "Proposal",
    "Push",
    "PushDecision",
    "PushProblem",
    "PushSearch",
    "Pushing",
    "PushingOptions",
    "Rectangle",
    "Retrieve",
    "RetrieveOptions",
    "StraightDrive",
    "StraightPushDecision",
    "StraightPushOptions",
    "StraightPusher",
    "Sweep",
    "SweepGenerator",
    "bounding_rectangle",
    "by_direction",
    "closest_component",
    "corridor_half_width",
    "find_corridor",
    "first_blocker",
    "grasp_action",
    "is_cleared",
    "is_unchanged",
    "persistent_radii",
    "push_action",
    "straight_drive",
    "usable_radii",
    "usable_threshold",
]
