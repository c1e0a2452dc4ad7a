"""What ``phframe bench run`` does."""

from __future__ import annotations

import json
from collections.abc import Collection
from contextlib import closing
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

from phframe.bench.bench_plan import BenchPlan
from phframe.bench.conflicts import accepted
from phframe.bench.directory_lock import LOCK
from phframe.bench.session import BenchSession, Scheduler, Selected, select_trials, to_run
from phframe.bench.settings import BenchSettings
from phframe.bench.store import FILES, ResultStore
from phframe.bench.summary import summary
from phframe.cli.bench_progress import BenchProgress
from phframe.cli.bench_tables import summary_table, trial_table
from phframe.cli.console import emit, note, show
from phframe.cli.exit_codes import ExitCode
from phframe.cli.needs import require
from phframe.cli.run_directory import RunDirectory
from phframe.core import OptionError
from phframe.core.paths import path_shown

FORMAT = 1
"""Of the JSON objects."""


@dataclass(frozen=True, slots=True)
class BenchOutput:
    """How a bench is run and what it is to leave and to print.

    Attributes:
        out: Directory of the results; None: a new one.
        workers: Trials that run at once on this machine.
        scheduler: Address of the cluster that runs them; None: this machine does.
        wanted: Which trials, see ``select_trials``.
        retry: Whether those that failed are run again.
        only_list: Whether the trials are listed and none is run.
        accept: In what a bench that is there may differ.
        as_json: Whether to print JSON.
        quiet: Whether to print errors only.
    """

    out: Path | None = None
    workers: int = 1
    scheduler: str | None = None
    wanted: str = ""
    retry: bool = False
    only_list: bool = False
    accept: tuple[str, ...] = ()
    as_json: bool = False
    quiet: bool = False


def run_bench(settings: BenchSettings, output: BenchOutput) -> int:
    """Run a bench, or list its trials.

    Returns:
        The exit code.

    Raises:
        PhframeError: If something asked for cannot be used; nothing was run then. Or the results cannot be written.
    """
    differences = accepted(output.accept)
    _check_scheduler(output)
    there = output.out is not None and ResultStore.is_in(output.out)
    directory = None if there else RunDirectory(output.out, own=(LOCK, *FILES))
    plan = BenchPlan.of(settings)
    if output.only_list:
        return _list(plan, output)
    path = output.out if there or directory is None else directory.make("bench", *settings.suites)
    assert path is not None, "either there or made"
    with BenchSession(path, plan, differences) as session:
        return _run(session, path, output)


def _check_scheduler(output: BenchOutput) -> None:
    if output.scheduler is None:
        return
    require("distributed", "a bench on a cluster", "cluster")
    if output.workers != 1:
        raise OptionError(
            "--workers is for this machine: a cluster has the workers that were started for it. Leave it out."
        )
    from phframe.bench.schedulers.dask_ import check_address

    check_address(output.scheduler)


def _scheduler(session: BenchSession, output: BenchOutput) -> Scheduler:
    if output.scheduler is None:
        return session.local(output.workers)
    from phframe.bench.schedulers.dask_ import cluster_scheduler

    return cluster_scheduler(output.scheduler, session.plan, partial(_say_that_it_waits, output))


def _say_that_it_waits(output: BenchOutput) -> None:
    if not output.quiet:
        note(f"waiting for workers: {output.scheduler} has none yet; start them with: dask worker {output.scheduler}")


def _list(plan: BenchPlan, output: BenchOutput) -> int:
    there = output.out is not None and ResultStore.is_in(output.out)
    if not there or output.out is None:
        _print_list(list(select_trials(plan, None, output.wanted)), output)
        return ExitCode.SUCCESS
    with ResultStore.open(output.out) as store:
        _print_list(list(select_trials(plan, store, output.wanted)), output)
    return ExitCode.SUCCESS


def _print_list(selected: Collection[Selected], output: BenchOutput) -> None:
    if not selected:
        _say_that_none_matches(output)
    if output.as_json:
        emit(json.dumps({"format": FORMAT, "trials": [_listed(each) for each in selected]}))
    elif selected and not output.quiet:
        show(trial_table(selected))


def _say_that_none_matches(output: BenchOutput) -> None:
    if not output.quiet:
        note(f"no trial matches --filter {output.wanted!r}")


def _listed(selected: Selected) -> dict[str, Any]:
    trial, result = selected.trial, selected.result
    known = {"suite": trial.suite, "problem": trial.problem, "planner": trial.planner, "seed": trial.spec.seed}
    came = {"end": None if result is None else result.end, "status": "" if result is None else result.status}
    return {
        "key": trial.key,
        **known,
        "done": result is not None,
        **came,
        "reason": "" if result is None else result.reason,
    }


def _run(session: BenchSession, path: Path, output: BenchOutput) -> int:
    numbers = to_run(select_trials(session.plan, session.store, output.wanted), retry=output.retry)
    if not numbers and next(select_trials(session.plan, session.store, output.wanted), None) is None:
        _say_that_none_matches(output)
    if not output.quiet:
        note(f"results in {path_shown(path)}: {len(numbers)} of {len(session.plan)} trials to run")
        if session.left_out:
            note(f"results kept but left out, of other settings or of scenes that have changed: {session.left_out}")
    try:
        with (
            BenchProgress(session.plan.settings.planners, len(numbers), shown=not output.quiet) as progress,
            closing(session.run(numbers, _scheduler(session, output))) as results,
        ):
            for result in results:
                progress.count(result)
    except KeyboardInterrupt:
        note(f"interrupted; what was done is kept: go on with the same command and --out {path_shown(path)}")
        return ExitCode.INTERRUPTED
    return _tell(session, path, output)


def _tell(session: BenchSession, path: Path, output: BenchOutput) -> int:
    """Print the summary; whether any trial failed."""
    lines = summary(session.store.results())
    if output.as_json:
        emit(json.dumps({"format": FORMAT, "directory": str(path), "summary": [asdict(line) for line in lines]}))
    elif not output.quiet:
        show(summary_table(lines))
    return ExitCode.OTHER_OUTCOME if any(line.failures for line in lines) else ExitCode.SUCCESS
