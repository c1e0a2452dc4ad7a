"""``phframe solve``: what can be asked for. What is done with it is in ``run``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from phframe.cli import completion
from phframe.cli.flags import Arm, finite, flag, part, path
from phframe.cli.options import parse_options

SceneSpec = Annotated[
    str,
    typer.Argument(
        metavar="SCENE",
        help="A scene such as vieira/basic ('phframe scenes' lists them), or a scene file such as ./shelf.yaml.",
        autocompletion=completion.scenes,
    ),
]
Planner = Annotated[
    str,
    part(
        "planner", "Who plans the pushes: a name ('phframe planners' lists them) or a class in a file, ./mine.py:Mine."
    ),
]
Backend = Annotated[str, part("backend", "The physics to act in: a name ('phframe backends') or ./mine.py:Mine.")]
PlanBackend = Annotated[
    str | None,
    part("backend", "The physics to plan in.", "fast or pymunk where the backend drives joints, else the backend"),
]
PlanArm = Annotated[str | None, part("arm", "The robot arm to plan with.", "the arm")]
Topology = Annotated[
    str, part("topology", "What computes persistence diagrams: a name ('phframe topology') or ./mine.py:Mine.")
]
Goal = Annotated[str, part("goal", "What is to be achieved: a name ('phframe goals') or ./mine.py:Mine.")]
Seed = Annotated[int, flag("INTEGER", "Seed of everything random; the same seed, the same result.", min=0)]
NoiseText = Annotated[
    str | None,
    flag(
        "KEY=VALUE,...",
        "What the planner believes against what is true: position=0.005 (standard deviation of where it sees an "
        "object, m), friction=0.3 (relative standard deviation of its friction with the board), or both.",
        "none",
    ),
]
OptionTexts = Annotated[
    list[str] | None,
    flag(
        "KEY=VALUE",
        "An option of the planner, or with a prefix of another part: margin=0.02, backend.step=0.002, "
        "arm.link_width=0.1, plan_backend.KEY, topology.KEY, goal.KEY, scenes.count=12. Repeatable. 'phframe planners NAME' and so "
        "on list them.",
        autocompletion=completion.options,
    ),
]
TimeLimit = Annotated[
    float, flag("SECONDS", "Longest planning time, all replans together (wall time, s).", min=0.001, callback=finite)
]
MaxReplans = Annotated[
    int,
    flag(
        "INTEGER",
        "How often to plan anew at most: where reality differs from the plan, or the arm cannot do an action.",
        min=0,
    ),
]
Tolerance = Annotated[
    float,
    flag(
        "METRES",
        "How far an object may be from where the plan expected it before planning anew (m).",
        min=0.0,
        callback=finite,
    ),
]
Simulations = Annotated[
    int | None, flag("INTEGER", "Most simulated actions for planning, all replans together.", "no limit", min=0)
]
Workers = Annotated[
    int,
    flag(
        "INTEGER",
        "Processes for planners that try many actions at once; the result is the same with any number.",
        min=1,
    ),
]
Out = Annotated[
    Path | None,
    flag(
        "DIR",
        "Directory for episode.json, summary.json and recording.rrd; it must be new or empty.",
        "a new one in runs/",
        parser=path,
    ),
]
Rerun = Annotated[
    bool | None,
    typer.Option(
        "--rerun/--no-rerun",
        help="Record the episode for the Rerun viewer.",
        show_default="--rerun where rerun-sdk is installed",
    ),
]
Video = Annotated[
    Path | None,
    flag(
        "FILE",
        "Film the episode: FILE.mp4, or FILE.webp for a small moving picture, three times as quick. Replaced if it "
        "exists.",
        "no video",
        parser=path,
    ),
]
View = Annotated[bool, typer.Option("--view", help="Open the recording in the Rerun viewer, too.")]
Json = Annotated[bool, typer.Option("--json", help="Print the result as one JSON object instead of a table.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No table, no progress, no hints; errors remain.")]


def solve(
    scene: SceneSpec = "vieira/basic",
    planner: Planner = "phia",
    backend: Backend = "pymunk",
    arm: Arm = "planar",
    plan_backend: PlanBackend = None,
    plan_arm: PlanArm = None,
    topology: Topology = "ripser",
    goal: Goal = "retrieve",
    seed: Seed = 0,
    noise: NoiseText = None,
    option: OptionTexts = None,
    time_limit: TimeLimit = 300.0,
    max_replans: MaxReplans = 30,
    tolerance: Tolerance = 0.01,
    simulations: Simulations = None,
    workers: Workers = 1,
    out: Out = None,
    rerun: Rerun = None,
    video: Video = None,
    view: View = False,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Retrieve the target of a scene: plan, carry out, record.

    Exit code 0: retrieved; 1: not retrieved; 2: bad input; 3: something not installed; 130: Ctrl-C.
    """
    if view and rerun is False:
        raise typer.BadParameter(
            "there is nothing to view without a recording. Leave out --no-rerun.", param_hint="--view"
        )
    from phframe.cli.run import RunOutput, run  # heavy, and not needed where the command line is wrong
    from phframe.core import Loop, RunSpec
    from phframe.runtime.noise import Noise

    spec = RunSpec(
        scene,
        planner,
        backend,
        arm,
        plan_backend,
        plan_arm,
        topology,
        goal,
        parse_options(option or ()),
        seed,
        Loop(max_replans, tolerance, time_limit, simulations),
        Noise.of(noise).model_dump(exclude_defaults=True),
        workers,
    )
    raise typer.Exit(run(spec, RunOutput(out, True if view else rerun, video, view, as_json, quiet)))
