"""A report as data: sections of text, tables and pictures, before it becomes a page, Markdown or JSON."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, Literal

from phframe.bench.statistics import Estimate

Cell = str | int | float | Estimate | None
Kind = Literal["text", "planner", "command", "number", "p"]
EMPTY = "-"
"""What stands for a figure that does not exist."""


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table.

    Attributes:
        name: Its heading.
        unit: Of its figures; empty: none.
        kind: How it is shown: figures stand to the right.
        digits: Decimals of figures that are not whole; None: three significant digits.
        scale: By what figures are multiplied to be in the unit.
    """

    name: str
    unit: str = ""
    kind: Kind = "text"
    digits: int | None = 0
    scale: float = 1.0

    @property
    def heading(self) -> str:
        """Its name with the unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    @property
    def key(self) -> str:
        """Its name for machines."""
        return self.heading.translate(_KEY).lower()

    def text(self, cell: Cell) -> str:
        """A cell as text; of an estimate the figure."""
        if isinstance(cell, Estimate):
            return self.text(cell.value)
        if cell is None:
            return EMPTY
        if isinstance(cell, str):
            return cell
        if self.kind == "p":
            return "< 0.001" if cell < 0.001 else f"{cell:.3f}"
        if isinstance(cell, int) and self.scale == 1.0:
            return f"{cell}"
        return _significant(cell * self.scale) if self.digits is None else f"{cell * self.scale:.{self.digits}f}"

    def interval(self, cell: Cell) -> str:
        """The interval of an estimate as text; empty: it has none."""
        if not isinstance(cell, Estimate) or cell.low is None or cell.high is None:
            return ""
        return f"{self.text(float(cell.low))} to {self.text(float(cell.high))}"


def _significant(figure: float) -> str:
    return f"{figure:.3g}" if abs(figure) < 1000 else f"{figure:.0f}"


_KEY = str.maketrans({" ": "_", "%": "percent", "/": "_per_", **dict.fromkeys("[],:()")})


@dataclass(frozen=True, slots=True)
class Table:
    """A table.

    Attributes:
        title: What it shows.
        columns: Its columns.
        rows: Its cells, as many in each row as there are columns.
        marked: Rows and columns of the cells that stand out.
        pick: Whether each row is of the two planners in its first columns, which can be chosen on the page.
    """

    part: ClassVar[str] = "table"

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    marked: frozenset[tuple[int, int]] = frozenset()
    pick: bool = False

    def __post_init__(self) -> None:
        assert all(len(row) == len(self.columns) for row in self.rows), self.title


@dataclass(frozen=True, slots=True)
class Picture:
    """A picture on the page.

    Attributes:
        svg: The picture.
        caption: What it shows, and how to read it.
    """

    part: ClassVar[str] = "picture"

    svg: str
    caption: str


@dataclass(frozen=True, slots=True)
class Text:
    """A paragraph."""

    part: ClassVar[str] = "text"

    text: str


@dataclass(frozen=True, slots=True)
class Fold:
    """Parts behind a heading that opens them."""

    part: ClassVar[str] = "fold"

    title: str
    parts: tuple[Part, ...]
    open: bool = False


Part = Table | Picture | Text | Fold


@dataclass(frozen=True, slots=True)
class ReportSection:
    """A section of a report.

    Attributes:
        name: For links.
        title: Its heading.
        about: What it says and how to read it.
        parts: What it shows.
    """

    name: str
    title: str
    about: str
    parts: tuple[Part, ...]

    @property
    def tables(self) -> tuple[Table, ...]:
        """Its tables; those behind a heading have it in their title."""
        return tuple(_tables(self.parts, ()))


def _tables(parts: tuple[Part, ...], above: tuple[str, ...]) -> list[Table]:
    found: list[Table] = []
    for part in parts:
        if isinstance(part, Table):
            found.append(replace(part, title=": ".join([*above, part.title])))
        elif isinstance(part, Fold):
            found += _tables(part.parts, (*above, part.title))
    return found
