"""``solve``: names, options and scenes that cannot be are refused in sentences; the rest is an episode."""

from __future__ import annotations

import platform
from pathlib import Path
from typing import Any

import pytest

import phframe
from phframe.core import Episode, InputError, OptionError, PhframeError, SceneError, Status, UnknownNameError
from phframe.runtime.scenes import find_scene, scene_names
from phframe.runtime.solve import solve
from tests.runtime.worlds import BASIC

EASY = "vieira/simple-10"


def test_it_is_in_the_public_interface() -> None:
    assert phframe.solve is solve
    episode = phframe.solve(EASY)
    assert isinstance(episode, Episode)
    assert episode.status is Status.RETRIEVED


def test_the_default_scene_is_basic() -> None:
    assert solve().scene == BASIC


def test_the_setup_is_noted() -> None:
    episode = solve(
        EASY, planner="ooa", topology="single-linkage", seed=4, options={"planner": {"margin": "0.02"}, "arm": {}}
    )
    spec = episode.spec
    assert (spec.planner, spec.backend, spec.arm) == ("ooa", "pymunk", "planar")
    assert (spec.topology, spec.seed) == ("single-linkage", 4)
    assert {group: dict(values) for group, values in spec.options.items()} == {"planner": {"margin": 0.02}}
    assert {"python", "phframe", "numpy", "pymunk", "scipy"} <= set(episode.versions)
    assert "mujoco" not in episode.versions
    architecture, *instructions = episode.versions["cpu"].split()
    assert architecture == platform.machine()
    assert instructions


def test_both_topology_engines_come_to_the_same() -> None:
    one, other = (solve("vieira/example-05", topology=engine) for engine in ("ripser", "single-linkage"))
    assert [step.action.name for step in one.steps] == [step.action.name for step in other.steps]
    assert one.final_state == other.final_state


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"planner": "phya"}, ["planner", "'phya'", "Did you mean 'phia'?", "ooa"]),
        ({"backend": "pymunkk"}, ["backend", "'pymunkk'", "Did you mean 'pymunk'?"]),
        ({"arm": "planer"}, ["arm", "'planer'", "Did you mean 'planar'?"]),
        ({"topology": "rips"}, ["topology", "'rips'", "ripser", "single-linkage"]),
        ({"scene": "vieira/basik"}, ["scene", "vieira/basik", "Did you mean", "vieira/basic"]),
        ({"scene": "viera/basic"}, ["viera", "vieira"]),
        ({"scene": "vieira"}, ["vieira/basic", "vieira/example-01"]),
    ],
)
def test_unknown_names_say_what_exists(wrong: dict[str, str], words: list[str]) -> None:
    with pytest.raises(UnknownNameError) as caught:
        solve(**{"scene": EASY, **wrong})  # type: ignore[arg-type]
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"planner": {"half_widht": 0.1}}, ["half_widht", "Did you mean 'half_width'?"]),
        ({"planner": {"half_width": "wide"}}, ["half_width", "'wide'"]),
        ({"planner": {"half_width": -0.1}}, ["half_width", "-0.1"]),
        ({"planner": {"max_actions": 0}}, ["max_actions", "0"]),
        ({"planner": {"margin": float("nan")}}, ["margin", "nan"]),
        ({"backend": {"step": 1.0}}, ["step", "1.0"]),
        ({"arm": {"link_width": 0}}, ["link_width"]),
        ({"topology": {"x": 1}}, ["'x'", "none"]),
        ({"gripper": {}}, ["'gripper'", "planner", "backend", "arm", "topology", "scenes"]),
        ({"scenes": {"seed": 1}}, ["'seed'"]),
    ],
)
def test_options_that_cannot_be_say_which_and_why(options: dict[str, Any], words: list[str]) -> None:
    with pytest.raises(OptionError) as caught:
        solve(EASY, options=options)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    "wrong", [{"seed": -1}, {"time_limit": -1.0}, {"max_replans": -1}, {"workers": 0}, {"tolerance": float("nan")}]
)
def test_figures_that_cannot_be_are_refused(wrong: dict[str, Any]) -> None:
    with pytest.raises(InputError):
        solve(EASY, **wrong)


def test_a_scene_file_is_read_and_a_bad_one_refused(tmp_path: Path) -> None:
    good = tmp_path / "mine.yaml"
    good.write_text(
        "phframe: 1\nname: mine\nshelf: {depth: 0.6, width: 0.6, height: 0.4}\ntarget: t\nobjects:\n"
        "  - {id: t, shape: cylinder, radius: 0.03, height: 0.12, position: [0.4, 0.3]}\n"
    )
    assert solve(good).status is Status.RETRIEVED
    assert solve(str(good)).scene.target == "t"
    good.write_text(good.read_text().replace("0.4, 0.3]", "0.4, 0.9]"))
    with pytest.raises(SceneError, match="inside the north wall"):
        solve(good)
    with pytest.raises(InputError, match="nowhere"):
        solve(tmp_path / "nowhere.yaml")
    with pytest.raises(InputError, match="takes no options"):
        solve(good, options={"scenes": {"count": 3}})


def test_scenes_have_names_that_find_them() -> None:
    names = scene_names()
    assert {"vieira/basic", "papallas/s01"} <= set(names)
    assert len(names) == len(set(names)) >= 32
    assert all(find_scene(name).name == name for name in names)
    assert find_scene(BASIC) is BASIC
    assert len(find_scene("random/3", {"count": 4}).objects) == 5


def test_every_error_is_one_of_phframes() -> None:
    for wrong in ({"scene": "a/b"}, {"planner": ""}, {"planner": "./none.py:None"}, {"scene": ""}):
        with pytest.raises(PhframeError) as caught:
            solve(**{"scene": EASY, **wrong})  # type: ignore[arg-type]
        assert str(caught.value)
