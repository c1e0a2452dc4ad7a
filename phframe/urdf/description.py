"""What is to be said of an arm besides its URDF: a small data file."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, field_validator

from phframe.core import InputError

FORMAT = 1


def _as_tuple(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value


Length = Annotated[float, Field(ge=0.0, le=5.0)]
Point = Annotated[tuple[float, float, float], BeforeValidator(_as_tuple)]
WidthAt = Annotated[tuple[Length, Length], BeforeValidator(_as_tuple)]


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class TipFrame(_Part):
    """Where the fingertip is: x ahead, y to the left, z up with the gripper level.

    Attributes:
        link: The link of the URDF that carries it.
        at: In the frame of that link (m).
        rpy: Its turn there (rad), about the fixed axes x, y, z.
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
        fingers: Names of the sliding joints of the left and the right finger, closed at their lower limits.
        tip: Where the fingertip is; None: the URDF has a link ``fingertip``.
        min_opening: Distance between the closed fingers (m).
        home: Joint values of the parked arm, outside the shelf (rad or m).
        shelf: Where the shelf stands by default.
        height: Of the gripper plane above the board (m).
        force_limit: Net contact force above which the arm stalls (N).
        behind: The arm behind what the gripper's link carries.
        overlapping: Pairs of links, besides those joined to one another, whose covers may overlap: whoever looks for
            collisions of the arm with itself passes them over.
        postures: Joint values that a motion planner begins from, besides home, where it looks for a posture.
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
    overlapping: tuple[tuple[str, str], ...] = ()
    postures: tuple[tuple[float, ...], ...] = ()


def read_description(path: Path) -> tuple[ArmDescription, str]:
    """The description in a YAML file, and the text of the URDF that it names.

    Raises:
        InputError: If a file cannot be read, or the description does not say what it must.
    """
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    try:
        content = YAML(typ="safe", pure=True).load(_text(path))
        if not isinstance(content, dict):
            raise InputError(f"{path}: a description is made of keys and values, as in 'height: 0.1'")
        description = ArmDescription.model_validate(content)
    except YAMLError as error:
        raise InputError(f"{path}: not valid YAML: {' '.join(str(error).split())}") from None
    except ValidationError as error:
        raise InputError(f"{path}: " + "; ".join(_sentence(each) for each in error.errors())) from None
    if not description.urdf:
        raise InputError(f"{path}: urdf must name the robot's URDF file")
    return description, _text(path.parent / description.urdf)


def _text(path: Path) -> str:
    try:
        return path.read_text("utf-8")
    except UnicodeDecodeError:
        raise InputError(f"{path} is not UTF-8 text") from None
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read {path}: {getattr(error, 'strerror', None) or error}") from None


def _sentence(error: Any) -> str:
    where = ".".join(str(step) for step in error["loc"]) or "the file"
    message = error["msg"].removeprefix("Value error, ")
    return f"{where}: {message[:1].lower()}{message[1:]}"
