"""Scenes: the reader and writer of scene files, the published suites, and those that are made from seeds."""

from phframe.scenes.dense import DenseOptions, DenseScenes
from phframe.scenes.generator import RandomOptions, RandomScenes
from phframe.scenes.near import NearOptions, NearScenes
from phframe.scenes.paper import Paper
from phframe.scenes.reader import parse_scene, read_scene
from phframe.scenes.spec import is_file_spec
from phframe.scenes.suites import FileSuite, Papallas, Vieira
from phframe.scenes.writer import scene_to_yaml, write_scene

__all__ = [
    "DenseOptions",
    "DenseScenes",
    "FileSuite",
    "NearOptions",
    "NearScenes",
    "Papallas",
    "Paper",
    "RandomOptions",
    "RandomScenes",
    "Vieira",
    "is_file_spec",
    "parse_scene",
    "read_scene",
    "scene_to_yaml",
    "write_scene",
]
