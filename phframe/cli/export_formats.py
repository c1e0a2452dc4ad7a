"""The formats that ``phframe export`` writes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True, slots=True)
class Format:
    """One format.

    Attributes:
        name: What it is asked for by.
        what: What it is.
        suffix: Of files that are meant to be of it; empty: none.
        of_episode: Whether it holds the trajectories of an episode, and not a scene.
        folder: Whether it is a folder of files.
        with_arm: Whether an arm can be given for it.
    """

    name: str
    what: str
    suffix: str = ""
    of_episode: bool = False
    folder: bool = False
    with_arm: bool = False


_ALL = (
    Format("mjcf", "MuJoCo's XML, whole in itself", ".xml", with_arm=True),
    Format("urdf", "the scene as one robot, every object fixed in place", ".urdf"),
    Format("urdf-parts", "a folder: the shelf, each object, and their poses", folder=True, with_arm=True),
    Format("json", "joint trajectories in the layout of ROS", ".json", of_episode=True, with_arm=True),
    Format("csv", "joint trajectories as a table", ".csv", of_episode=True, with_arm=True),
)
FORMATS: Mapping[str, Format] = MappingProxyType({each.name: each for each in _ALL})
"""All formats, by name."""
