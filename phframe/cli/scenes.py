"""``phframe scenes``: the suites and their scenes, and one scene."""

from __future__ import annotations

from typing import Annotated

import typer

from phframe.cli import completion
from phframe.cli.flags import flag
from phframe.cli.options import only_parts, parse_options

Name = Annotated[
    str | None,
    typer.Argument(
        metavar="[SUITE|SCENE]",
        help="What to describe: a suite in the list, or a class in a file, ./mine.py:Mine; or what to show: a scene such as "
        "vieira/basic, or a scene file.",
        autocompletion=completion.suites_and_scenes,
        show_default="the whole list",
    ),
]
Out = Annotated[
    str | None,
    flag(
        "FILE", "Show the scene as a picture from the top, .png (extra 'plots'), or as a scene file, .yaml.", "a table"
    ),
]
OptionTexts = Annotated[
    list[str] | None,
    flag(
        "KEY=VALUE", "An option of the scene's suite: scenes.count=12. Repeatable.", autocompletion=completion.options
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object instead of a table.")]
Force = Annotated[bool, typer.Option("--force", help="Overwrite a file that is there.")]


def scenes(
    name: Name = None, out: Out = None, option: OptionTexts = None, as_json: Json = False, force: Force = False
) -> None:
    """List the suites of scenes, and their scenes; or show one scene.

    With a SUITE: describe it, with its options, their units and defaults, and its scenes. With a SCENE: show what is in it and
    which obstacles are in its corridor; nothing is solved.
    """
    options = only_parts(parse_options(option or ()), "scenes")["scenes"]
    from phframe.cli.showing import run  # heavy, and not needed where the options are wrong

    run(name, out, options, as_json=as_json, force=force)
