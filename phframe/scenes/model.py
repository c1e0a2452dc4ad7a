"""What a scene file of format 1 may hold: keys, types, ranges. Geometry is checked by ``phframe.core.Scene`` itself."""

from __future__ import annotations

from dataclasses import fields
from typing import Annotated, Any, Literal, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetPydanticSchema,
    Strict,
)
from pydantic_core import PydanticCustomError, core_schema

from phframe.core import SceneObject, Shelf
from phframe.core.names import LONGEST_NAME, name_fault

FORMAT = 1
"""The format of scene files that this version reads and writes."""


def _default(owner: type[Any], name: str) -> Any:
    return next(field.default for field in fields(owner) if field.name == name)


def _figures(names: str) -> BeforeValidator:
    """Complain about a list of the wrong length in one sentence that names its members."""
    count = len(names.split(","))

    def check(value: Any) -> Any:
        if isinstance(value, list) and len(value) != count:
            raise PydanticCustomError("figures", "expected {count} numbers [{names}]", {"count": count, "names": names})
        return value

    return BeforeValidator(check)


def _one_line(text: str) -> str:
    if name_fault(text):
        raise PydanticCustomError("one_line", "expected printable text on one line, without spaces at its ends")
    return text


Number = Annotated[float, Strict()]
Size = Annotated[Number, Field(gt=0)]
Friction = Annotated[Number, Field(ge=0)]
Name = Annotated[str, Strict(), Field(min_length=1, max_length=LONGEST_NAME), AfterValidator(_one_line)]
Position = Annotated[tuple[Number, Number], _figures("x, y")]
Base = Annotated[tuple[Number, Number, Number, Number], _figures("x, y, z, yaw")]


class Part(BaseModel):
    """Base of everything in a scene file: unknown keys and numbers that are not finite are refused."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False, frozen=True)


class ShelfPart(Part):
    """The inside of the shelf, open at the mouth."""

    depth: Size = Field(description="mouth plane to back wall (m)")
    width: Size = Field(description="south wall to north wall (m)")
    height: Size = Field(description="board to ceiling (m)")
    board_friction: Friction = Field(
        _default(Shelf, "board_friction"), description="Coulomb coefficient between board and objects"
    )
    wall_friction: Friction = Field(
        _default(Shelf, "wall_friction"), description="Coulomb coefficient between walls and objects"
    )


class ObjectPart(Part):
    """What objects of every shape have."""

    id: Name = Field(description="unique name")
    position: Position = Field(description="centre [x, y] in the shelf frame (m)")
    yaw: Number = Field(_default(SceneObject, "yaw"), description="heading (rad)")
    mass: Size = Field(_default(SceneObject, "mass"), description="mass (kg)")
    friction: Friction | None = Field(
        None, description="Coulomb coefficient with the board; empty: the shelf's board_friction"
    )


class CylinderPart(ObjectPart):
    """An upright cylinder."""

    shape: Literal["cylinder"] = Field(description="the kind of object: cylinder")
    radius: Size = Field(description="radius (m)")
    height: Size = Field(description="height (m)")


SHAPES: dict[str, type[ObjectPart]] = {"cylinder": CylinderPart}
"""The objects a file may hold, by the value of ``shape``; a new shape is one more entry."""

ObjectT = TypeVar("ObjectT", bound=ObjectPart)


def _by_shape(_: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
    # pydantic's own discriminated union wants two members or more
    return core_schema.tagged_union_schema(
        {name: handler.generate_schema(part) for name, part in SHAPES.items()}, discriminator="shape"
    )


AnyObject = Annotated[ObjectT, GetPydanticSchema(_by_shape)]


class ScenePart(Part):
    """A scene file: a shelf, the objects on it, and which one is wanted.

    Shelf frame: x is the depth from the mouth plane (0) to the back wall, y = 0 at the south wall and ``width`` at the
    north wall, z up from the board. Metres, radians, kilograms.
    """

    phframe: Literal[1] = Field(description="the format of this file: 1")
    name: Name = Field(description="what the scene is called")
    shelf: ShelfPart = Field(description="the shelf")
    target: Name = Field(description="the id of the object to take out")
    objects: list[AnyObject[ObjectPart]] = Field(min_length=1, description="all objects, the target among them")
    mount: dict[Name, Base] = Field(
        default_factory=dict, description="where an arm's base stands, [x, y, z, yaw], by the arm's name"
    )
