"""A run is carried out as its value says; what an episode keeps of it is enough to repeat it; parts may be objects."""

from __future__ import annotations

from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import pytest

import phframe
from phframe.core import Episode, InputError, OptionError, PluginError, RunSpec, Status, StoredName
from phframe.planners.ooa import OOA
from phframe.planners.phia import PHIA
from phframe.pushing.retrieve import Retrieve
from phframe.runtime.files import load, save
from phframe.runtime.plan_backend import FITTED, default_plan_backend
from phframe.runtime.run import prepare
from phframe.topology.single_linkage import SingleLinkage

EASY = "vieira/simple-03"


class Mine(OOA):
    """Registered nowhere."""


def test_solve_is_run_of_the_same_fields() -> None:
    spec = RunSpec(EASY, "ooa", topology="single-linkage", seed=3, options={"planner": {"margin": "0.02"}})
    episode = phframe.solve(
        EASY, planner="ooa", topology="single-linkage", seed=3, options={"planner": {"margin": 0.02}}
    )
    assert phframe.run(spec) == episode
    assert episode.spec.options == {"planner": {"margin": 0.02}}


@pytest.mark.parametrize("part", [OOA, OOA(OOA.options_type())], ids=["class", "object"])
def test_a_registered_class_is_its_name(part: Any) -> None:
    assert phframe.solve(EASY, planner=part) == phframe.solve(EASY, planner="ooa")


def test_the_options_of_an_object_are_those_of_the_run() -> None:
    planner = OOA(OOA.options_type(margin=0.03))
    spec = prepare(RunSpec(EASY, planner=planner, topology=SingleLinkage, goal=Retrieve)).spec
    assert (spec.planner, spec.topology, spec.goal) == ("ooa", "single-linkage", "retrieve")
    assert spec.options == {"planner": {"margin": 0.03}}
    with pytest.raises(OptionError, match="OOA is an object with options of its own"):
        phframe.solve(EASY, planner=planner, options={"planner": {"margin": 0.02}})


@pytest.mark.parametrize("part", [Mine, Mine(Mine.options_type(margin=0.02))], ids=["class", "object"])
def test_what_is_not_registered_runs_too_and_says_that_it_cannot_be_stored(part: Any, tmp_path: Path) -> None:
    episode = phframe.solve(EASY, planner=part)
    assert episode.status is Status.RETRIEVED
    assert episode.spec.name_of("planner") == "Mine"
    with pytest.raises(InputError, match="the planner is an object, Mine"):
        save(episode, tmp_path / "episode.json")
    assert list(tmp_path.iterdir()) == []


def test_what_is_no_part_of_its_kind_is_refused() -> None:
    for wrong in ({"planner": Retrieve}, {"planner": 3}, {"arm": PHIA}, {"goal": OOA(OOA.options_type())}):
        with pytest.raises(PluginError, match="is not a subclass of"):
            phframe.solve(EASY, **wrong)


CASES: list[dict[str, Any]] = [
    {},
    {"backend": {"step": 0.002}, "plan_backend": {"step": 0.004}},
    {"backend": {"step": 0.002}, "plan_backend": {"step": 1.0 / 240.0}},
    {"arm": {"link_width": 0.1}, "plan_arm": {"link_width": 0.12}},
    {"planner": {"margin": "0.02"}, "topology": {}},
]


@pytest.mark.parametrize("options", CASES, ids=str)
def test_what_an_episode_keeps_of_its_run_gives_the_same_run(options: dict[str, Any]) -> None:
    spec = prepare(RunSpec(EASY, options=options)).spec
    again = prepare(RunSpec.from_json(spec.to_json()))
    assert again.spec == spec
    assert again.spec.key() == spec.key()
    first = prepare(RunSpec(EASY, options=options))
    for name in ("backend", "arm"):
        before, after = (prepared_options(each.plan_world, name) for each in (first, again))
        assert before == after


def prepared_options(world: Any, name: str) -> dict[str, Any]:
    from phframe.registry import Kind, load

    options = load(Kind(name), getattr(world, name)).options_type
    parsed: dict[str, Any] = options.parse(getattr(world, f"{name}_options"), name).model_dump()
    return parsed


@pytest.mark.needs_mujoco
def test_a_run_whose_plans_an_engine_of_joints_carries_out_is_kept_whole() -> None:
    pytest.importorskip("mujoco")
    for spec in (RunSpec(EASY, backend="mujoco"), RunSpec(EASY, backend="mujoco", plan_backend="mujoco")):
        kept = prepare(spec)
        assert prepare(kept.spec).spec == kept.spec
        assert prepare(kept.spec).plan_world == kept.plan_world
    assert prepare(RunSpec(EASY, backend="mujoco")).spec.options["plan_backend"] == FITTED[default_plan_backend()]


def test_an_episode_is_repeated_from_what_it_keeps(tmp_path: Path) -> None:
    options: dict[str, dict[str, Any]] = {"planner": {"margin": "0.02"}, "arm": {"link_width": 0.1}}
    episode = phframe.solve("vieira/simple-08", planner="ooa", seed=2, options=options, noise="position=0.002")
    back = load(save(episode, tmp_path / "episode.json"))
    assert isinstance(back, Episode)
    assert back.spec == episode.spec
    assert phframe.run(back.spec) == episode


@pytest.mark.parametrize("part", ["planner", "backend", "arm", "plan_backend", "plan_arm", "topology", "goal", "scene"])
def test_what_comes_from_a_file_runs_no_code(part: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("x.py").write_text("from pathlib import Path\nPath('ran').touch()\nraise SystemExit\n")
    given: dict[str, Any] = {part: "x.py:Cls" if part != "scene" else "x.py:Cls/0"}
    spec = replace(RunSpec(EASY), **given)
    with pytest.raises(
        InputError, match=r"'x\.py:Cls', a class in a file, and code is not run because a file names it"
    ):
        phframe.run(RunSpec.from_json(spec.to_json()))
    assert not Path("ran").exists()


def test_a_name_from_a_file_is_replaced_by_one_that_is_given() -> None:
    spec = replace(RunSpec.from_json(RunSpec(EASY).to_json()), planner=StoredName("ooa"))
    assert phframe.run(spec).spec.planner == "ooa"


def values(content: Any) -> Any:
    """All dataclasses in a value, itself included."""
    if is_dataclass(content):
        yield content
        yield from (found for each in fields(content) for found in values(getattr(content, each.name)))
    elif isinstance(content, tuple | list | dict):
        yield from (
            found for each in (content.values() if isinstance(content, dict) else content) for found in values(each)
        )


def test_no_representation_is_long() -> None:
    episode = phframe.solve("vieira/basic")
    lengths = {type(each).__name__: len(repr(each)) for each in values(episode)}
    assert {"Episode", "Scene", "RunSpec", "Plan", "Step", "State", "GripperTrajectory", "Motion"} <= set(lengths)
    assert {name: length for name, length in lengths.items() if length > 500} == {}
    assert "status='retrieved'" in repr(episode)
    assert "planner='phia'" in repr(episode.spec)
