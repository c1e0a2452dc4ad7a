from __future__ import annotations

import re
from dataclasses import replace

import pytest

from phframe.core import Status, UnknownNameError
from phframe.runtime.scenes import find_scene
from phframe.scenes import Paper, scene_to_yaml


def home_of(name: str) -> str:
    """The scene of another suite that a scene of this one is."""
    if name.startswith("random-"):
        return name.replace("-", "/")
    return f"papallas/{name}" if re.fullmatch(r"s\d\d", name) else f"vieira/{name}"


def test_it_has_the_121_problems_in_natural_order() -> None:
    names = Paper().names()
    assert len(names) == len(set(names)) == 121
    numbered = [[int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)] for name in names]
    assert numbered == sorted(numbered)
    homes = {home_of(name) for name in names}
    assert homes >= {"vieira/basic", "vieira/simple-01", "vieira/simple-10", "papallas/s01", "papallas/s10"}
    assert homes >= {f"random/{seed}" for seed in range(100)}
    assert not any("example" in home for home in homes)


def test_each_is_the_scene_of_its_home_suite_bit_for_bit() -> None:
    for name in Paper().names():
        ours, home = find_scene(f"paper/{name}"), find_scene(home_of(name))
        assert ours.name == f"paper/{name}"
        assert replace(ours, name=home.name) == home
        assert scene_to_yaml(replace(ours, name=home.name)) == scene_to_yaml(home)


def test_a_problem_is_solved_by_its_name_like_at_home() -> None:
    import phframe

    ours, home = phframe.solve("paper/random-7"), phframe.solve("random/7")
    assert ours.status is home.status is Status.RETRIEVED
    assert [step.action for step in ours.steps] == [step.action for step in home.steps]


@pytest.mark.parametrize("name", ["random-100", "random-07", "random/7", "example-01", "", "vieira/basic", "s11"])
def test_what_is_none_of_them_is_told_in_one_line_that_is_not_endless(name: str) -> None:
    with pytest.raises(UnknownNameError, match=r"There is: paper/basic, .* and 111 more") as caught:
        Paper().load(name)
    assert len(str(caught.value)) < 400
    assert name != "s11" or "Did you mean 'paper/s" in str(caught.value)
