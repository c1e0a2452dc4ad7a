"""``phframe replay``: what can be asked for. What is done with it is in ``replaying``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from phframe.cli import completion
from phframe.cli.flags import flag, part, path
from phframe.cli.supervised import WatchdogLink, supervised

_SAME = "as in the episode"

EpisodePath = Annotated[
    Path,
    typer.Argument(
        parser=path, metavar="EPISODE", help="A directory in runs/, or an episode.json.", autocompletion=completion.runs
    ),
]
Planner = Annotated[
    str | None,
    part(
        "planner",
        "Plan with this one instead; a class in a file is run only if it is given here, ./mine.py:Mine.",
        _SAME,
    ),
]
Backend = Annotated[str | None, part("backend", "Carry the plans out in this physics instead.", _SAME)]
Arm = Annotated[str | None, part("arm", "Carry the plans out with this arm instead.", _SAME)]
PlanBackend = Annotated[
    str | None, part("backend", "Plan in this physics instead.", f"{_SAME}; as in solve if --backend replaces it")
]
PlanArm = Annotated[str | None, part("arm", "Plan with this arm instead.", f"{_SAME}; the arm if --arm replaces it")]
Topology = Annotated[str | None, part("topology", "Compute persistence diagrams with this instead.", _SAME)]
Goal = Annotated[str | None, part("goal", "Achieve this instead.", _SAME)]
Out = Annotated[
    Path | None,
    flag(
        "DIR",
        "Directory for the files of the repetition; it must be new or empty.",
        "none are written, with --view a new one in runs/",
        parser=path,
    ),
]
View = Annotated[bool, typer.Option("--view", help="Record the repetition and open it in the Rerun viewer.")]
Json = Annotated[bool, typer.Option("--json", help="Print the result as one JSON object instead of a sentence.")]


def replay(
    context: typer.Context,
    episode: EpisodePath,
    planner: Planner = None,
    backend: Backend = None,
    arm: Arm = None,
    plan_backend: PlanBackend = None,
    plan_arm: PlanArm = None,
    topology: Topology = None,
    goal: Goal = None,
    out: Out = None,
    view: View = False,
    as_json: Json = False,
) -> None:
    """Repeat an episode from its file, and say whether it is the same, bit by bit.

    With another part, such as a planner, the outcomes are compared. Exit code 0: the same; 1: not the same; 2: bad input;
    3: something not installed; 130: Ctrl-C.
    """

    def work(link: WatchdogLink) -> int:
        from phframe.cli.replaying import run  # heavy, and not needed where the command line is wrong
        from phframe.core.run_spec import PARTS

        parts = dict(zip(PARTS, (planner, backend, arm, plan_backend, plan_arm, topology, goal), strict=True))
        return run(episode, parts, out, link, view=view, as_json=as_json)

    raise typer.Exit(supervised(context, work))
