"""The listings for people."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from phframe.cli.listing_data import BrokenItem, Item, Listing

if TYPE_CHECKING:
    from phframe.cli.option_list import Description

HOME = "phframe"
_MOST_SCENES, _FEW_SCENES = 12, 4
"""Of a suite, named in the listing: all, if there are no more than that; else the first few, and the last."""


def picture(what: Listing | Description) -> RenderableType:
    """A listing or a description as tables."""
    return _listing(what) if isinstance(what, Listing) else _description(what)


def _listing(what: Listing) -> RenderableType:
    rows = table(what.title, "what it is")
    for item in what.items:
        rows.add_row(Text(item.name), _summary(item))
    return Group(rows, *_broken(what.broken))


def _summary(item: Item) -> Text:
    text = Text(item.summary)
    if item.distribution != HOME:
        text.append(f" ({item.distribution} {item.version})".replace(" )", ")"), "dim")
    if item.needs:
        text.append(f"\nnot installed: it needs {item.needs}. {item.remedy}", "yellow")
    if item.scenes:
        text.append(f"\n{len(item.scenes)} listed: {', '.join(_few(item.scenes))}", "cyan")
    return text


def _few(names: Sequence[str]) -> Sequence[str]:
    """The first names and the last; the description of the suite has them all."""
    return names if len(names) <= _MOST_SCENES else [*names[:_FEW_SCENES], "...", names[-1]]


def _broken(broken: Iterable[BrokenItem]) -> list[Text]:
    return [
        Text(f"not loaded: {f'{each.distribution} {each.version}'.strip()}: {each.error}", "red") for each in broken
    ]


def _description(what: Description) -> RenderableType:
    heading = Text.assemble((f"{what.kind} {what.name}", "bold"), f"\n{what.text}\n")
    scenes = [Text(f"\n{len(what.scenes)} listed: {', '.join(what.scenes)}", "cyan")] if what.scenes else []
    if not what.options:
        return Group(heading, Text("It has no options."), *scenes)
    prefix = "" if what.kind == "planner" else f"{what.kind}."
    rows = table("--option", "values", "default", "what it is")
    for row in what.options:
        rows.add_row(f"{prefix}{row.key}", row.values, Text(str(row.default)), Text(row.description))
    return Group(heading, rows, *scenes)


def table(*columns: str) -> Table:
    """A table without lines, its first column in bold."""
    made = Table(box=None, padding=(0, 2, 0, 0), header_style="dim")
    for number, column in enumerate(columns):
        made.add_column(column, no_wrap=number == 0, overflow="fold", style="bold" if number == 0 else "")
    return made
