"""A run is a value: it comes back from JSON, its key tells what changes the result, and what cannot be stored says so."""

from __future__ import annotations

import json
import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from phframe.core import InputError, Loop, OptionError, RunSpec, Scene, StoredName
from phframe.core.run_spec import OPTION_GROUPS, PARTS
from phframe.planners.ooa import OOA
from phframe.registry import Kind, create

BASIC: Scene = create(Kind.SCENES, "vieira").load("basic")
NAMES = st.text(st.characters(codec="utf-8"), min_size=1, max_size=8)
SCALARS = (
    st.none() | st.booleans() | st.integers(-(2**53), 2**53) | st.floats(allow_nan=False, allow_infinity=False) | NAMES
)
SPECS = st.builds(
    RunSpec,
    scene=NAMES | st.just(BASIC),
    planner=NAMES,
    plan_arm=st.none() | NAMES,
    options=st.dictionaries(st.sampled_from(OPTION_GROUPS), st.dictionaries(NAMES, SCALARS, max_size=3), max_size=3),
    seed=st.integers(0, 2**63),
    loop=st.builds(Loop, st.integers(0, 99), st.floats(0, 1), st.floats(0, 1e9), st.none() | st.integers(0, 10**6)),
    noise=st.dictionaries(NAMES, st.floats(0, 1), max_size=2),
    workers=st.integers(1, 64),
)


@given(SPECS)
def test_it_comes_back_from_json_and_from_pickle_with_the_same_key(spec: RunSpec) -> None:
    back = RunSpec.from_json(spec.to_json())
    assert back == spec == pickle.loads(pickle.dumps(spec))
    assert back.workers == spec.workers
    assert back.key() == spec.key()
    assert hash(back) == hash(spec)


def test_the_key_of_a_version_never_changes() -> None:
    assert RunSpec().key() == "78cc4f8f57779e3039221ac48421596d"
    assert (
        RunSpec("a/b", seed=3, options={"planner": {"margin": 0.02}}, loop=Loop(2)).key()
        == "76ccf73609f770696012a266c54ac6e8"
    )


CHANGES: list[dict[str, Any]] = [
    {"scene": "vieira/simple-01"},
    {"scene": BASIC},
    *({part: "other"} for part in PARTS),
    {"options": {"arm": {"link_width": 0.1}}},
    {"seed": 1},
    {"loop": Loop(simulations=4)},
    {"noise": {"position": 0.01}},
]


def test_the_key_tells_what_changes_the_result_and_nothing_else() -> None:
    spec = RunSpec()
    others = [replace(spec, **change) for change in CHANGES]
    assert len({spec.key(), *(other.key() for other in others)}) == len(CHANGES) + 1
    assert spec not in others
    assert replace(spec, workers=8) == spec
    assert replace(spec, workers=8).key() == spec.key()
    assert replace(spec, loop=Loop(time_limit=300)).key() == spec.key()
    assert replace(spec, options={"arm": {}}) == spec
    options: dict[str, dict[str, Any]] = {"arm": {"a": 1, "b": 2.0}, "planner": {"c": True}}
    turned: dict[str, dict[str, Any]] = {"planner": {"c": True}, "arm": {"b": 2, "a": 1}}
    assert RunSpec(options=options).key() == RunSpec(options=turned).key()
    assert RunSpec(options={"planner": {"c": 1}}).key() != RunSpec(options=turned).key()


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("value", [OOA, OOA(OOA.options_type())], ids=["class", "object"])
def test_what_holds_an_object_cannot_be_stored_and_says_what_to_do(part: str, value: object) -> None:
    given: dict[str, Any] = {part: value}
    spec = RunSpec(**given)
    assert spec.name_of(part) == "OOA"
    for use in (spec.to_json, spec.key):
        with pytest.raises(InputError, match=rf"the {part} is an object, OOA, .*{part}='./file.py:OOA'"):
            use()


def test_an_option_that_is_no_json_cannot_be_stored() -> None:
    with pytest.raises(InputError, match=r"cannot be stored: options\.arm"):
        RunSpec(options={"arm": {"x": object()}}).to_json()


def test_names_that_come_from_json_are_marked_as_such() -> None:
    spec = RunSpec.from_json(RunSpec(planner="./x.py:Cls", plan_arm="planar").to_json())
    named = [getattr(spec, part) for part in ("scene", *PARTS) if getattr(spec, part) is not None]
    assert {type(name) for name in named} == {StoredName}
    assert type(pickle.loads(pickle.dumps(spec)).planner) is StoredName


def test_a_path_is_a_file() -> None:
    assert RunSpec(Path("shelf")).scene == "./shelf"
    assert RunSpec(Path("/tmp/shelf")).scene == "/tmp/shelf"


@pytest.mark.parametrize(
    "wrong",
    [
        {"scene": 3},
        {"seed": -1},
        {"seed": 0.5},
        {"seed": "1"},
        {"workers": 0},
        {"options": {"gripper": {}}},
        {"options": {"arm": 3}},
        {"options": {"arm": {1: 2}}},
        {"options": [1]},
    ],
)
def test_what_is_no_run_is_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        RunSpec(**wrong)


def test_options_of_what_has_none_say_what_has() -> None:
    with pytest.raises(OptionError, match=r"no options of 'gripper'; there are those of: planner, .*scenes"):
        RunSpec(options={"gripper": {}})


DOCUMENT = json.loads(RunSpec(options={"arm": {"a": 1}}).to_json())


@given(st.sampled_from(sorted(DOCUMENT)), SCALARS | st.just([]) | st.just({"a": 1}))
def test_whatever_is_wrong_in_json_it_is_read_or_refused(field: str, value: Any) -> None:
    for document in ({**DOCUMENT, field: value}, {key: each for key, each in DOCUMENT.items() if key != field}):
        try:
            assert RunSpec.from_json(json.dumps(document)).key()
        except InputError as error:
            assert "\n" not in str(error)  # noqa: PT017 - either is right


@pytest.mark.parametrize("text", ["", "[]", "3", "{}", '{"format": 99}', "[" * 100_000], ids=lambda text: text[:9])
def test_what_is_no_json_of_a_run_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="no run"):
        RunSpec.from_json(text)
