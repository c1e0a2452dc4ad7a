"""``phframe bench merge``: several benches as one."""

from __future__ import annotations

from typing import Annotated

import typer

from phframe.cli import completion
from phframe.cli.flags import flag

Directories = Annotated[
    list[str], typer.Argument(metavar="DIR DIR...", help="The directories of two or more benches.", show_default=False)
]
Out = Annotated[str, flag("DIR", "The new directory to write.", "")]
Accept = Annotated[
    list[str] | None,
    flag(
        "WHAT",
        "In what they may differ: suites, planners, options, versions, code, machine. Of the settings the first one's count. "
        "Repeatable.",
        "nothing",
        autocompletion=completion.differences,
    ),
]
Prefer = Annotated[
    str | None,
    flag("WHICH", "Whose result to take where a trial came out differently, times aside: first or last.", "refuse"),
]


def merge(directories: Directories, out: Out, accept: Accept = None, prefer: Prefer = None) -> None:
    """Bring the results of several benches together in a new one; the benches given stay as they are.

    A trial that several have is kept once. Suites and planners are those of all benches, seeds the most that one has.
    """
    from phframe.bench.conflicts import accepted
    from phframe.bench.merge import Preference, merge_benches
    from phframe.cli.console import note
    from phframe.core import InputError, UnknownNameError
    from phframe.core.paths import path_shown, user_path

    differences = accepted(accept or ())
    if prefer is not None and prefer not in list(Preference):
        raise UnknownNameError("preference", prefer, list(Preference))
    if len(directories) < 2:
        raise InputError("one bench is merged already: name two or more directories")
    place = user_path(out)
    summary = merge_benches(
        [user_path(each) for each in directories],
        place,
        accept=differences,
        prefer=None if prefer is None else Preference(prefer),
    )
    note(
        f"wrote {path_shown(place)}: {summary.results} results; {summary.shared} that a later bench brought again are in it "
        "once"
    )
    if summary.left_out:
        note(f"results left out, for an earlier bench has another scene of the same name: {summary.left_out}")
