"""Physics in space with PyBullet: board, walls, ceiling, objects that may tip, roll and fall, an arm moved by its joints.

The arm is its own URDF. Every joint has a motor with the joint's real speed and effort: a constraint, rigid up to that
effort, so that the collision geometry of arm and walls is made to give where it is touched. Joints carry the arm's weight
besides that. The arm is never put anywhere by hand while it can touch something, and holds what it holds by friction
alone. A force on it above the trajectory's limit stalls it; it then complies until nothing presses on it. An object that
leaves the board is spilled, and is taken out of the world.

With a step of 2 ms and 50 iterations, none of the objects of the published scenes moves more than 0.02 mm in 5 s.

``restore`` empties the client and builds the world anew: the only way, besides a new client, by which a run repeats
bit by bit whatever ran before. A sweep among five objects, repeated after other runs, ended this far from where it did
at first, for so long a restore:

===============================================  =========  ====
how the world is put back                        apart (m)  ms
===============================================  =========  ====
``resetSimulation``, then all built anew (used)  0          6
a new client, all built anew                     0          25
all bodies removed and added again               2e-3       5
poses and speeds written                         2e-3       0.1
``restoreState``, nothing asleep                 6e-4       0.1
``restoreState``, some asleep                    0.2        0.1
===============================================  =========  ====

For the same reason a snapshot is a state with its speeds: what follows from one repeats to the bit, but what Bullet
remembers of its contacts is lost.
"""

from __future__ import annotations

from phframe.backends.articulated import ArticulatedPhysics
from phframe.backends.pybullet_.engine import PybulletEngine
from phframe.backends.pybullet_.options import PybulletOptions


class PybulletPhysics(ArticulatedPhysics[PybulletOptions]):
    """PyBullet 3 behind the Physics interface."""

    options_type = PybulletOptions
    engine_type = PybulletEngine
