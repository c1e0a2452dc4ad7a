"""Rethink Robotics' Baxter: two arms of seven joints, of which one works."""

from phframe.arms.baxter.arm import Baxter, BaxterOptions

__all__ = ["Baxter", "BaxterOptions"]
