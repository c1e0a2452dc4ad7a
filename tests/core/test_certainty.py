"""How sure a plan is: a fraction of samples, saved and loaded with the plan."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter

from phframe.core import Certainty, Plan, Status

counts = st.integers(0, 1000).flatmap(lambda samples: st.tuples(st.just(samples), st.integers(0, samples)))
ADAPTER = TypeAdapter(Plan)
clearances = st.none() | st.floats(0.0, 1.0)


@given(counts, clearances)
def test_the_share_is_of_the_samples_if_there_were_any(count: tuple[int, int], clearance: float | None) -> None:
    samples, clean = count
    share = Certainty(clearance, samples, clean).share
    assert (share is None) is (samples == 0)
    if share is not None:
        assert 0.0 <= share <= 1.0
        assert share * samples == pytest.approx(clean)


@given(counts, clearances)
def test_a_plan_is_saved_and_loaded_with_it(count: tuple[int, int], clearance: float | None) -> None:
    plan = Plan(Status.RETRIEVED, certainty=Certainty(clearance, *count))
    loaded = ADAPTER.validate_json(ADAPTER.dump_json(plan))
    assert loaded == plan
    assert loaded.certainty == Certainty(clearance, *count)
    assert replace(plan, certainty=None) != plan


def test_a_plan_from_before_there_was_any_is_loaded_without() -> None:
    loaded = ADAPTER.validate_json('{"status": "retrieved", "reason": ""}')
    assert loaded.certainty is None
