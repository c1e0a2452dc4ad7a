"""Bring your own engine of joints: public API for backends that move an arm by its joints.

A backend of a distribution of its own writes one class that fulfils ``JointEngine`` and names it in a subclass of
``ArticulatedPhysics``. Bookkeeping, following of trajectories, force limit, stalls, grasps, settling and propagation come
with it. This list is what is stable; whatever else these modules hold is not.
"""

from phframe.backends.articulated.engine import (
    ArmReading,
    ContactPair,
    EngineContact,
    JointEngine,
    ObjectReading,
    Placement,
    Progress,
    Vector,
    substeps,
)
from phframe.backends.articulated.physics import ArticulatedPhysics, Coefficient, JointEngineOptions
from phframe.backends.articulated.world import ArticulatedSnapshot, ArticulatedWorld

__all__ = [
    "ArmReading",
    "ArticulatedPhysics",
    "ArticulatedSnapshot",
    "ArticulatedWorld",
    "Coefficient",
    "ContactPair",
    "EngineContact",
    "JointEngine",
    "JointEngineOptions",
    "ObjectReading",
    "Placement",
    "Progress",
    "Vector",
    "substeps",
]
