"""What the curves over planning time are told of each trial."""

from __future__ import annotations

from dataclasses import replace

import pytest

from phframe.bench.report.plots import observed
from phframe.bench.statistics_curves import ObservedTrial
from phframe.bench.trial_result import TrialEnd, TrialResult

LIMIT, END = 300.0, 40.0
TRIAL = TrialResult("k", "s", "s/0", "a", "pymunk", "planar", "pymunk", "planar", 0, "{}", TrialEnd.FINISHED)
LATE = replace(TRIAL, status="timeout", claimed="timeout")
KILLED = replace(TRIAL, end=TrialEnd.KILLED)


@pytest.mark.parametrize(
    ("result", "time", "solved"),
    [
        (replace(TRIAL, retrieved=True, planning_time=2.0), 2.0, True),
        (replace(TRIAL, status="failed", planning_time=2.0), LIMIT, False),
        (replace(TRIAL, end=TrialEnd.CRASHED, wall_time=2.0), LIMIT, False),
        (replace(LATE, planning_time=301.5), LIMIT, False),
        (replace(LATE, planning_time=3.5), 3.5, False),
        (replace(KILLED, wall_time=510.0), LIMIT, False),
        (replace(KILLED, wall_time=9.5), 9.5, False),
    ],
    ids=["solved", "gave up", "crashed", "time over", "simulations used up", "killed late", "killed early"],
)
def test_a_trial_is_censored_when_it_was_last_seen(result: TrialResult, time: float, solved: bool) -> None:
    assert observed(result, LIMIT, END) == ObservedTrial(time, solved)
