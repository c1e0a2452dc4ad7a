"""Decisions of any method go through files, and what is not known here is kept as it was written."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import ClassVar

from pydantic import TypeAdapter

from phframe.core import Decision
from phframe.core.decision import AnyDecision, UnknownDecision

ADAPTER: TypeAdapter[Decision] = TypeAdapter(AnyDecision)


@dataclass(frozen=True, slots=True, eq=False)
class Hunch(Decision):
    """A decision of a method of one's own."""

    kind: ClassVar[str] = "hunch"

    strength: float = 0.0


def test_a_decision_of_ones_own_comes_back_as_it_was() -> None:
    hunch = Hunch("it felt right", ("a guess",), strength=0.25)
    text = ADAPTER.dump_json(hunch)
    assert json.loads(text) == {"kind": "hunch", "why": "it felt right", "deviations": ["a guess"], "strength": 0.25}
    back = ADAPTER.validate_json(text)
    assert type(back) is Hunch
    assert back == hunch


def test_what_a_later_version_adds_is_passed_over() -> None:
    assert ADAPTER.validate_python({"kind": "hunch", "why": "so", "strength": 1.0, "colour": "red"}) == Hunch(
        "so", (), 1.0
    )


def test_a_decision_of_a_method_that_is_not_here_is_kept_and_names_no_code() -> None:
    written = {"kind": "os:system", "why": "because", "deviations": [], "data": [1, {"a": 2}]}
    back = ADAPTER.validate_python(written)
    assert isinstance(back, UnknownDecision)
    assert back.why == "because"
    assert json.loads(ADAPTER.dump_json(back)) == written
