"""How far a bench is, on a terminal: done, time left, success of every planner so far."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from types import TracebackType
from typing import Self

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from phframe.bench.trial_result import TrialResult
from phframe.cli.console import error_console

_PERIOD = 3600.0
"""Seconds over which the speed is estimated."""


class BenchProgress:
    """A bar on standard error, in a ``with``; nothing where that is no terminal.

    Args:
        planners: Whose success is shown.
        trials: How many are to be run.
        shown: Whether there is a bar at all.
    """

    def __init__(self, planners: Sequence[str], trials: int, *, shown: bool) -> None:
        console = error_console()
        self._planners, self._done, self._retrieved = planners, Counter[str](), Counter[str]()
        self._bar = Progress(
            BarColumn(20),
            MofNCompleteColumn(),
            TimeRemainingColumn(),
            TextColumn("{task.description}", markup=False),
            console=console,
            disable=not (shown and console.is_terminal),
            speed_estimate_period=_PERIOD,
            transient=True,
        )
        self._task = self._bar.add_task("", total=trials)

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    @property
    def description(self) -> str:
        """The success of every planner so far."""
        return "  ".join(f"{name} {self._retrieved[name]}/{self._done[name]}" for name in self._planners)

    def count(self, result: TrialResult) -> None:
        """One more trial is done."""
        self._done[result.planner] += 1
        self._retrieved[result.planner] += result.retrieved
        self._bar.update(self._task, advance=1, description=self.description)
