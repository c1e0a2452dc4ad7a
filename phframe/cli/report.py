"""``phframe report``: what can be asked for. What is done with it is in ``reporting``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from phframe.cli.flags import flag, path

Benches = Annotated[
    list[Path],
    typer.Argument(
        parser=path, metavar="DIR...", help="Directories that 'phframe bench' made; several make one report."
    ),
]
Out = Annotated[
    str | None,
    flag("FILE", "File for the page; - is standard output.", "report.html in the first DIR, made anew each time"),
]
Figures = Annotated[
    str | None,
    flag(
        "DIR",
        "Directory for the bar charts, performance profiles and solved-over-time as PNG and PDF.",
        "no such files",
    ),
]
Markdown = Annotated[str | None, flag("FILE", "File for the tables as Markdown.", "no such file")]
Force = Annotated[bool, typer.Option("--force", help="Overwrite files that are there.")]
Json = Annotated[bool, typer.Option("--json", help="Print all tables as one JSON object.")]


def report(
    benches: Benches,
    out: Out = None,
    figures: Figures = None,
    markdown: Markdown = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Report the results of a bench: one page that needs no network, and if asked for figures and tables.

    Trials that are still to run are left out, so a bench can be reported while it runs.
    """
    from phframe.cli.reporting import ReportRequest, run  # heavy, and not needed where the command line is wrong

    run(ReportRequest(tuple(benches), out, figures, markdown, force, as_json))
