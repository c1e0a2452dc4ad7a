"""Plans and episodes come back from files bit by bit; what is no such file is refused; nothing is left half-written."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from phframe.core import Episode, InputError, Plan
from phframe.pushing import PushDecision
from phframe.runtime.files import load, save
from phframe.runtime.solve import solve
from phframe.runtime.summary import summarize

EPISODE = solve("vieira/example-08", options={"planner": {"margin": "0.01"}, "arm": {"link_width": 0.11}})
FAILED = solve("vieira/basic", options={"planner": {"max_actions": 1}})


@pytest.fixture(scope="module")
def document(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What is in the file of a small episode."""
    path = save(solve("vieira/simple-10"), tmp_path_factory.mktemp("files") / "small.json")
    content: dict[str, Any] = json.loads(path.read_text())
    return content


@pytest.mark.parametrize("episode", [EPISODE, FAILED], ids=["retrieved", "failed"])
def test_episodes_come_back_as_they_were(episode: Episode, tmp_path: Path) -> None:
    back = load(save(episode, tmp_path / "episode.json"))
    assert isinstance(back, Episode)
    assert back == episode
    assert summarize(back) == summarize(episode)
    assert [plan.cost for plan in back.plans] == [plan.cost for plan in episode.plans]


def test_plans_come_back_as_they_were(tmp_path: Path) -> None:
    for number, plan in enumerate((*EPISODE.plans, *FAILED.plans)):
        back = load(save(plan, tmp_path / f"{number}.json"))
        assert isinstance(back, Plan)
        assert back == plan
        assert back.cost == plan.cost


def test_saved_again_it_is_the_same_text(tmp_path: Path) -> None:
    first = save(EPISODE, tmp_path / "a.json").read_text()
    assert save(load(tmp_path / "a.json"), tmp_path / "b.json").read_text() == first


def test_what_was_loaded_is_as_immutable_as_what_was_saved(tmp_path: Path) -> None:
    back = load(save(EPISODE, tmp_path / "episode.json"))
    assert isinstance(back, Episode)
    for array in (back.final_state.poses, back.steps[0].action.path.poses, back.steps[0].trajectory.times):
        assert not array.flags.writeable
    labels = PushDecision.of(back.plans[0].decisions[0]).labels
    assert labels is not None
    assert not labels.flags.writeable
    hash(back.steps[0].action)


BAD = {
    "empty": "",
    "no JSON": "phframe: 1",
    "truncated": '{"phframe": 2, "kind": "plan", "plan": {"status": "clea',
    "a list": "[1, 2]",
    "null": "null",
    "no kind": '{"phframe": 2}',
    "another kind": '{"phframe": 2, "kind": "scene", "scene": {}}',
    "a kind that is a list": '{"phframe": 2, "kind": [], "plan": {}}',
    "no plan": '{"phframe": 2, "kind": "plan"}',
    "an older format": '{"phframe": 1, "kind": "plan", "plan": {"status": "cleared"}}',
    "a newer format": '{"phframe": 3, "kind": "plan", "plan": {"status": "cleared"}}',
    "a format of text": '{"phframe": "2", "kind": "plan", "plan": {"status": "cleared"}}',
    "no format": '{"kind": "plan", "plan": {"status": "cleared"}}',
    "an unknown status": '{"phframe": 2, "kind": "plan", "plan": {"status": "done"}}',
    "deeply nested": "[" * 100_000,
    "a huge number": '{"phframe": 2, "kind": "plan", "plan": {"status": "failed", "cost": {"total": 1%s}}}'
    % ("0" * 400),
}


@pytest.mark.parametrize("what", BAD)
def test_what_is_no_such_file_is_refused_by_name(what: str, tmp_path: Path) -> None:
    path = tmp_path / "bad.json"
    path.write_text(BAD[what])
    with pytest.raises(InputError) as caught:
        load(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_newer_format_is_named_with_the_one_that_is_read(tmp_path: Path) -> None:
    (tmp_path / "new.json").write_text(BAD["a newer format"])
    with pytest.raises(InputError, match="format 3; this phframe reads format 2"):
        load(tmp_path / "new.json")


def test_what_cannot_be_read_says_so(tmp_path: Path) -> None:
    for path in (tmp_path / "absent.json", tmp_path):
        with pytest.raises(InputError, match="cannot read"):
            load(path)
    (tmp_path / "bytes.json").write_bytes(b"\xff\xfe\x00garbage")
    with pytest.raises(InputError):
        load(tmp_path / "bytes.json")


def places(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Where something in a document can be replaced."""
    items = value.items() if isinstance(value, dict) else enumerate(value[:2]) if isinstance(value, list) else ()
    return [path, *(place for key, item in items for place in places(item, (*path, key)))]


JUNK: list[Any] = [None, True, -1, 10**400, 2**70, "x", "inf", "nan", [], [[]], [1, [2]], {}, {"a": 1}, 1e308]


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data(), wrong=st.sampled_from(JUNK), drop=st.booleans())
def test_whatever_is_wrong_in_a_file_it_is_read_or_refused(
    document: dict[str, Any], tmp_path: Path, data: st.DataObject, wrong: Any, drop: bool
) -> None:
    spoilt = copy.deepcopy(document)
    *way, last = data.draw(st.sampled_from(places(document)[1:]))
    parent = spoilt
    for key in way:
        parent = parent[key]
    if drop:
        del parent[last]
    else:
        parent[last] = wrong
    path = tmp_path / "spoilt.json"
    path.write_text(json.dumps(spoilt))
    try:
        back = load(path)
    except InputError as error:
        assert str(path) in str(error)  # noqa: PT017 - either is right
    else:
        assert isinstance(back, Episode)


def test_a_file_is_replaced_whole_and_nothing_else_is_left(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "er" / "plan.json"
    save(EPISODE.plans[0], path)
    save(FAILED.plans[0], path)
    assert load(path) == FAILED.plans[0]
    assert [each.name for each in path.parent.iterdir()] == ["plan.json"]


def test_a_path_that_cannot_be_written_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    (tmp_path / "folder").mkdir()
    for path in (tmp_path / "file" / "plan.json", tmp_path / "folder"):
        with pytest.raises(InputError, match="cannot write"):
            save(EPISODE.plans[0], path)
    assert sorted(each.name for each in tmp_path.iterdir()) == ["file", "folder"]
    assert list((tmp_path / "folder").iterdir()) == []
