"""``phframe export``: what can be asked for. What is done with it is in ``exporting``."""

from __future__ import annotations

from typing import Annotated

import typer

from phframe.cli import completion
from phframe.cli.flags import flag, part
from phframe.cli.options import only_parts, parse_options

What = Annotated[
    str,
    typer.Argument(
        metavar="SCENE|EPISODE",
        help="A scene such as vieira/basic or ./shelf.yaml; or an episode: a directory in runs/, or an episode.json.",
        autocompletion=completion.scenes_and_runs,
    ),
]
Format = Annotated[
    str | None,
    typer.Option(
        "--format",
        metavar="NAME",
        help="mjcf: MuJoCo; urdf: one file, every object fixed in place; urdf-parts: a folder with the shelf, each object and "
        "their poses; json, csv: the joint trajectories of an episode.",
        show_default="as the name after --out ends, else mjcf for a scene and json for an episode",
        autocompletion=completion.export_formats,
    ),
]
Out = Annotated[str, flag("FILE", "File, or folder for urdf-parts, to write; - is standard output.")]
Arm = Annotated[
    str | None,
    part(
        "arm",
        "An arm to put beside the scene, for mjcf and urdf-parts: a name ('phframe arms') or ./mine.py:Mine; for json and csv "
        "what the episode's arm is, where that is a class in a file.",
        "none",
    ),
]
OptionTexts = Annotated[
    list[str] | None,
    flag(
        "KEY=VALUE",
        "An option of the arm or of the suite of scenes: arm.link_width=0.1, scenes.count=12. Repeatable.",
        autocompletion=completion.options,
    ),
]
Number = Annotated[int | None, flag("INTEGER", "Only this action's trajectory, from 1.", "all", min=1)]
Force = Annotated[bool, typer.Option("--force", help="Overwrite files that are there.")]


def export(
    what: What,
    format_name: Format = None,
    out: Out = "-",
    arm: Arm = None,
    option: OptionTexts = None,
    action: Number = None,
    force: Force = False,
) -> None:
    """Write a scene, or the trajectories of an episode, for other programs.

    The world frame of all files is the shelf frame: x into the shelf, y from the south to the north wall, z up; m, rad, kg.
    """
    options = only_parts(parse_options(option or ()), "arm", "scenes")
    from phframe.cli.exporting import ExportRequest, run  # heavy, and not needed where the options are wrong

    run(ExportRequest(what, format_name, out, arm, options, action, force))
