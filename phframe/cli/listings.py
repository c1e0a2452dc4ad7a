"""``phframe planners | backends | arms | goals | topology``: what there is to choose from."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated

import typer

from phframe.cli import completion

if TYPE_CHECKING:
    from phframe.cli.listing_data import Listing
    from phframe.cli.option_list import Description

_LISTINGS = {
    "planners": ("planner", "planners", "planners phia"),
    "backends": ("backend", "physics backends", "backends --json"),
    "arms": ("arm", "robot arms", "arms planar"),
    "goals": ("goal", "goals: what an episode is to achieve", "goals retrieve"),
    "topology": ("topology", "engines that compute persistence diagrams", "topology"),
}
"""Command: the kind in the registry, what is listed, an example."""


def add_to(app: typer.Typer) -> None:
    """Add the listings to the command line."""
    for title, (kind, what, example) in _LISTINGS.items():
        help_text = f"List the {what}.\n\nWith a NAME: describe one, and its options with their units and defaults."
        command = _command(title, kind)
        app.command(title, help=help_text, epilog=f"Example: phframe {example}")(command)


def _command(title: str, kind: str) -> Callable[..., None]:
    name_argument = typer.Argument(
        metavar="[NAME]",
        help="What to describe: a name in the list, or a class in a file, ./mine.py:Mine.",
        autocompletion=completion.names(kind),
        show_default="the whole list",
    )
    json_option = typer.Option("--json", help="Print one JSON object instead of a table.")

    def command(
        name: Annotated[str | None, name_argument] = None, as_json: Annotated[bool, json_option] = False
    ) -> None:
        print_listing(title, kind, name, as_json=as_json)

    # The annotations are texts, which typer could not look up in this function.
    command.__annotations__ = {
        "name": Annotated[str | None, name_argument],
        "as_json": Annotated[bool, json_option],
        "return": None,
    }
    return command


def _listing(title: str, kind: str) -> Listing:
    from phframe.cli.listing_data import listing
    from phframe.registry import Kind

    return listing(Kind(kind), title)


def _description(kind: str, name: str) -> Description:
    from phframe.cli.option_list import describe  # heavy
    from phframe.registry import Kind

    return describe(Kind(kind), name)


def print_listing(title: str, kind: str, name: str | None, *, as_json: bool) -> None:
    """Print all that is registered of one kind, or describe one.

    Args:
        title: The command that lists it.
        kind: What it is.
        name: Of the one to describe; None: all are listed.
        as_json: Whether to print JSON.

    Raises:
        PhframeError: If there is no such thing, or it does not load.
    """
    what = _listing(title, kind) if name is None else _description(kind, name)
    if as_json:
        import json

        from phframe.cli.console import emit

        emit(json.dumps(what.as_json()))
    else:
        from phframe.cli.console import show
        from phframe.cli.listing_table import picture

        show(picture(what))
