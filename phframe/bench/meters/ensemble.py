"""Fidelity as an ensemble: the same sweeps in every engine, compared pair by pair; no engine's word is the last one.

Beside the engines as they are shipped stand variants of MuJoCo (its other cone of friction, half its step): how far one
engine is from itself is the least by which two engines can be told apart.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import combinations
from typing import Any

from rich.console import Console
from rich.table import Table

from phframe.bench.meters.sweeps import PlannedSweep, Score, compare, outcomes, planned_sweeps, score
from phframe.core import NotInstalledError, State
from phframe.registry import Kind, load
from phframe.runtime.plan_backend import FITTED, PYMUNK_FITTED


@dataclass(frozen=True, slots=True)
class Member:
    """One engine with some options.

    Attributes:
        name: What it is called.
        backend: Its backend.
        options: That differ from the defaults.
    """

    name: str
    backend: str
    options: Mapping[str, Any]


MEMBERS = (
    Member("MuJoCo", "mujoco", {}),
    Member("MuJoCo, pyramidal cone", "mujoco", {"cone": "pyramidal"}),
    Member("MuJoCo, half the step", "mujoco", {"step": 0.001}),
    Member("PyBullet", "pybullet", {}),
    Member("fast, fitted", "fast", FITTED["fast"]),
    Member("pymunk, fitted", "pymunk", FITTED["pymunk"]),
)


@dataclass(frozen=True, slots=True)
class Pair:
    """How far two members of the ensemble are apart.

    Attributes:
        first: A member.
        second: Another one.
        score: Of the second, where it is to predict the first.
    """

    first: str
    second: str
    score: Score


def measure_ensemble(console: Console, scenes: int, published: Sequence[str]) -> dict[str, Any]:
    """Sweep in every engine that is installed, print the pairs, return the figures.

    Args:
        console: Where to print.
        scenes: In how many random scenes all of PHIA's sweeps count.
        published: Scenes of which the first sweep counts.
    """
    members = [member for member in MEMBERS if _installed(member.backend)]
    with console.status("planning sweeps") as status:
        sweeps = planned_sweeps(published, PYMUNK_FITTED, first=True)
        sweeps += planned_sweeps([f"random/{seed}" for seed in range(1, scenes + 1)], PYMUNK_FITTED)
        pairs = _pairs(sweeps, members, status.update)
    _print(console, len(sweeps), pairs)
    return {"ensemble": [asdict(pair) for pair in pairs]}


def _pairs(sweeps: Sequence[PlannedSweep], members: Sequence[Member], tell: Callable[[str], None]) -> list[Pair]:
    ends: dict[str, list[State]] = {}
    for member in members:
        tell(f"{len(sweeps)} sweeps in {member.name}")
        ends[member.name] = outcomes(sweeps, member.backend, member.options)
    return [
        Pair(first, second, score(compare(sweeps, ends[second], ends[first])))
        for first, second in combinations(ends, 2)
    ]


def _installed(backend: str) -> bool:
    try:
        load(Kind.BACKEND, backend)
    except NotInstalledError:
        return False
    return True


def _print(console: Console, sweeps: int, pairs: Sequence[Pair]) -> None:
    columns = ("engine", "and engine", "median mm", "mean mm", "worst mm", "same corridor")
    table = Table(*columns, title=f"Where objects end, {sweeps} sweeps of PHIA, planar arm: two engines apart")
    for pair in pairs:
        s = pair.score
        lengths = (f"{length * 1e3:.1f}" for length in (s.median, s.mean, s.worst))
        table.add_row(pair.first, pair.second, *lengths, f"{s.same_corridor} of {s.sweeps}")
    console.print(table)
