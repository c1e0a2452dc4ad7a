"""What phframe itself offers, through the hook that plugins use."""

from __future__ import annotations

from functools import partial

from phframe.registry.extension import API_VERSION, Extension, Kind
from phframe.registry.hookspec import hookimpl

_own = partial(Extension, api_version=API_VERSION)

EXTENSIONS = [
    _own(
        Kind.PLANNER,
        "phia",
        "phframe.planners.phia:PHIA",
        "Pushes the closest group of obstacles, grouped by persistent homology, until the corridor is empty",
        variants=(
            ("sweeps=paper", "PHIA with the one sweep of the paper's Algorithm 3, and no other where that fails"),
        ),
    ),
    _own(
        Kind.PLANNER,
        "sure",
        "phframe.planners.sure:Sure",
        "Searches for the fewest harmless pushes that lead to a clean grasp at any angle, and confirms them before it moves",
        variants=(("confirm=false", "The same, carried out as it was planned"),),
    ),
    _own(
        Kind.PLANNER,
        "ooa",
        "phframe.planners.ooa:OOA",
        "Pushes one obstacle at a time, the closest first; no grouping",
        variants=(("sweeps=paper", "OOA with the one sweep of the paper's Algorithm 3"),),
    ),
    _own(
        Kind.PLANNER,
        "grtc-straight",
        "phframe.planners.grtc_straight:GRTCStraight",
        "Drives straight at the target, and pushes what that meets straight to a random free place",
    ),
    _own(
        Kind.PLANNER,
        "grtc-kinodynamic",
        "phframe.planners.grtc_kinodynamic:GRTCKinodynamic",
        "Steers what blocks the straight drive at the target to a free place, by OMPL's RRT or KPIECE1",
        extra="ompl",
    ),
    _own(
        Kind.PLANNER,
        "kinodynamic-rrt",
        "phframe.planners.kinodynamic_rrt:KinodynamicRRT",
        "Grows a tree of states at rest by random pushes, simulated, until the target can be grasped",
    ),
    _own(
        Kind.PLANNER,
        "guided",
        "phframe.planners.guided:Guided",
        "Asks a person, or a file of hints, which object to push where, and pushes it there",
    ),
    _own(
        Kind.PLANNER,
        "phis",
        "phframe.planners.phis:PHIS",
        "Searches the pushes of the closest group at every persistent radius for the least total pushing time",
        variants=(("sweeps=paper", "PHIS with the one sweep of the paper's Algorithm 3 for each radius"),),
    ),
    _own(
        Kind.PLANNER,
        "phim",
        "phframe.planners.phim:PHIM",
        "Monte-Carlo tree search over the pushes of the closest group at every persistent radius, in both directions",
    ),
    _own(
        Kind.PLANNER,
        "random-push",
        "phframe.planners.random_push:RandomPush",
        "Pushes a random obstacle in a random direction: the floor that every other planner must beat",
    ),
    _own(
        Kind.BACKEND,
        "pymunk",
        "phframe.backends.pymunk_.physics:PymunkPhysics",
        "The shelf from above, in 2D, with Coulomb friction: fast",
    ),
    _own(
        Kind.BACKEND,
        "fast",
        "phframe.backends.fast_.physics:FastPhysics",
        "The same shelf from above, compiled by numba: many times faster, made to plan in",
        extra="fast",
    ),
    _own(
        Kind.BACKEND,
        "mujoco",
        "phframe.backends.mujoco_.physics:MujocoPhysics",
        "The shelf in 3D with MuJoCo: objects tip, roll and fall, the arm is moved by its joints",
        extra="mujoco",
    ),
    _own(
        Kind.BACKEND,
        "pybullet",
        "phframe.backends.pybullet_.physics:PybulletPhysics",
        "The shelf in 3D with PyBullet: a second opinion on MuJoCo's",
        extra="pybullet",
    ),
    _own(Kind.ARM, "planar", "phframe.arms.planar:PlanarArm", "A gripper on a straight link; slides and turns"),
    _own(
        Kind.ARM,
        "baxter",
        "phframe.arms.baxter:Baxter",
        "An arm of Rethink Robotics' Baxter: seven joints, electric gripper",
        extra="baxter",
        uses=("ompl",),
    ),
    _own(
        Kind.ARM,
        "articulated",
        "phframe.arms.articulated:DescribedArm",
        "Any arm, from a URDF and a short description of it",
        extra="baxter",
        uses=("ompl",),
    ),
    _own(
        Kind.TOPOLOGY,
        "ripser",
        "phframe.topology.ripser_:Ripser",
        "Ripser: the paper's engine, quickest for a shelf's few dozen objects",
    ),
    _own(
        Kind.TOPOLOGY,
        "single-linkage",
        "phframe.topology.single_linkage:SingleLinkage",
        "SciPy's single linkage: the same diagrams, quickest for hundreds of points",
    ),
    _own(
        Kind.GOAL,
        "retrieve",
        "phframe.pushing.retrieve:Retrieve",
        "The target out of the shelf and in the hand: the paper's",
    ),
    _own(Kind.SCENES, "vieira", "phframe.scenes.suites:Vieira", "The scenes of Vieira et al. 2022"),
    _own(Kind.SCENES, "papallas", "phframe.scenes.suites:Papallas", "The scenes of Papallas and Dogar 2020"),
    _own(
        Kind.SCENES,
        "random",
        "phframe.scenes.generator:RandomScenes",
        "Scenes made from a seed: obstacles in front of a target deep in the shelf",
    ),
    _own(
        Kind.SCENES,
        "dense",
        "phframe.scenes.dense:DenseScenes",
        "Crowded scenes made from a seed: 20 to 40 objects all around a target deep in the shelf",
    ),
    _own(
        Kind.SCENES,
        "near",
        "phframe.scenes.near:NearScenes",
        "Scenes made from a seed: a target near a side wall, obstacles in front of it",
    ),
    _own(
        Kind.SCENES,
        "paper",
        "phframe.scenes.paper:Paper",
        "121 problems like those of the paper's experiment: basic, ten simple, ten of Papallas, 100 random",
    ),
    _own(
        Kind.RECORDER,
        "rerun",
        "phframe.recorders.rerun_:RerunRecorder",
        "A recording for the Rerun viewer",
        extra="rerun",
    ),
    _own(
        Kind.RECORDER,
        "video",
        "phframe.recorders.video_:VideoRecorder",
        "A video, or a small moving picture, drawn off screen by MuJoCo",
        extra="video",
    ),
]


@hookimpl
def phframe_extensions() -> list[Extension]:
    """The built-in extensions."""
    return list(EXTENSIONS)
