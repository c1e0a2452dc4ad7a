"""``phframe replay``: what can be asked for. What is done with it is in ``replaying``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from phframe.cli import completion
from phframe.cli.paths import path

EpisodePath = Annotated[
    Path,
    typer.Argument(
        parser=path,
        metavar="EPISODE",
        help="A directory in runs/, or an episode.json.",
        autocompletion=completion.runs,
    ),
]
Planner = Annotated[
    str | None,
    typer.Option(
        "--planner",
        metavar="NAME",
        help="Plan with this one instead; a class in a file is run only if it is given here, ./mine.py:Mine.",
        show_default="as in the episode",
        autocompletion=completion.planners,
    ),
]
Backend = Annotated[
    str | None,
    typer.Option(
        "--backend",
        metavar="NAME",
        help="Carry the plans out in this physics instead.",
        show_default="as in the episode",
        autocompletion=completion.backends,
    ),
]
Arm = Annotated[
    str | None,
    typer.Option(
        "--arm",
        metavar="NAME",
        help="Carry the plans out with this arm instead.",
        show_default="as in the episode",
        autocompletion=completion.arms,
    ),
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out",
        parser=path,
        metavar="DIR",
        help="Directory for the files of the repetition; it must be new or empty.",
        show_default="none are written, with --view a new one in runs/",
    ),
]
View = Annotated[bool, typer.Option("--view", help="Record the repetition and open it in the Rerun viewer.")]
Json = Annotated[bool, typer.Option("--json", help="Print the result as one JSON object instead of a sentence.")]


def replay(
    episode: EpisodePath,
    planner: Planner = None,
    backend: Backend = None,
    arm: Arm = None,
    out: Out = None,
    view: View = False,
    as_json: Json = False,
) -> None:
    """Repeat an episode from its file, and say whether it is the same, bit by bit.

    With another planner, backend or arm the outcomes are compared. Exit code 0: the same; 1: not the same; 2: bad input;
    3: something not installed; 130: Ctrl-C.
    """
    from phframe.cli.replaying import ReplayRequest, run  # heavy, and not needed where the command line is wrong

    raise typer.Exit(run(ReplayRequest(episode, planner, backend, arm, out, view, as_json)))
