"""Whether a plan's certainty is borne out: bins of shares, and real plans carried out as they are."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.bench.meters import __main__ as bench
from phframe.bench.meters.certainty import SHARES, binned
from phframe.runtime.scenes import scene_names


@given(st.lists(st.tuples(st.integers(0, 20).map(lambda clean: clean / 20), st.booleans())))
def test_every_plan_is_in_the_one_bin_that_its_share_belongs_to(found: list[tuple[float, bool]]) -> None:
    bins = binned(found)
    assert sum(each.plans for each in bins) == len(found)
    assert sum(each.clean for each in bins) == sum(clean for _, clean in found)
    for each in bins:
        assert each.least <= each.expected <= each.most
        assert each.interval[0] <= each.clean / each.plans <= each.interval[1]
    assert [each.least for each in bins] == sorted({each.least for each in bins})
    assert set(SHARES) >= {bound for each in bins for bound in (each.least, each.most)}


def test_plans_are_rehearsed_and_carried_out(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "papallas/s02" in scene_names()
    monkeypatch.setattr(bench, "scene_names", lambda: ["papallas/s02"])
    out = tmp_path / "certainty.json"
    bench.main(["certainty", "--scenes", "1", "--seeds", "2", "--out", str(out)])
    found = json.loads(out.read_text("utf-8"))["certainty"]
    assert found["backend"] == "pymunk"
    assert 1 <= sum(each["plans"] for each in found["bins"]) <= 4
