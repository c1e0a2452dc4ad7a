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
_SAME = "as in the trial"
Planner = Annotated[
    str | None,
    part(
        "planner",
        "The planner, where it is a class in a file: that is run only if it is given here, ./mine.py:Mine.",
        _SAME,
    ),
]
Backend = Annotated[str | None, part("backend", "The physics engine, likewise.", _SAME)]
Arm = Annotated[str | None, part("arm", "The arm, likewise.", _SAME)]
PlanBackend = Annotated[str | None, part("backend", "The physics engine to plan in, likewise.", _SAME)]
PlanArm = Annotated[str | None, part("arm", "The arm to plan with, likewise.", _SAME)]
Topology = Annotated[str | None, part("topology", "The topology engine, likewise.", _SAME)]
Goal = Annotated[str | None, part("goal", "The goal, likewise.", _SAME)]
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
    backend: Backend = None,
    arm: Arm = None,
    plan_backend: PlanBackend = None,
    plan_arm: PlanArm = None,
    topology: Topology = None,
    goal: Goal = None,
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
    from phframe.core.run_spec import PARTS

    parts = dict(zip(PARTS, (planner, backend, arm, plan_backend, plan_arm, topology, goal), strict=True))
    raise typer.Exit(run(directory, trial, parts, RunOutput(out, True if view else rerun, view=view, as_json=as_json)))
