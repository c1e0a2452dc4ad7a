"""Fits a planar backend to MuJoCo: which of its options predict best what sweeps do in space.

The fit sees sweeps in random scenes of some seeds. It is judged by sweeps that it has not seen: those of other seeds, and
the first of each published scene. A value is moved to a neighbour on its grid only where that improves the fit by more than a
few percent, so that coefficients that MuJoCo has too stay what they are unless there is a reason.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

from phframe.bench.meters.sweeps import PlannedSweep, Score, compare, outcomes, planned_sweeps, score
from phframe.core import State
from phframe.runtime.plan_backend import FITTED, PYMUNK_FITTED

Values = Mapping[str, float | None]
GRID: Mapping[str, tuple[float | None, ...]] = {
    "standing_radius": (None, 1 / 3, 1 / 2, 2 / 3, 5 / 6, 1.0),
    "arm_acceleration": (None, 40.0, 20.0, 10.0, 5.0),
    "object_friction": (0.1, 0.15, 0.2, 0.25, 0.3),
    "arm_friction": (0.2, 0.25, 0.3, 0.35, 0.4),
}
"""What is fitted, and the values looked at; what is fitted first stands first."""
BEFORE: Values = {"standing_radius": None, "arm_acceleration": None, "object_friction": 0.2, "arm_friction": 0.3}
"""Where the fit of pymunk starts: its defaults."""
REFERENCE = "pymunk"
"""Beside whose shipped options other backends are judged."""
FAST_BEFORE: Values = {
    "standing_radius": 2 / 3,
    "arm_acceleration": None,
    "object_friction": 0.2,
    "arm_friction": 0.3,
    "step": 0.004,
    "stall_lag": 0.005,
}
"""Where the fit of the fast backend starts: its defaults."""
FAST_GRID: Mapping[str, tuple[float | None, ...]] = {
    "standing_radius": (1 / 2, 2 / 3, 5 / 6, 1.0),
    "arm_acceleration": (None, 20.0, 10.0, 5.0),
    "object_friction": (0.1, 0.15, 0.2, 0.25),
    "arm_friction": (0.2, 0.25, 0.3, 0.35, 0.4),
    "step": (0.002, 0.003, 0.004, 0.005),
    "stall_lag": (0.0025, 0.005, 0.01, 0.02),
}
GAIN = 0.03
"""A value that improves the fit by less than this fraction is not worth having."""
CROWDS = (6, 10, 14, 18)
"""Numbers of obstacles in the random scenes, in turns."""
ROUNDS = 3


@dataclass(frozen=True, slots=True)
class Tuning:
    """What can be fitted of a backend.

    Attributes:
        backend: Its name.
        grid: The values looked at.
        before: Where the fit starts: its defaults.
        shipped: What ``solve`` uses where an engine in space carries plans out.
    """

    backend: str
    grid: Mapping[str, tuple[float | None, ...]]
    before: Values
    shipped: Values


TUNINGS = {
    tuning.backend: tuning
    for tuning in (
        Tuning("pymunk", GRID, BEFORE, {**BEFORE, **PYMUNK_FITTED}),
        Tuning("fast", FAST_GRID, FAST_BEFORE, {**FAST_BEFORE, **FITTED["fast"]}),
    )
}
"""Of the planar backends, by name."""


@dataclass(frozen=True, slots=True)
class Judged:
    """A set of sweeps, as a backend predicts them with some options.

    Attributes:
        sweeps: What they are called.
        before: With the backend's defaults.
        fitted: With what was fitted.
        shipped: With what ``solve`` uses where MuJoCo carries plans out.
        beside: The same sweeps as the reference predicts them with its shipped options.
    """

    sweeps: str
    before: Score
    fitted: Score
    shipped: Score
    beside: Score


@dataclass(frozen=True, slots=True)
class Calibration:
    """The fit.

    Attributes:
        backend: What was fitted.
        fitted: The values found.
        shipped: The values that ``solve`` uses.
        judged: How well each set of sweeps is predicted.
    """

    backend: str
    fitted: Values
    shipped: Values
    judged: tuple[Judged, ...]

    def as_json(self) -> dict[str, Any]:
        """Plain values."""
        return asdict(self)


@dataclass(frozen=True, slots=True, eq=False)
class Observed:
    """Sweeps and what MuJoCo made of them.

    Attributes:
        sweeps: The sweeps.
        states: What became of each.
    """

    sweeps: Sequence[PlannedSweep]
    states: Sequence[State]

    def score(self, values: Values, backend: str = REFERENCE) -> Score:
        """How well a planar backend predicts them with some options."""
        return score(compare(self.sweeps, outcomes(self.sweeps, backend, values), self.states))


def calibrate(
    scenes: int, published: Sequence[str], tell: Callable[[str], None], backend: str = REFERENCE
) -> Calibration:
    """Fit, and judge the fit.

    Args:
        scenes: In how many random scenes sweeps are fitted, and in as many others they are judged.
        published: Scenes whose first sweeps are judged, too.
        tell: Is told what is being done.
        backend: What is fitted.
    """
    tuning, reference = TUNINGS[backend], TUNINGS[REFERENCE]
    tell("sweeping in MuJoCo")
    train, held_back = _random(range(1, scenes + 1)), _random(range(scenes + 1, 2 * scenes + 1))
    first = _observed(planned_sweeps(published, PYMUNK_FITTED, first=True))
    fitted = fit(lambda values: train.score(values, backend), tell, tuning.before, tuning.grid)
    sets = (("fitted to", train), ("held back", held_back), ("first, published", first))
    judged = tuple(
        Judged(
            name,
            before=observed.score(tuning.before, backend),
            fitted=observed.score(fitted, backend),
            shipped=observed.score(tuning.shipped, backend),
            beside=observed.score(reference.shipped),
        )
        for name, observed in sets
    )
    return Calibration(backend, fitted, tuning.shipped, judged)


def fit(
    judge: Callable[[Values], Score],
    tell: Callable[[str], None],
    before: Values = BEFORE,
    grids: Mapping[str, tuple[float | None, ...]] | None = None,
) -> Values:
    """The values on the grid that fit best, one after the other, until none moves; the grid of pymunk, if none is given."""
    values, best = dict(before), judge(before).fit
    for _ in range(ROUNDS):
        begun = dict(values)
        for name, grid in (GRID if grids is None else grids).items():
            tell(f"fitting {name}, so far {best * 1e3:.2f} mm")
            others = [value for value in grid if value != values[name]]
            fits = [judge({**values, name: value}).fit for value in others]
            if min(fits) < best * (1.0 - GAIN):
                best, values[name] = min(fits), others[fits.index(min(fits))]
        if values == begun:
            break
    return values


def _random(seeds: Sequence[int]) -> Observed:
    by_crowd = [planned_sweeps([f"random/{seed}"], {}, scenes={"count": CROWDS[seed % len(CROWDS)]}) for seed in seeds]
    return _observed([sweep for sweeps in by_crowd for sweep in sweeps])


def _observed(sweeps: Sequence[PlannedSweep]) -> Observed:
    return Observed(sweeps, outcomes(sweeps, "mujoco"))
