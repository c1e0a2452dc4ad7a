"""What is stored stays, comes back as it was, and nothing is there twice; a file that cannot be used is told in a line."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Callable
from dataclasses import fields, replace
from functools import partial
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import phframe.bench.store as store_module
from phframe.bench.environment import Environment
from phframe.bench.rows import from_row, to_row
from phframe.bench.settings import BenchSettings
from phframe.bench.store import FILE, ResultStore, StoreError
from phframe.bench.trial_result import TrialEnd, TrialResult
from phframe.core import InputError, Loop
from tests.bench.benches import a_result, settings

NUMBERS = st.floats(allow_nan=False, allow_infinity=False)
OF_TYPE: dict[str, st.SearchStrategy[Any]] = {
    "str": st.text(st.characters(codec="utf-8", exclude_characters="\0")),
    "int": st.integers(0, 2**62),
    "bool": st.booleans(),
    "float": NUMBERS,
    "float | None": st.none() | NUMBERS,
    "TrialEnd": st.sampled_from(TrialEnd),
    "Mapping[str, int]": st.dictionaries(st.text(st.characters(codec="utf-8")), st.integers(0, 9)),
}
RESULTS = st.builds(TrialResult, **{each.name: OF_TYPE[str(each.type)] for each in fields(TrialResult)})


@pytest.fixture
def store(tmp_path: Path) -> ResultStore:
    return ResultStore.create(tmp_path, settings())


@given(RESULTS)
def test_a_result_is_the_same_after_sqlite(result: TrialResult) -> None:
    marks = ", ".join("?" * len(fields(TrialResult)))
    row = sqlite3.connect(":memory:").execute(f"SELECT {marks}", to_row(result)).fetchone()
    assert from_row(row) == result


def test_results_come_back_in_order_and_none_is_there_twice(store: ResultStore, tmp_path: Path) -> None:
    results = [a_result(str(n), seed=n % 3, problem=f"s/{n % 2}", planner="ab"[n % 5 == 0]) for n in range(12)]
    assert all(store.add(result) for result in results)
    assert not store.add(replace(results[3], pushes=9))
    order = sorted(results, key=lambda each: (each.suite, each.problem, each.planner, each.seed, each.key))
    for reader in (store, ResultStore.open(tmp_path)):
        assert list(reader.results()) == order
        assert reader.done() == {str(n) for n in range(12)}
        assert reader.result("3") == results[3]
    assert store.find("1") == [each for each in order if each.key in ("1", "10", "11")]
    assert [each.key for each in store.find("s/1", "a", "1")] == ["1", "7"]
    assert [store.find(words) for words in ("", "*", "?", "[0-9]", "1*")] == [[]] * 5


def test_a_result_can_take_the_place_of_an_earlier_one_and_of_its_fault(store: ResultStore) -> None:
    store.add(a_result(end=TrialEnd.CRASHED), fault="a stack")
    assert store.fault("k") == "a stack"
    assert store.add(a_result(pushes=2), replace=True)
    assert (store.fault("k"), [each.pushes for each in store.results()]) == ("", [2])


def test_what_is_no_longer_planned_is_kept_and_left_out(store: ResultStore) -> None:
    for key in "ab":
        store.add(a_result(key))
    assert store.set_plan(settings(seeds=3), ["b", "c"], {"s/1": "x"}) == 1
    assert [each.key for each in store.results()] == ["b"]
    assert (store.done(), store.settings.seeds, store.problems()) == ({"a", "b"}, 3, {"s/1": "x"})
    assert store.set_plan(settings(), ["a"], {"s/1": "x"}) == 1
    assert [each.key for each in store.results()] == ["a"]


def test_results_count_for_the_scene_that_they_are_on_only(tmp_path: Path) -> None:
    store = ResultStore.create(tmp_path, settings(), {"s/1": "old", "s/2": "same"})
    store.add(a_result("a", pushes=1, end=TrialEnd.CRASHED), fault="of the old scene")
    store.add(a_result("b", problem="s/2"))
    assert store.set_plan(settings(), ["a", "b"], {"s/1": "new", "s/2": "same"}) == 1
    assert ([each.key for each in store.results()], store.result("a"), store.fault("a")) == (["b"], None, "")
    store.add(a_result("a", pushes=2))
    for gone, left_out in (({}, 2), ({"s/1": "newer"}, 0)):
        assert store.set_plan(settings(), ["a"], gone) == left_out
        assert (store.result("a"), list(store.results())) == (None, [])
    for digest, pushes, fault in (("old", 1, "of the old scene"), ("new", 2, ""), ("old", 1, "of the old scene")):
        store.set_plan(settings(), ["a"], {"s/1": digest})
        assert [(each.key, each.pushes, store.fault(each.key)) for each in store.results()] == [("a", pushes, fault)]


def test_environments_are_kept_once_each_in_their_order(store: ResultStore) -> None:
    here, there = Environment({"numpy": "2"}, cpu="z"), Environment(cpu="a")
    assert [store.add_environment(each) for each in (here, there, here)] == [here.id, there.id, here.id]
    assert list(store.environments().items()) == [(here.id, here), (there.id, there)]


def test_settings_come_back(tmp_path: Path) -> None:
    whole = BenchSettings(
        ("a", "b"), ("phia[sweeps=paper]",), "mujoco", "baxter", "pymunk", "planar", "ripser", "retrieve",
        {"arm": {"x": 0.1}, "planner": {}}, 3, Loop(2, 0.5, 7.0, 9), {"position": 0.01}, 512, 9.5,
    )  # fmt: skip
    ResultStore.create(tmp_path, whole, {"a/1": "d"}).close()
    with ResultStore.open(tmp_path) as store:
        assert store.settings == whole
        assert store.problems() == {"a/1": "d"}


@pytest.mark.parametrize("text", ["", "3", "[]", "{}", '{"format": 9}', '{"format": 1, "suites": ["a"], "new": 3}'])
def test_what_are_no_settings_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="no settings"):
        BenchSettings.from_json(text)


def test_wherever_the_disk_is_full_what_was_acknowledged_is_there_and_it_goes_on_later(tmp_path: Path) -> None:
    fault = "x" * 3000
    for room in count():
        folder = tmp_path / str(room)
        acknowledged, whole = _filled(folder, room, fault)
        with ResultStore.open(folder, read_only=False) as store:
            assert store.done() == set(acknowledged)
            assert [store.fault(key) for key in acknowledged] == [fault] * len(acknowledged)
            store.add(a_result("later"))
            assert "later" in store.done()
        if whole:
            assert room > 10
            return


def _filled(folder: Path, room: int, fault: str) -> tuple[list[str], bool]:
    """Store 20 results where there is room for some pages only: which were acknowledged, and whether all were."""
    acknowledged: list[str] = []
    with ResultStore.create(folder, settings()) as store:
        (pages,) = store._connection.execute("PRAGMA page_count").fetchone()
        store._connection.execute(f"PRAGMA max_page_count = {pages + room}")
        for number in range(20):
            try:
                store.add(a_result(str(number)), fault=fault)
            except StoreError as error:
                assert "disk is full. What is stored stays" in str(error)  # noqa: PT017
                return acknowledged, False
            acknowledged.append(str(number))
    return acknowledged, True


WRITES: dict[str, Callable[[ResultStore], object]] = {
    "set_plan": lambda store: store.set_plan(
        settings(seeds=7), map(str, range(500)), {f"s/{number}": "new" for number in range(400)}
    ),
    "add_environment": lambda store: store.add_environment(Environment({"x" * 20_000: "1"})),
}


def content(store: ResultStore) -> tuple[Any, ...]:
    """All that a store says."""
    results = list(store.results())
    faults = [store.fault(each.key) for each in results]
    return store.settings, store.problems(), store.environments(), store.done(), results, faults


@pytest.mark.parametrize("write", WRITES)
def test_wherever_the_disk_is_full_a_write_is_whole_or_nothing(tmp_path: Path, write: str) -> None:
    for room in count():
        with ResultStore.create(tmp_path / str(room), settings(), {"s/1": "old"}) as store:
            store.add(a_result("a"), fault="why")
            store.add(a_result("b", problem="s/2"))
            before = content(store)
            (pages,) = store._connection.execute("PRAGMA page_count").fetchone()
            store._connection.execute(f"PRAGMA max_page_count = {pages + room}")
            try:
                WRITES[write](store)
            except StoreError as error:
                assert "disk is full" in str(error)  # noqa: PT017
                assert content(store) == before
                store._connection.execute("PRAGMA max_page_count = 9999")
                WRITES[write](store)
                assert content(store) != before
                continue
            assert content(store) != before
            assert room > 1
            return


def test_wherever_the_disk_is_full_a_store_is_made_whole_or_not_at_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    connected, scenes = store_module._connected, {f"s/{number}": "x" for number in range(400)}
    for pages in count(1):
        with monkeypatch.context() as patch:
            patch.setattr(store_module, "_connected", partial(limited, connected, pages))
            try:
                ResultStore.create(tmp_path, settings(), scenes).close()
            except StoreError as error:
                assert "disk is full" in str(error)  # noqa: PT017
                assert not ResultStore.is_in(tmp_path)
                continue
        with ResultStore.open(tmp_path) as store:
            assert (store.settings, store.problems()) == (settings(), scenes)
        assert pages > 10
        return


def limited(
    connected: Callable[..., sqlite3.Connection], pages: int, path: Path, *, read_only: bool
) -> sqlite3.Connection:
    """A connection to a file of so many pages at most."""
    connection = connected(path, read_only=read_only)
    connection.execute(f"PRAGMA max_page_count = {pages}")
    return connection


def test_a_file_that_cannot_be_used_is_told_in_one_line(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="holds no bench"):
        ResultStore.open(tmp_path)
    ResultStore.create(tmp_path, settings()).close()
    with pytest.raises(StoreError, match="another bench"):
        ResultStore.create(tmp_path, settings())
    with ResultStore.open(tmp_path) as store, pytest.raises(StoreError, match="readonly"):
        store.add(a_result())
    (tmp_path / FILE).write_bytes(b"SQLite format 3\0" + b"rubbish" * 999)
    with pytest.raises(StoreError, match=r"cannot use .*results\.sqlite"):
        ResultStore.open(tmp_path)


@pytest.mark.parametrize("at", [0, 20, 4096, 5000, 9000, 16384])
def test_a_damaged_file_is_refused_or_read_and_never_a_traceback(tmp_path: Path, at: int) -> None:
    with ResultStore.create(tmp_path, settings()) as store:
        for number in range(60):
            store.add(a_result(str(number)))
    content = bytearray((tmp_path / FILE).read_bytes())
    content[at : at + 400] = b"\xa5" * 400
    (tmp_path / FILE).write_bytes(content)
    assert ResultStore.is_in(tmp_path)
    try:
        with ResultStore.open(tmp_path) as store:
            assert len(list(store.results())) == 60
    except StoreError as error:
        assert "\n" not in str(error)  # noqa: PT017 - either is right


@pytest.mark.parametrize(
    ("column", "value"),
    [
        ("prediction_error", "abc"),
        ("first_solution_time", "x"),
        ("planning_time", "soon"),
        ("pushes", 1.5),
        ("pushes", "many"),
        ("clean", 2),
        ("end", "vanished"),
        ("deviations", "[1]"),
        ("deviations", "3"),
        ("deviations", '{"a": "b"}'),
        ("deviations", "{"),
        ("deviations", "[" * 100_000),
    ],
)
def test_a_value_of_another_type_is_told_as_damage(store: ResultStore, column: str, value: object) -> None:
    store.add(a_result("k"))
    store._connection.execute(f"UPDATE results SET {column} = ?", (value,))
    for read in (lambda: list(store.results()), lambda: store.result("k"), lambda: store.find("k")):
        with pytest.raises(StoreError, match=rf"^[^\n]*{FILE} is damaged: [^\n]*{column}[^\n]*$"):
            read()


@pytest.mark.parametrize("text", ['{"versions": 3}', '{"cores": "two"}', '{"new": 3}', "[]", "3", "{"])
def test_a_place_that_cannot_be_read_is_told_as_damage(store: ResultStore, text: str) -> None:
    store.add_environment(Environment({"python": "3.11"}))
    store._connection.execute("UPDATE environments SET content = ?", (text,))
    with pytest.raises(StoreError, match="is damaged: this is no environment"):
        store.environments()


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("planners", [1]),
        ("planners", "phia"),
        ("loop", []),
        ("loop", {"new": 1}),
        ("seeds", "x"),
        ("options", 3),
        ("arm", 3),
    ],
)
def test_settings_that_cannot_be_read_are_told_as_damage(tmp_path: Path, field: str, value: object) -> None:
    with ResultStore.create(tmp_path, settings()) as store:
        text = json.dumps({**json.loads(store.settings.to_json()), field: value})
        store._connection.execute("UPDATE bench SET settings = ?", (text,))
    assert ResultStore.is_in(tmp_path)
    with pytest.raises(StoreError, match=f"is damaged: these are no settings of a bench: {field}"):
        ResultStore.open(tmp_path)


def test_words_that_no_file_can_hold_are_of_no_trial(store: ResultStore) -> None:
    store.add(a_result("k"))
    assert store.find("\udcff") == store.find("s/1", "\udcff", "0") == []


def test_a_file_of_another_format_is_refused(tmp_path: Path, store: ResultStore) -> None:
    store._connection.execute("PRAGMA user_version = 9")
    with pytest.raises(StoreError, match="format 9; this phframe reads format 1"):
        ResultStore.open(tmp_path)


def test_a_store_whose_making_was_cut_short_is_made_again(tmp_path: Path) -> None:
    assert not ResultStore.is_in(tmp_path)
    (tmp_path / FILE).touch()
    assert not ResultStore.is_in(tmp_path)
    ResultStore.create(tmp_path, settings()).close()
    assert ResultStore.is_in(tmp_path)
