"""The paper's method: corridor, persistence, grouping, sweeps, grasp, and the goal to retrieve.

This is the public list: what planners, phframe's own and those of plugins, are made of.
"""

from phframe.pushing.clearing import ChooseRadius, Clearing
from phframe.pushing.confirmed import Confirmed
from phframe.pushing.corridor import Corridor, corridor_at, corridor_half_width, find_corridor
from phframe.pushing.cut_short import cut_short
from phframe.pushing.deviation import Deviation
from phframe.pushing.fan import WIDE_FAN, Drive, drives
from phframe.pushing.grasp import Grasp, GraspFinder, grasp_action
from phframe.pushing.grouping import Rectangle, bounding_rectangle, closest_component
from phframe.pushing.groups import Grouping, ObstacleGroup, Radii, closest_groups
from phframe.pushing.grtc import GrtcDeviation, GrtcSearch, Obstruction, StraightPushDecision
from phframe.pushing.harm import MOVED_TARGET, displacement_allowed, harm
from phframe.pushing.known_transitions import KnownTransitions
from phframe.pushing.options import ClearingOptions, PushingOptions
from phframe.pushing.persistence import persistent_radii, usable_radii, usable_threshold
from phframe.pushing.push_decision import PushDecision
from phframe.pushing.push_problem import PushProblem
from phframe.pushing.push_search import UNCHANGED, Proposal, PushSearch, by_direction, is_unchanged
from phframe.pushing.pushing import Pushing
from phframe.pushing.reach_of_target import ReachOfTarget
from phframe.pushing.rehearsal import Rehearsals, first_fault
from phframe.pushing.retrieve import Retrieve, RetrieveOptions, is_cleared
from phframe.pushing.straight_drive import StraightDrive, first_blocker, straight_drive
from phframe.pushing.straight_push import StraightPusher, StraightPushOptions
from phframe.pushing.sweep import Sweep, push_action
from phframe.pushing.sweep_generator import SweepGenerator
from phframe.pushing.target_push import target_pushes
from phframe.pushing.tilted_sweep import Push

__all__ = [
    "MOVED_TARGET",
    "UNCHANGED",
    "WIDE_FAN",
    "ChooseRadius",
    "Clearing",
    "ClearingOptions",
    "Confirmed",
    "Corridor",
    "Deviation",
    "Drive",
    "Grasp",
    "GraspFinder",
    "Grouping",
    "GrtcDeviation",
    "GrtcSearch",
    "KnownTransitions",
    "ObstacleGroup",
    "Obstruction",
    "Proposal",
    "Push",
    "PushDecision",
    "PushProblem",
    "PushSearch",
    "Pushing",
    "PushingOptions",
    "Radii",
    "ReachOfTarget",
    "Rectangle",
    "Rehearsals",
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
    "closest_groups",
    "corridor_at",
    "corridor_half_width",
    "cut_short",
    "displacement_allowed",
    "drives",
    "find_corridor",
    "first_blocker",
    "first_fault",
    "grasp_action",
    "harm",
    "is_cleared",
    "is_unchanged",
    "persistent_radii",
    "push_action",
    "straight_drive",
    "target_pushes",
    "usable_radii",
    "usable_threshold",
]
