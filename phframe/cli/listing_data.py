"""What the listings list, as data: the same for tables, JSON and completion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from functools import cache
from typing import Any

from phframe.core.distributions import HOME
from phframe.registry import Entry, Kind, catalogue, create
from phframe.registry.answer import Answer
from phframe.registry.requirements import Missing, missing

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
    lacking = cache(missing)  # many entries need the same
    gaps = [lacking(entry.distribution, entry.extension.extra) for entry in entries]
    suites = [entry for entry, gap in zip(entries, gaps, strict=True) if kind is Kind.SCENES and gap is None]
    scenes = dict(zip(suites, scenes_of(suites), strict=True))
    items: list[Item] = []
    for entry, gap in zip(entries, gaps, strict=True):
        found = scenes.get(entry, Answer())
        if found.error:
            error = f"{entry.extension.kind} {entry.name!r}: {found.error}"
            broken.append(BrokenItem(entry.distribution, entry.version, error))
        else:
            items += _items(entry, gap, tuple(f"{entry.name}/{name}" for name in found.names))
    return Listing(title, tuple(items), tuple(broken))


def scenes_of(suites: Sequence[Entry]) -> list[Answer]:
    """The names of the scenes of each suite, without the suite's. No code of plugins runs in this process."""
    foreign = [suite for suite in suites if suite.distribution != HOME]
    answers = {}
    if foreign:
        from phframe.registry.asking import ask_scene_names  # seldom needed

        answers = dict(zip(foreign, ask_scene_names([suite.extension.target for suite in foreign]), strict=True))
    return [answers[suite] if suite in answers else _own_scenes(suite) for suite in suites]


def _own_scenes(suite: Entry) -> Answer:
    return Answer(names=tuple(create(Kind.SCENES, suite.name).names()))


def _items(entry: Entry, gap: Missing | None, scenes: tuple[str, ...]) -> Iterator[Item]:
    """An entry, and what is listed as a thing of its own although it is that with options."""
    needs, remedy = (gap.library, gap.remedy) if gap else ("", "")
    extension = entry.extension
    whole = Item(entry.name, extension.summary, entry.distribution, entry.version, needs, remedy, scenes)
    yield whole
    for options, text in extension.variants:
        yield replace(whole, name=f"{entry.name}[{options}]", summary=text)


def _item_as_json(item: Item, *, with_scenes: bool) -> dict[str, Any]:
    values = {**asdict(item), "needs": item.needs or None, "remedy": item.remedy or None}
    scenes = values.pop("scenes")
    return {**values, "scenes": list(scenes)} if with_scenes else values
