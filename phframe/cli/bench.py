"""``phframe bench``: what can be asked for. What is done with it is in ``bench_running``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from phframe.cli import bench_replay, completion
from phframe.cli.bench_export import export_results
from phframe.cli.bench_group import BenchGroup
from phframe.cli.bench_merge import merge
from phframe.cli.flags import Arm, finite, flag, literal, part, path
from phframe.cli.group import show_help
from phframe.cli.options import parse_options
from phframe.cli.solve import (
    Backend,
    Goal,
    MaxReplans,
    NoiseText,
    OptionTexts,
    PlanArm,
    PlanBackend,
    Quiet,
    Simulations,
    TimeLimit,
    Tolerance,
    Topology,
)

app = typer.Typer(
    cls=BenchGroup,
    help="Run planners on suites of problems, and look at what came of it. 'phframe bench SUITE...' is short for 'phframe "
    "bench run SUITE...'.",
    epilog="Example: phframe bench vieira papallas --planner phia --planner ooa --workers 2 --out runs/published",
    invoke_without_command=True,
    callback=show_help,
)

Suites = Annotated[
    list[str],
    typer.Argument(
        metavar="SUITE...",
        help="Suites such as vieira ('phframe scenes' lists them; of a generator, its examples), problems such as "
        "papallas/s01, 'vieira/simple-*' or random/0..99, or scene files.",
        autocompletion=completion.suites_and_scenes,
    ),
]
Planners = Annotated[
    list[str] | None,
    part(
        "planner",
        "A planner: a name ('phframe planners' lists them), with options as in 'ooa[margin=0.02]', or a class in a file, "
        "./mine.py:Mine. Repeatable.",
        "phia",
    ),
]
Seeds = Annotated[
    int, flag("INTEGER", "How many seeds: each problem is run with 0, 1 and so on.", min=1, max=1_000_000)
]
MemoryLimit = Annotated[
    int,
    flag(
        "MB",
        "Most memory of a trial: address space of its process, of which engines map much unused.",
        min=256,
        max=2**30,
    ),
]
TrialLimit = Annotated[
    float | None,
    flag(
        "SECONDS",
        "Wall time at which a trial is killed, whatever it is at.",
        "1.5 x the time limit + 60",
        min=0.001,
        callback=finite,
    ),
]
Workers = Annotated[
    int, flag("INTEGER", "Trials that run at once on this machine; each uses one core.", min=1, max=4096)
]
Address = Annotated[
    str | None,
    flag("ADDRESS", "Run the trials on a Dask cluster, as in tcp://10.0.0.1:8786 (extra 'cluster').", "this machine"),
]
Out = Annotated[
    Path | None,
    flag(
        "DIR",
        "Directory of the results. A bench that is there goes on where it was.",
        "a new one in runs/",
        parser=path,
    ),
]
Filter = Annotated[
    str,
    typer.Option(
        "--filter",
        metavar="TEXT",
        help="Only trials whose problem or planner, or whose end or reason, holds this text; with * or ? in it, matches it.",
        show_default="all",
    ),
]
RetryFailed = Annotated[
    bool,
    typer.Option(
        "--retry-failed", help="Run again the trials that crashed, were killed, ran out of memory or had an error."
    ),
]
ListTrials = Annotated[bool, typer.Option("--list", help="List the trials, and what became of each. Nothing is run.")]
Accepted = Annotated[
    list[str] | None,
    flag(
        "WHAT",
        "Go on with a bench although it differs in: suites, planners, options, versions, code, machine. Repeatable.",
        "nothing",
        autocompletion=completion.differences,
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print the summary, or the list, as JSON instead of a table.")]


@app.command(
    "run", epilog=literal("Example: phframe bench papallas --planner phia --planner 'ooa[margin=0.02]' --workers 2")
)
def run(
    suites: Suites,
    planner: Planners = None,
    backend: Backend = "pymunk",
    arm: Arm = "planar",
    plan_backend: PlanBackend = None,
    plan_arm: PlanArm = None,
    topology: Topology = "ripser",
    goal: Goal = "retrieve",
    seeds: Seeds = 1,
    noise: NoiseText = None,
    option: OptionTexts = None,
    time_limit: TimeLimit = 300.0,
    max_replans: MaxReplans = 30,
    tolerance: Tolerance = 0.01,
    simulations: Simulations = None,
    memory_limit: MemoryLimit = 4096,
    trial_limit: TrialLimit = None,
    workers: Workers = 1,
    scheduler: Address = None,
    out: Out = None,
    filter_text: Filter = "",
    retry_failed: RetryFailed = False,
    list_trials: ListTrials = False,
    accept: Accepted = None,
    as_json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Run every planner on every problem with every seed, each trial in a process of its own.

    Killed at any moment and started again with the same --out it goes on where it was. Exit code 0: all trials ran, whatever
    came of them; 1: some crashed, were killed or had an error; 2: bad input; 3: something not installed; 130: Ctrl-C.
    """
    from phframe.bench.settings import BenchSettings  # heavy, and not needed where the command line is wrong
    from phframe.cli.bench_running import BenchOutput, run_bench
    from phframe.core import Loop
    from phframe.runtime.noise import Noise

    settings = BenchSettings(
        tuple(suites),
        tuple(planner or ("phia",)),
        backend,
        arm,
        plan_backend,
        plan_arm,
        topology,
        goal,
        parse_options(option or ()),
        seeds,
        Loop(max_replans, tolerance, time_limit, simulations),
        Noise.of(noise).model_dump(exclude_defaults=True),
        memory_limit,
        trial_limit,
    )
    output = BenchOutput(
        out, workers, scheduler, filter_text, retry_failed, list_trials, tuple(accept or ()), as_json, quiet
    )
    raise typer.Exit(run_bench(settings, output))


app.command("replay", epilog="Example: phframe bench replay runs/published vieira/simple-01 phia 0")(
    bench_replay.replay
)
app.command("export", epilog="Example: phframe bench export runs/published --out published.csv")(export_results)
app.command("merge", epilog="Example: phframe bench merge runs/monday runs/tuesday --out runs/both")(merge)
