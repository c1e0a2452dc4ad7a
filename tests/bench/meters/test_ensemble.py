"""The engines as an ensemble: every pair of those that are installed, on the same sweeps."""

from __future__ import annotations

import json
from itertools import combinations
from pathlib import Path

import pytest

from phframe.bench.meters import __main__ as bench
from phframe.bench.meters import ensemble
from phframe.bench.meters.ensemble import MEMBERS, Member
from phframe.registry import Kind, load


@pytest.mark.parametrize("member", MEMBERS, ids=lambda member: member.name)
def test_its_members_can_be_built(member: Member) -> None:
    pytest.importorskip({"fast": "numba"}.get(member.backend, member.backend))
    load(Kind.BACKEND, member.backend).options_type.parse(member.options, member.name)


def test_an_engine_is_apart_from_another_and_not_from_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sliding = Member("pymunk, slippery", "pymunk", {"object_friction": 0.05})
    members = (Member("pymunk", "pymunk", {}), Member("pymunk again", "pymunk", {}), sliding)
    monkeypatch.setattr(ensemble, "MEMBERS", members)
    bench.main(["ensemble", "--scenes", "2", "--out", str(tmp_path / "ensemble.json")])
    pairs = json.loads((tmp_path / "ensemble.json").read_text("utf-8"))["ensemble"]
    assert [(pair["first"], pair["second"]) for pair in pairs] == list(combinations([m.name for m in members], 2))
    same, other, _ = (pair["score"] for pair in pairs)
    assert same["worst"] == 0.0
    assert same["same_corridor"] == same["sweeps"]
    assert other["worst"] > 0.0
