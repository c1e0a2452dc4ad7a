"""What the listings list, as data: the same for tables, JSON and completion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

from phframe.core.errors import PhframeError
from phframe.registry import Entry, Kind, catalogue, create
from phframe.registry.requirements import missing

FORMAT = 1
"""Of the JSON listings."""


@dataclass(frozen=True, slots=True)
class Item:
    """One registered thing.

    Attributes:
        name: What it is asked for by.
        summary: What it is, in a line.
        distribution: What it comes from.
        version: Of the distribution.
        needs: The library that it lacks; empty: it is ready.
        remedy: What to do about that.
        scenes: Of a suite: its scenes, as ``suite/name``.
    """

    name: str
    summary: str
    distribution: str
    version: str
    needs: str = ""
    remedy: str = ""
    scenes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class BrokenItem:
    """Something that was left out, and why."""

    distribution: str
    version: str
    error: str


@dataclass(frozen=True, slots=True)
class Listing:
    """All that is registered of one kind.

    Attributes:
        title: The command that lists it, such as ``planners``.
        items: What can be asked for.
        broken: The plugins that were left out, of whichever kind: what they would have offered is not known.
    """

    title: str
    items: tuple[Item, ...]
    broken: tuple[BrokenItem, ...]

    def as_json(self) -> dict[str, Any]:
        """One object: ``format``, the items under the listing's title, and ``broken``."""
        items = [_item_as_json(item, with_scenes=self.title == Kind.SCENES) for item in self.items]
        return {"format": FORMAT, self.title: items, "broken": [asdict(each) for each in self.broken]}


def listing(kind: Kind, title: str) -> Listing:
    """All that is registered of one kind."""
    entries = catalogue().extensions(kind)
    broken = [BrokenItem(each.distribution, each.version, each.error) for each in catalogue().broken]
    items = []
    for entry in entries:
        try:
            items += [_item(entry), *_variants(entry)]
        except PhframeError as error:
            broken.append(BrokenItem(entry.distribution, entry.version, str(error)))
    return Listing(title, tuple(items), tuple(broken))


def scene_names(entry: Entry) -> Sequence[str]:
    """The names of a suite's scenes, without the suite's.

    Raises:
        PhframeError: If the suite does not load.
    """
    return tuple(create(Kind.SCENES, entry.name).names())


def _item(entry: Entry) -> Item:
    gap = missing(entry.distribution, entry.extension.extra)
    listed = entry.extension.kind is Kind.SCENES and gap is None
    return Item(
        entry.name,
        entry.extension.summary,
        entry.distribution,
        entry.version,
        gap.library if gap else "",
        gap.remedy if gap else "",
        tuple(f"{entry.name}/{name}" for name in scene_names(entry)) if listed else (),
    )


def _variants(entry: Entry) -> list[Item]:
    """What is listed as a thing of its own although it is another with options."""
    whole = _item(entry)
    return [replace(whole, name=f"{entry.name}[{options}]", summary=text) for options, text in entry.extension.variants]


def _item_as_json(item: Item, *, with_scenes: bool) -> dict[str, Any]:
    values = {**asdict(item), "needs": item.needs or None, "remedy": item.remedy or None}
    scenes = values.pop("scenes")
    return {**values, "scenes": list(scenes)} if with_scenes else values
