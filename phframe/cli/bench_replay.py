"""``phframe bench replay``: what can be asked for. What is done with it is in ``bench_replaying``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from phframe.cli import completion
from phframe.cli.flags import flag, part, path
from phframe.cli.solve import Rerun, View

Bench = Annotated[
    Path,
    typer.Argument(
        parser=path, metavar="DIR", help="The directory of a bench, in runs/.", autocompletion=completion.benches
    ),
]
TrialWords = Annotated[
    list[str],
    typer.Argument(
        metavar="TRIAL",
        help="The beginning of its key ('phframe bench SUITE --list' shows it), or problem, planner and seed.",
    ),
]
Planner = Annotated[
    str | None,
    part(
        "planner",
        "The planner, where it is a class in a file: that is run only if it is given here, ./mine.py:Mine.",
        "as in the trial",
    ),
]
Out = Annotated[
    Path | None,
    flag(
        "DIR", "Directory for the files of the repetition; it must be new or empty.", "a new one in runs/", parser=path
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print the comparison as one JSON object instead of lines.")]


def replay(
    directory: Bench,
    trial: TrialWords,
    planner: Planner = None,
    out: Out = None,
    rerun: Rerun = None,
    view: View = False,
    as_json: Json = False,
) -> None:
    """Repeat a trial of a bench in this process, record it, and say whether the same came of it, times aside.

    Exit code 0: the same; 1: not the same; 2: bad input; 3: something not installed; 130: Ctrl-C. A trial that crashed its
    process crashes this one.
    """
    if len(trial) not in (1, 3):
        raise typer.BadParameter(
            "give the beginning of its key, or three words: problem, planner and seed.", param_hint="TRIAL"
        )
    from phframe.cli.bench_replaying import run  # heavy, and not needed where the command line is wrong
    from phframe.cli.run import RunOutput

    raise typer.Exit(
        run(directory, trial, planner, RunOutput(out, True if view else rerun, view=view, as_json=as_json))
    )
