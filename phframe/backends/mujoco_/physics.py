"""Physics in space with MuJoCo: board, walls, ceiling, objects that may tip, roll and fall, an arm moved by its joints.

The arm is its own URDF, held by a position servo on every joint that gives no more than the joint's real effort; it is
never put anywhere by hand while it can touch something. What it holds, it holds by friction alone. A force on the arm
above the trajectory's limit stalls it; it then complies until nothing presses on it. An object that leaves the board is
spilled, and is taken out of the world.

MuJoCo's elliptic friction cone and a step of 2 ms keep the published scenes at rest; objects sink 0.1 mm into the board.
``restore`` resets the engine's data completely, warm starts and sleep included, so ``simulate`` repeats bit by bit.
"""

from __future__ import annotations

from phframe.backends.articulated import ArticulatedPhysics
from phframe.backends.mujoco_.engine import MujocoEngine
from phframe.backends.mujoco_.options import MujocoOptions


class MujocoPhysics(ArticulatedPhysics[MujocoOptions]):
    """MuJoCo 4 behind the Physics interface."""

    options_type = MujocoOptions
    engine_type = MujocoEngine
