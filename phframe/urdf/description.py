"""What is to be said of an arm besides its URDF: a small data file."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, field_validator

from phframe.core import DocumentError, InputError
from phframe.core.paths import path_shown, user_path
from phframe.urdf.model import Robot
from phframe.urdf.reader import read_robot
from phframe.yaml.file import read_text
from phframe.yaml.tree import YamlTree, parse_yaml
from phframe.yaml.wording import shortened

FORMAT = 1
URDF_BYTES = 5_000_000
"""Of the largest URDF or SRDF that is read; those of humanoids have a tenth of it."""


def _as_tuple(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value


Length = Annotated[float, Field(ge=0.0, le=5.0)]
Coordinate = Annotated[float, Field(ge=-100.0, le=100.0)]
Point = Annotated[tuple[Coordinate, Coordinate, Coordinate], BeforeValidator(_as_tuple)]
WidthAt = Annotated[tuple[Length, Length], BeforeValidator(_as_tuple)]


class _Part(BaseModel):
    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, validate_by_name=True, validate_by_alias=True
    )


class TipFrame(_Part):
    """Where the fingertip is: x ahead, y to the left, z up with the gripper level.

    Attributes:
        link: The link of the URDF that carries it.
        at: In the frame of that link (m).
        rpy: Its rotation there (rad), about the fixed axes x, y, z.
    """

    link: str
    at: Point
    rpy: Point = (0.0, 0.0, 0.0)


class Stand(_Part):
    """Where the shelf is for the robot by default: the middle of the mouth, at the board, in the frame of the base.

    Attributes:
        at: Metres.
        yaw: Of the way into the shelf (rad).
    """

    at: Point
    yaw: float = 0.0


class Section(_Part):
    """A part of the arm behind the gripper, as it lies over the shelf in all configurations that it is used in.

    Attributes:
        part: Its name.
        widths: Distance behind the fingertip and half-width there (m), the nearest first; straight in between.
        bottom: Lowest z relative to the gripper plane (m).
        top: Highest z relative to the gripper plane (m).
    """

    part: str
    widths: tuple[WidthAt, ...]
    bottom: float
    top: float

    @field_validator("widths")
    @classmethod
    def _from_near_to_far(cls, widths: tuple[tuple[float, float], ...]) -> tuple[tuple[float, float], ...]:
        distances = [distance for distance, _ in widths]
        if len(widths) < 2 or distances != sorted(distances):
            raise ValueError("at least two pairs of distance and half-width are needed, the nearest first")
        return widths


class ArmDescription(_Part):
    """An arm besides its URDF.

    Attributes:
        phframe: Format of the description.
        urdf: The URDF's file, from the description's folder; empty where the text is given by other means.
        joints: Names of the joints, from the base to the gripper.
        fingers: Names of the sliding joints of the left and the right finger.
        tip: Where the fingertip is; None: the URDF has a link ``fingertip``.
        min_opening: Distance between the closed fingers (m).
        home: Joint values of the parked arm, outside the shelf (rad or m).
        shelf: Where the shelf stands by default.
        height: Of the gripper plane above the board (m).
        force_limit: Net contact force above which the arm stalls (N).
        behind: The arm behind what the gripper's link carries.
        allowed_collisions: Pairs of links, besides those joined to one another, whose collision geometry may overlap:
            whoever looks for collisions of the arm with itself passes them over. In files the key is ``overlapping``.
        srdf: An SRDF file, from the description's folder, whose disabled collisions are allowed besides; empty: none.
        seed_configurations: Joint values that a motion planner begins from, besides home, where it looks for a
            configuration. In files the key is ``postures``.
    """

    phframe: Literal[1] = 1
    urdf: str = ""
    joints: tuple[str, ...]
    fingers: tuple[str, str]
    tip: TipFrame | None = None
    min_opening: Length = 0.0
    home: tuple[float, ...]
    shelf: Stand
    height: Annotated[float, Field(gt=0.0, le=2.0)]
    force_limit: Annotated[float, Field(gt=0.0)] = 60.0
    behind: tuple[Section, ...] = ()
    allowed_collisions: Annotated[tuple[tuple[str, str], ...], Field(alias="overlapping")] = ()
    srdf: str = ""
    seed_configurations: Annotated[tuple[tuple[float, ...], ...], Field(alias="postures")] = ()


def read_description(path: Path) -> tuple[ArmDescription, Robot]:
    """The description in a YAML file, and the robot in the URDF that it names.

    Raises:
        InputError: If a file cannot be read, or does not say what it must.
    """
    description, folder = _validated(path), user_path(path).parent
    if not description.urdf:
        raise InputError(f"{path_shown(path)}: urdf must name the robot's URDF file")
    urdf = folder / description.urdf
    robot = read_robot(read_text(urdf, "URDF", URDF_BYTES), urdf.parent)
    if description.srdf:
        allowed = (*description.allowed_collisions, *_disabled_collisions(folder / description.srdf))
        description = description.model_copy(update={"allowed_collisions": allowed})
    return description, robot


def _validated(path: Path) -> ArmDescription:
    source = path_shown(path)
    tree = parse_yaml(read_text(path, "arm description"), source)
    if not isinstance(tree.content, dict):
        raise DocumentError("a description is made of keys and values, as in 'height: 0.1'", source)
    try:
        return ArmDescription.model_validate(tree.content)
    except ValidationError as error:
        raise DocumentError(shortened(_sentence(each, tree) for each in error.errors()), source) from None


def _disabled_collisions(path: Path) -> Iterator[tuple[str, str]]:
    """The pairs of links that an SRDF (http://wiki.ros.org/srdf) takes out of collision checking."""
    try:
        root = ET.fromstring(read_text(path, "SRDF", URDF_BYTES))
    except ET.ParseError as error:
        raise DocumentError(f"the SRDF is not XML: {error}", path_shown(path)) from None
    for element in root.iter("disable_collisions"):
        first, second = element.get("link1", ""), element.get("link2", "")
        if not first or not second:
            raise DocumentError("a <disable_collisions> lacks link1 or link2", path_shown(path))
        yield first, second


def _sentence(error: Any, tree: YamlTree) -> str:
    where = ".".join(str(step) for step in error["loc"]) or "the file"
    message = error["msg"].removeprefix("Value error, ")
    return f"line {tree.line(error['loc'])}: {where}: {message[:1].lower()}{message[1:]}"
