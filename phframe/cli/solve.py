"""``phframe solve``: what can be asked for. What is done with it is in ``run``."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from phframe.cli import completion
from phframe.cli.options import parse_options
from phframe.cli.paths import path


def _finite(value: float) -> float:
    if not math.isfinite(value):
        raise typer.BadParameter(f"{value} is not a finite number.")
    return value


SceneSpec = Annotated[
    str,
    typer.Argument(
        metavar="SCENE",
        help="A scene such as vieira/basic ('phframe scenes' lists them), or a scene file such as ./shelf.yaml.",
        autocompletion=completion.scenes,
    ),
]
PlannerSpec = Annotated[
    str,
    typer.Option(
        "--planner",
        metavar="NAME",
        help="Who plans the pushes: a name ('phframe planners' lists them) or a class in a file, ./mine.py:Mine.",
        autocompletion=completion.planners,
    ),
]
BackendSpec = Annotated[
    str,
    typer.Option(
        "--backend",
        metavar="NAME",
        help="The physics to act in: a name ('phframe backends') or ./mine.py:Mine.",
        autocompletion=completion.backends,
    ),
]
ArmSpec = Annotated[
    str,
    typer.Option(
        "--arm",
        metavar="NAME",
        help="The robot arm: a name ('phframe arms') or ./mine.py:Mine.",
        autocompletion=completion.arms,
    ),
]
PlanBackendSpec = Annotated[
    str | None,
    typer.Option(
        "--plan-backend",
        metavar="NAME",
        help="The physics to plan in.",
        show_default="pymunk where the backend drives joints, else the backend",
        autocompletion=completion.backends,
    ),
]
PlanArmSpec = Annotated[
    str | None,
    typer.Option(
        "--plan-arm",
        metavar="NAME",
        help="The robot arm to plan with.",
        show_default="the arm",
        autocompletion=completion.arms,
    ),
]
TopologySpec = Annotated[
    str,
    typer.Option(
        "--topology",
        metavar="NAME",
        help="What computes persistence diagrams: a name ('phframe topology') or ./mine.py:Mine.",
        autocompletion=completion.topology,
    ),
]
GoalSpec = Annotated[
    str,
    typer.Option(
        "--goal",
        metavar="NAME",
        help="What is to be achieved: a name ('phframe goals') or ./mine.py:Mine.",
        autocompletion=completion.goals,
    ),
]
Seed = Annotated[
    int,
    typer.Option("--seed", metavar="INTEGER", min=0, help="Seed of everything random; the same seed, the same result."),
]
NoiseText = Annotated[
    str | None,
    typer.Option(
        "--noise",
        metavar="KEY=VALUE,...",
        help="What the planner believes against what is true: position=0.005 (standard deviation of where it sees an "
        "object, m), friction=0.3 (relative standard deviation of its friction with the board), or both.",
        show_default="none",
    ),
]
OptionTexts = Annotated[
    list[str] | None,
    typer.Option(
        "--option",
        metavar="KEY=VALUE",
        help="An option of the planner, or with a prefix of another part: margin=0.02, backend.step=0.002, "
        "arm.link_width=0.1, plan_backend.KEY, topology.KEY, goal.KEY, scenes.count=12. Repeatable. 'phframe planners NAME' and so "
        "on list them.",
        autocompletion=completion.options,
    ),
]
TimeLimit = Annotated[
    float,
    typer.Option(
        "--time-limit",
        metavar="SECONDS",
        min=0.001,
        callback=_finite,
        help="Longest planning time, all replans together (wall time, s).",
    ),
]
MaxReplans = Annotated[
    int,
    typer.Option(
        "--max-replans",
        metavar="INTEGER",
        min=0,
        help="How often to plan anew at most: where reality differs from the plan, or the arm cannot do an action.",
    ),
]
Tolerance = Annotated[
    float,
    typer.Option(
        "--tolerance",
        metavar="METRES",
        min=0.0,
        callback=_finite,
        help="How far an object may be from where the plan expected it before planning anew (m).",
    ),
]
Simulations = Annotated[
    int | None,
    typer.Option(
        "--simulations",
        metavar="INTEGER",
        min=0,
        help="Most simulated actions for planning, all replans together.",
        show_default="no limit",
    ),
]
Workers = Annotated[
    int,
    typer.Option(
        "--workers",
        metavar="INTEGER",
        min=1,
        help="Processes for planners that try many actions at once; the result is the same with any number.",
    ),
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out",
        parser=path,
        metavar="DIR",
        help="Directory for episode.json, summary.json and recording.rrd; it must be new or empty.",
        show_default="a new one in runs/",
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
    typer.Option(
        "--video",
        parser=path,
        metavar="FILE",
        help="Film the episode: FILE.mp4, or FILE.webp for a small moving picture, three times as quick. Replaced if it "
        "exists.",
        show_default="no video",
    ),
]
View = Annotated[bool, typer.Option("--view", help="Open the recording in the Rerun viewer, too.")]
Json = Annotated[bool, typer.Option("--json", help="Print the result as one JSON object instead of a table.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No table, no progress, no hints; errors remain.")]


def solve(
    scene: SceneSpec = "vieira/basic",
    planner: PlannerSpec = "phia",
    backend: BackendSpec = "pymunk",
    arm: ArmSpec = "planar",
    plan_backend: PlanBackendSpec = None,
    plan_arm: PlanArmSpec = None,
    topology: TopologySpec = "ripser",
    goal: GoalSpec = "retrieve",
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
