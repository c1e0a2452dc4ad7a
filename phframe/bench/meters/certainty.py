"""Whether ``Plan.certainty`` can be trusted: the fraction of samples in which a plan is clean, beside how often it really is.

The first plan of ``sure`` is taken, whatever its share, and carried out as it is: no replan mends it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from itertools import pairwise
from statistics import mean
from typing import Any

from rich.console import Console
from rich.table import Table

from phframe.bench.statistics import wilson
from phframe.core import Loop, RunSpec, Status
from phframe.runtime.run import run

NOISE = {"position": 0.005, "friction": 0.3}
SAMPLES = 20
PLANNER = {"particles": SAMPLES, "certain": 0.0, "rehearsals": 1}
OPEN_LOOP = Loop(max_replans=0, tolerance=10.0)
SHARES = (0.0, 0.5, 0.8, 0.95, 1.0)
"""Bounds of the bins; a share on a bound belongs to the upper bin."""


@dataclass(frozen=True, slots=True)
class CertaintyBin:
    """The plans whose shares are alike.

    Attributes:
        least: The least fraction of the bin.
        most: The bound above it.
        plans: How many there are.
        expected: Their mean share.
        clean: How many retrieved the target cleanly.
        interval: Of the fraction that is clean, 95 % (Wilson).
    """

    least: float
    most: float
    plans: int
    expected: float
    clean: int
    interval: tuple[float, float]


def measure_certainty(console: Console, scenes: Sequence[str], seeds: int, backend: str) -> dict[str, Any]:
    """Plan with noise and carry out, print the bins, return the figures.

    Args:
        console: Where to print.
        scenes: In which to plan.
        seeds: How often the noise is drawn in each.
        backend: In which the plans are carried out.
    """
    found: list[tuple[float, bool]] = []
    with console.status("planning") as status:
        for name in scenes:
            status.update(f"sure with noise: {name}")
            found += (outcome for seed in range(seeds) if (outcome := _outcome(name, seed, backend)) is not None)
    bins = binned(found)
    _print(console, backend, len(scenes) * seeds, bins)
    return {"certainty": {"backend": backend, "noise": NOISE, "bins": [asdict(each) for each in bins]}}


def _outcome(scene: str, seed: int, backend: str) -> tuple[float, bool] | None:
    """The fraction of the first plan, and whether it came off; None: none was found."""
    episode = run(RunSpec(scene, "sure", backend, options={"planner": PLANNER}, seed=seed, loop=OPEN_LOOP, noise=NOISE))
    plan = episode.plans[0]
    if plan.status is not Status.RETRIEVED or plan.certainty is None or plan.certainty.share is None:
        return None
    return plan.certainty.share, episode.clean


def binned(found: Sequence[tuple[float, bool]]) -> list[CertaintyBin]:
    """Shares and outcomes by bins, the empty ones left out."""
    bins = []
    for least, most in pairwise(SHARES):
        inside = [each for each in found if least <= each[0] < most or each[0] == most == SHARES[-1]]
        if inside:
            clean = sum(came_off for _, came_off in inside)
            expected = mean(share for share, _ in inside)
            bins.append(CertaintyBin(least, most, len(inside), expected, clean, wilson(clean, len(inside))))
    return bins


def _print(console: Console, backend: str, runs: int, bins: Sequence[CertaintyBin]) -> None:
    columns = ("fraction of samples", "plans", "mean fraction", "came off clean", "95 % interval")
    title = (
        f"First plans of sure, {sum(each.plans for each in bins)} in {runs} runs, carried out in {backend} as they are"
    )
    table = Table(*columns, title=title)
    for each in bins:
        low, high = each.interval
        told = f"{100 * each.clean / each.plans:.0f} %", f"{100 * low:.0f} to {100 * high:.0f} %"
        table.add_row(f"{each.least:g} to {each.most:g}", str(each.plans), f"{each.expected:.2f}", *told)
    console.print(table)
