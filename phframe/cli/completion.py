"""What the shell offers after Tab. Whatever goes wrong, it offers nothing and says nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path

import typer

from phframe.cli.console import results_only
from phframe.cli.export_formats import FORMATS
from phframe.cli.options import PARTS

Offer = list[tuple[str, str]]


def names(kind: str) -> Callable[[str], Offer]:
    """What offers the registered names of a kind of extension, such as ``planner``."""
    return lambda incomplete: _quietly(lambda: _registered(kind), incomplete)


def scenes(incomplete: str) -> Offer:
    """The scenes of all suites, and scene files."""
    if incomplete.startswith((".", "/", "~")):
        return _quietly(lambda: _scene_files(incomplete), incomplete)
    return _quietly(_scene_names, incomplete)


def suites_and_scenes(incomplete: str) -> Offer:
    """The suites of scenes, their scenes, and scene files."""
    return [*names("scenes")(incomplete), *scenes(incomplete)]


def benches(incomplete: str) -> Offer:
    """The directories of benches."""
    return _quietly(
        lambda: [(path.parent.as_posix(), "a bench") for path in sorted(Path("runs").glob("*/results.sqlite"))],
        incomplete,
    )


def differences(incomplete: str) -> Offer:
    """In what a bench that goes on may differ."""
    from phframe.bench.conflicts import Accept

    return _quietly(lambda: [(each.value, "") for each in Accept], incomplete)


def scenes_and_runs(incomplete: str) -> Offer:
    """Scenes, and the directories of runs."""
    return [*_quietly(_runs, incomplete), *scenes(incomplete)]


def runs(incomplete: str) -> Offer:
    """The directories of runs."""
    return _quietly(_runs, incomplete)


def export_formats(incomplete: str) -> Offer:
    """What ``phframe export`` writes."""
    return _quietly(lambda: [(form.name, form.what) for form in FORMATS.values()], incomplete)


def result_formats(incomplete: str) -> Offer:
    """What ``phframe bench export`` writes."""
    return _quietly(_result_formats, incomplete)


def options(context: typer.Context, incomplete: str) -> Offer:
    """The options of the planner given, and with a prefix those of the other parts."""
    return _quietly(lambda: _option_keys(context), incomplete)


def _quietly(offer: Callable[[], Iterable[tuple[str, str]]], incomplete: str) -> Offer:
    try:
        with results_only():
            return [(name, summary) for name, summary in offer() if name.startswith(incomplete)]
    except Exception:  # noqa: BLE001 - a message would end up in the middle of what is being typed
        return []


def _result_formats() -> Offer:
    from phframe.bench.export.formats import RESULT_FORMATS

    return [(form.name, form.what) for form in RESULT_FORMATS.values()]


def _registered(kind: str) -> Offer:
    from phframe.registry import Kind, catalogue

    return [
        offer
        for entry in catalogue().extensions(Kind(kind))
        for offer in [
            (entry.name, entry.extension.summary),
            *((f"{entry.name}[{options}]", summary) for options, summary in entry.extension.variants),
        ]
    ]


def _scene_names() -> Offer:
    from phframe.cli.listing_data import scenes_of
    from phframe.registry import Kind, catalogue

    entries = catalogue().extensions(Kind.SCENES)
    found = zip(entries, scenes_of(entries), strict=True)
    return [(f"{entry.name}/{name}", entry.extension.summary) for entry, answer in found for name in answer.names]


def _runs() -> Offer:
    return [(path.parent.as_posix(), "an episode") for path in sorted(Path("runs").glob("*/episode.json"))]


def _scene_files(incomplete: str) -> Offer:
    folder = Path(incomplete if incomplete.endswith("/") else Path(incomplete).parent)
    start = incomplete[: incomplete.rfind("/") + 1]
    entries = sorted(folder.expanduser().iterdir())
    folders = [(f"{start}{entry.name}/", "") for entry in entries if entry.is_dir()]
    return folders + [(f"{start}{entry.name}", "") for entry in entries if entry.suffix in (".yaml", ".yml")]


def _option_keys(context: typer.Context) -> Offer:
    from phframe.cli.option_list import describe
    from phframe.core.variant import split_variant
    from phframe.registry import Kind, builtins

    asked = [(part, context.params.get(part)) for part in PARTS if part != "scenes"]
    asked += [
        ("scenes", entry.name) for entry in builtins().extensions(Kind.SCENES)
    ]  # which one is not known before Enter
    return [
        (f"{'' if part == 'planner' else f'{part}.'}{each.key}=", each.description)
        for part, spec in asked
        if spec
        and builtins().entry(Kind(part.removeprefix("plan_")), split_variant(spec)[0])  # no plugin's code before Enter
        for each in describe(Kind(part.removeprefix("plan_")), spec).options
    ]
