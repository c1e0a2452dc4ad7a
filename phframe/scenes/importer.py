"""From what another program's scene is made of to a scene of ours, with a word on all that was decided on the way."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from phframe.core import BasePose, Cylinder, FloatArray, Scene, SceneError, SceneObject, UnknownNameError
from phframe.scenes.foreign import ForeignScene, FreeBody, coefficient, listed
from phframe.scenes.shelf_finder import DIGITS, Place, find_shelf

WANTED = re.compile("target|goal", re.IGNORECASE)
"""In the name of what is probably to be taken out."""
OFF_BOARD = 1e-3
"""A body farther than this (m) from the board is said to be put on it."""


@dataclass(frozen=True, slots=True)
class Imported:
    """A scene, and what is to be said about how it was made.

    Attributes:
        scene: The scene.
        notes: One sentence each.
    """

    scene: Scene
    notes: tuple[str, ...]


def to_scene(foreign: ForeignScene, source: str, target: str | None = None, name: str | None = None) -> Imported:
    """The shelf in which most bodies stand, and what stands in it.

    Args:
        foreign: What was read.
        source: The file it comes from, for the error.
        target: Which body is wanted; None: the one that the file names, or that is named like one, or the first.
        name: What the scene is to be called; None: as the model.

    Raises:
        SceneError: If there is no shelf, or the scene cannot be.
        UnknownNameError: If the target is not in the shelf.
    """
    try:
        place = find_shelf(foreign.blocks, foreign.bodies)
        inside = [body for body in place.standing if place.seen(body.center)[0] >= 0.0]
        if not inside:
            raise SceneError("no shelf: all that stands on the board stands before its mouth")
        wanted, why = _target(foreign, inside, target)
        objects = tuple(_object(body, place) for body in inside)
        base_poses = {arm: _base_pose(stand, place) for arm, stand in foreign.base_poses.items()}
        scene = Scene(name or " ".join(foreign.name.split()) or "imported", place.shelf, objects, wanted, base_poses)
    except SceneError as error:
        raise SceneError(error.problems, source) from None
    return Imported(scene, tuple(_notes(foreign, place, inside, f"the target is {wanted!r}, {why}")))


def _object(body: FreeBody, place: Place) -> SceneObject:
    x, y, _ = (_rounded(value) for value in place.seen(body.center))
    yaw = _rounded(math.remainder(body.yaw - place.yaw, 2.0 * math.pi))
    own = coefficient(body, place.board)
    shape = Cylinder(_rounded(body.radius), _rounded(body.height))
    return SceneObject(body.name, shape, (x, y), yaw, body.mass, None if own == place.board.friction else own)


def _base_pose(stand: FloatArray, place: Place) -> BasePose:
    yaw = math.remainder(float(stand[3]) - place.yaw, 2.0 * math.pi)
    x, y, z = (_rounded(value) for value in place.seen(stand[:3]))
    return BasePose(x, y, z, _rounded(yaw))


def _target(foreign: ForeignScene, inside: list[FreeBody], asked: str | None) -> tuple[str, str]:
    """The target's name, and why it is that."""
    names = [body.name for body in inside]
    if asked is not None:
        if asked not in names:
            raise UnknownNameError("object in the shelf", asked, names)
        return asked, "as asked for"
    if foreign.target in names:
        return foreign.target, "as the file says"
    alike = [name for name in names if WANTED.search(name)]
    if alike:
        return alike[0], "guessed by its name; --target NAME takes another"
    return names[0], "the first object, since nothing says which is wanted; --target NAME takes another"


def _notes(foreign: ForeignScene, place: Place, inside: list[FreeBody], target: str) -> Iterator[str]:
    south, north, back = (wall.name for wall in place.walls)
    above = f", ceiling {place.ceiling.name!r}" if place.ceiling else ""
    yield f"the shelf: board {place.board.name!r}, south wall {south!r}, north wall {north!r}, back wall {back!r}{above}"
    x, y, z = place.origin
    yield f"its frame stands at x {x:g}, y {y:g}, z {z:g} m, yaw {np.degrees(place.yaw):g} degrees in the file's world"
    yield target
    yield from place.notes
    floor = place.origin[2]
    if off := [body.name for body in inside if abs(body.base - floor) > OFF_BOARD]:
        yield f"put on the board, up or down to it: {listed(off)}"
    if away := [body.name for body in foreign.bodies if body not in inside]:
        yield f"ignored: free bodies that do not stand in the shelf: {listed(away)}"
    if unused := [block.name for block in foreign.blocks if block not in place.used]:
        yield f"ignored: fixed boxes and planes that are no part of the shelf: {listed(unused)}"
    yield from (f"ignored: {what}" for what in foreign.ignored)


def _rounded(number: float) -> float:
    return round(float(number), DIGITS) + 0.0
