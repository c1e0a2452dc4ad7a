"""The published scenes hold the published figures."""

from __future__ import annotations

import math
from importlib.resources import files
from pathlib import Path

import pytest

from phframe.core import SceneSuite, UnknownNameError
from phframe.scenes import Papallas, Vieira, is_file_spec

SUITES = {"vieira": Vieira(), "papallas": Papallas()}

# scene: number of obstacles, target (m), and sums of the obstacles' x and y (1e-5 m), each times its number in the list
PUBLISHED: dict[str, tuple[int, tuple[float, float], int, int]] = {
    "vieira/basic": (10, (0.43164, 0.37815), 1000324, 1961006),
    "vieira/example-01": (9, (0.3825, 0.46403), 559758, 1000818),
    "vieira/example-02": (9, (0.36891, 0.42128), 735797, 1387231),
    "vieira/example-03": (9, (0.49175, 0.1649), 1119412, 1002997),
    "vieira/example-04": (9, (0.49083, 0.18049), 993848, 1513051),
    "vieira/example-05": (9, (0.37733, 0.48919), 1002473, 1176958),
    "vieira/example-06": (9, (0.42318, 0.04694), 737056, 1126633),
    "vieira/example-07": (9, (0.48744, 0.30413), 853415, 1406921),
    "vieira/example-08": (9, (0.45249, 0.05797), 1055853, 1285863),
    "vieira/example-09": (9, (0.4543, 0.1822), 1151887, 1409365),
    "vieira/example-10": (9, (0.45483, 0.37373), 1201298, 1532881),
    "vieira/simple-01": (3, (0.345, 0.19665), 109230, 48786),
    "vieira/simple-02": (3, (0.345, 0.43018), 141460, 242882),
    "vieira/simple-03": (3, (0.345, 0.37898), 130970, 208154),
    "vieira/simple-04": (3, (0.345, 0.32459), 116735, 224091),
    "vieira/simple-05": (3, (0.345, 0.34527), 105773, 199648),
    "vieira/simple-06": (3, (0.345, 0.36384), 73686, 211446),
    "vieira/simple-07": (3, (0.345, 0.29263), 121372, 179590),
    "vieira/simple-08": (3, (0.345, 0.41035), 92094, 219230),
    "vieira/simple-09": (3, (0.345, 0.31032), 113496, 198506),
    "vieira/simple-10": (3, (0.345, 0.24635), 62591, 217888),
    "papallas/s01": (9, (0.56208, 0.48682), 1724091, 1803047),
    "papallas/s02": (9, (0.47278, 0.40595), 1719363, 1331440),
    "papallas/s03": (9, (0.47892, 0.42795), 1576075, 1465047),
    "papallas/s04": (9, (0.54106, 0.45745), 1635753, 1272710),
    "papallas/s05": (9, (0.55441, 0.4687), 1782666, 1480518),
    "papallas/s06": (9, (0.49142, 0.41215), 1694942, 1047732),
    "papallas/s07": (9, (0.5245, 0.18132), 1968450, 1253570),
    "papallas/s08": (9, (0.54577, 0.50737), 1759379, 1226987),
    "papallas/s09": (9, (0.54495, 0.15672), 1660500, 1168364),
    "papallas/s10": (9, (0.47081, 0.40453), 1771753, 1278048),
}
SHELVES = {"vieira": (0.55, 0.61, 0.4), "papallas": (0.594, 0.584, 0.4)}


@pytest.mark.parametrize("full_name", PUBLISHED)
def test_figures_are_the_published_ones(full_name: str) -> None:
    count, target, x_sum, y_sum = PUBLISHED[full_name]
    suite, name = full_name.split("/")
    scene = SUITES[suite].load(name)
    assert scene.name == full_name
    assert (scene.shelf.depth, scene.shelf.width, scene.shelf.height) == SHELVES[suite]
    assert scene.ids == (*(f"object_{i}" for i in range(1, count + 1)), "target")
    assert scene.target == "target"
    assert scene.objects[-1].position == target
    obstacles = list(enumerate(scene.objects[:-1], 1))
    assert sum(i * round(item.position[0] * 1e5) for i, item in obstacles) == x_sum
    assert sum(i * round(item.position[1] * 1e5) for i, item in obstacles) == y_sum
    assert {(item.radius, item.shape.height, item.mass, item.friction) for item in scene.objects} == {
        (0.03, 0.12, 0.3, None)
    }


def test_there_are_31() -> None:
    found = [f"{suite}/{name}" for suite, scenes in SUITES.items() for name in scenes.names()]
    assert sorted(found) == sorted([*PUBLISHED])
    assert len(found) == 31
    assert Vieira().names()[0] == "basic"


def test_simple_01_touches_the_wall_it_was_published_inside() -> None:
    positions = [item.position for item in Vieira().load("simple-01").objects]
    assert positions[:3] == [(0.05115, 0.15942), (0.147, 0.03), (0.24905, 0.08948)]


def test_simple_02_has_two_obstacles_touching_that_were_published_in_one_another() -> None:
    first, a, b = (item.position for item in Vieira().load("simple-02").objects[:3])
    assert first == (0.13914, 0.31518)
    assert 0.06 <= math.dist(a, b) < 0.06001
    published_a, published_b = (0.28187, 0.41018), (0.23918, 0.43018)
    middle = [(p + q) / 2.0 for p, q in zip(published_a, published_b, strict=True)]
    assert [(p + q) / 2.0 for p, q in zip(a, b, strict=True)] == pytest.approx(middle, abs=1e-9)
    assert math.dist(a, published_a) < 0.0065


@pytest.mark.parametrize("full_name", PUBLISHED)
def test_each_file_begins_with_its_source_and_what_was_changed(full_name: str) -> None:
    lines = (files("phframe.scenes") / "data" / f"{full_name}.yaml").read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("# Source: ")
    comment = "\n".join(line for line in lines if line.startswith("#"))
    assert "Changed: moved to the shelf frame" in comment
    assert ("Changed too: " in comment) == (full_name in ("vieira/simple-01", "vieira/simple-02"))
    assert ("0.14," in comment) == (full_name == "vieira/basic")


@pytest.mark.parametrize("name", ["basik", "", "../papallas/s01", "basic.yaml", "Basic", "vieira/basic"])
def test_an_unknown_scene_says_what_there_is(name: str) -> None:
    with pytest.raises(UnknownNameError, match=r"no scene named .*There is: vieira/basic, vieira/example-01") as caught:
        Vieira().load(name)
    if name == "basik":
        assert "Did you mean 'vieira/basic'?" in str(caught.value)


def test_suites_take_no_options() -> None:
    assert isinstance(SUITES["vieira"], SceneSuite)
    assert Vieira.options_type.model_fields == {}


def test_a_file_is_told_from_a_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plain").touch()
    (tmp_path / "vieira").mkdir()
    for spec in ("a.yaml", "A.YML", "./a", "../a", "/a", "~/a", "plain", Path("vieira")):
        assert is_file_spec(spec), spec
    for spec in ("vieira/basic", "random/7", "vieira", "", "basic", "a\0b", "x" * 5000):
        assert not is_file_spec(spec), spec
