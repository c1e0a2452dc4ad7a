"""Scenes of other programs become scenes of ours, and what is lost on the way is said."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from phframe.core import PhframeError, Scene, SceneError, UnknownNameError, rotation_matrix
from phframe.runtime.scenes import find_scene, scene_names
from phframe.scenes import parse_scene, scene_to_yaml
from phframe.scenes.importer import Imported, to_scene
from phframe.scenes.mjcf import body_names, scene_to_mjcf
from tests.scenes.test_mjcf import ODD

pytestmark = pytest.mark.needs_mujoco

pytest.importorskip("mujoco")

from phframe.scenes.mujoco_ import read_mjcf  # noqa: E402

FOREIGN = Path(__file__).parent / "foreign.xml"
CENTER, YAW = np.array([1.0, -2.0]) + rotation_matrix(math.radians(30)) @ [0.5, 0.25], math.radians(120)
"""Of the cabinet in the file: that of the room, and then its own."""

Import = Callable[..., Imported]


@pytest.fixture
def imported(tmp_path: Path) -> Import:
    def read(text: str, target: str | None = None) -> Imported:
        path = tmp_path / "scene.xml"
        path.write_text(text)
        return to_scene(read_mjcf(path), str(path), target)

    return read


@pytest.mark.parametrize("name", scene_names())
def test_what_was_exported_is_imported_as_the_same_scene(imported: Import, name: str) -> None:
    scene = find_scene(name)
    back = imported(scene_to_mjcf(scene))
    assert back.scene == scene
    assert not [note for note in back.notes if "ignored" in note]


def test_a_scene_of_odd_names_and_figures_comes_back_but_for_names_that_mujoco_cannot_have(imported: Import) -> None:
    named = zip(ODD.objects, body_names(ODD), strict=True)
    objects = tuple(replace(item, id=name) for item, name in named)
    target = body_names(ODD)[ODD.target_index]
    assert imported(scene_to_mjcf(ODD)).scene == replace(ODD, objects=objects, target=target)


def test_an_arm_in_it_is_ignored(imported: Import) -> None:
    from phframe.arms.planar import PlanarArm, PlanarArmOptions
    from phframe.backends.mujoco_.export import with_arm

    scene, arm = find_scene("papallas/s02"), PlanarArm(PlanarArmOptions())
    back = imported(with_arm(scene_to_mjcf(scene), arm, arm.default_base_pose(scene.shelf)))
    assert back.scene == scene
    assert any("actuators: 5" in note for note in back.notes)


def test_a_cabinet_of_others_is_found_where_it_stands(imported: Import) -> None:
    """Nested and turned bodies, degrees, defaults; the shelf's inside is 0.6 by 0.5 by 0.4 m."""
    back = imported(FOREIGN.read_text())
    shelf = back.scene.shelf
    assert (shelf.depth, shelf.width, shelf.height) == pytest.approx((0.6, 0.5, 0.4), abs=1e-9)
    assert (shelf.board_friction, shelf.wall_friction) == (0.6, 0.9)
    assert (back.scene.name, back.scene.target) == ("lab cabinet", "goal_can")
    cola, goal = back.scene.objects
    corner = CENTER + rotation_matrix(YAW) @ [-0.3, -0.25]
    expected = rotation_matrix(-YAW) @ (np.array([1.1, -1.6]) - corner)
    assert goal.position == pytest.approx(tuple(expected), abs=1e-9)
    expected = rotation_matrix(-YAW) @ (
        np.array([1.0, -2.0]) + rotation_matrix(math.radians(30)) @ [0.45, 0.40] - corner
    )
    assert cola.position == pytest.approx(tuple(expected), abs=1e-9)
    assert cola.mass == pytest.approx(800 * math.pi * 0.033**2 * 0.12)
    assert goal.mass == pytest.approx(0.3)
    assert (goal.shape.radius, goal.shape.height, goal.friction) == (0.033, 0.12, 0.9)


def test_what_was_decided_and_ignored_is_said(imported: Import) -> None:
    said = "\n".join(imported(FOREIGN.read_text()).notes)
    for part in (
        "board 'bottom', south wall 'right', north wall 'left', back wall 'rear', ceiling 'top'",
        "yaw 120 degrees",
        "guessed by its name",
        "ignored: free bodies that do not stand in the shelf: 'on the floor'",
        "ignored: the free body 'ball': no cylinder or box (sphere)",
        "ignored: fixed boxes and planes that are no part of the shelf: 'floor'",
        "ignored: fixed capsule 'hook'",
        "collides with nothing 'sign'",
        "1 smaller geoms of 'goal_can'",
        "ignored: 1 geoms moved by joints, of 'robot'",
        "ignored: actuators: 1",
    ):
        assert part in said


def test_the_target_can_be_named_and_must_be_in_the_shelf(imported: Import) -> None:
    assert imported(FOREIGN.read_text(), "cola").scene.target == "cola"
    with pytest.raises(UnknownNameError, match="There is: cola, goal_can"):
        imported(FOREIGN.read_text(), "ball")


def test_missing_meshes_and_pictures_do_not_matter(imported: Import) -> None:
    whole = imported(FOREIGN.read_text()).scene
    spoilt = FOREIGN.read_text().replace(
        '<mesh name="logo" vertex="0 0 0  0.1 0 0  0 0.1 0  0 0 0.1"/>',
        '<mesh name="logo" file="logo.stl"/><texture name="wood" type="2d" file="wood.png"/>'
        '<material name="wood" texture="wood"/>',
    )
    back = imported(spoilt.replace('name="rear"', 'name="rear" material="wood"'))
    assert back.scene == whole
    assert any("does not load" in note and "logo.stl" in note for note in back.notes)


def test_a_body_that_was_but_a_missing_mesh_is_left_out(imported: Import) -> None:
    body = '<body name="mug" pos="0 0 0.06"><freejoint/><geom type="mesh" mesh="mug"/></body>'
    text = shelf_text().replace("<worldbody>", f'<asset><mesh name="mug" file="mug.stl"/></asset><worldbody>{body}')
    back = imported(text)
    assert back.scene == imported(shelf_text()).scene
    assert any("'mug': no cylinder or box (no shape)" in note for note in back.notes)


@pytest.mark.parametrize("quarter", range(4))
def test_the_mouth_may_be_on_any_side(imported: Import, quarter: int) -> None:
    text = FOREIGN.read_text()
    turned = text.replace("<worldbody>", f'<worldbody><frame euler="0 0 {90 * quarter}">')
    back, scene = imported(turned.replace("</worldbody>", "</frame></worldbody>")).scene, imported(text).scene
    assert back.shelf == scene.shelf, "seen from the mouth it is the same"
    np.testing.assert_allclose([item.position for item in back.objects], [item.position for item in scene.objects])
    assert [item.yaw for item in back.objects] == pytest.approx([item.yaw for item in scene.objects], abs=1e-8)


SHELF = """
<mujoco><worldbody>
  <geom name="board" type="{board}" size="0.3 0.3 0.01" pos="0 0 {z}"/>
  <geom name="south" type="box" size="0.3 0.01 0.2" pos="0 -0.31 0.2"/>
  <geom name="north" type="box" size="0.3 0.01 0.2" pos="0 0.31 0.2"/>
  {more}
  <body name="a" pos="0.1 0.1 {a}"><freejoint/><geom type="{shape}" size="0.03 0.06 0.06" {geom}/></body>
</worldbody></mujoco>
"""
BACK = '<geom name="back" type="box" size="0.01 0.3 0.2" pos="0.31 0 0.2"/>'
FRONT = '<geom name="front" type="box" size="0.01 0.3 0.2" pos="-0.31 0 0.2"/>'


def shelf_text(board: str = "box", more: str = BACK, a: float = 0.06, shape: str = "cylinder", geom: str = "") -> str:
    return SHELF.format(board=board, z=-0.01 if board == "box" else 0.0, more=more, a=a, shape=shape, geom=geom)


def only(scene: Scene) -> tuple[float, ...]:
    (item,) = scene.objects
    return (*item.position, item.shape.radius, item.shape.height)


def test_a_plane_is_a_board_too_and_without_a_ceiling_the_walls_say_how_high(imported: Import) -> None:
    for board in ("box", "plane"):
        back = imported(shelf_text(board))
        assert only(back.scene) == pytest.approx((0.4, 0.4, 0.03, 0.12))
        shelf = back.scene.shelf
        assert (shelf.depth, shelf.width, shelf.height) == pytest.approx((0.6, 0.6, 0.4))
        assert any("no ceiling" in note for note in back.notes)
        assert any("the first object" in note for note in back.notes)


def test_a_box_is_the_cylinder_around_it_and_what_hovers_is_put_down(imported: Import) -> None:
    back = imported(shelf_text(a=0.07, shape="box"))
    assert only(back.scene) == pytest.approx((0.4, 0.4, math.hypot(0.03, 0.06), 0.12))
    assert any("cylinder around it" in note for note in back.notes)
    assert any("put on the board" in note for note in back.notes)


BAD = {
    "not XML": ("<mujoco", "not valid XML"),
    "empty": ("", "not valid XML"),
    "another program's": ("<robot name='a'/>", "root is <robot>"),
    "an unknown element": ("<mujoco><nonsense/></mujoco>", "nonsense"),
    "an include that is missing": ('<mujoco><include file="nowhere.xml"/></mujoco>', "nowhere.xml"),
    "itself included": ('<mujoco><include file="scene.xml"/></mujoco>', "scene.xml"),
    "nothing": ("<mujoco/>", "no shelf"),
    "no walls": (shelf_text(more="").replace("0.31 0.2", "5 0.2"), "walls on 0 of four sides (none)"),
    "no back wall": (shelf_text(more=""), "walls on 2 of four sides ('north', 'south')"),
    "no mouth": (shelf_text(more=BACK + FRONT), "walls on 4 of four sides"),
    "nothing on the board": (shelf_text(a=1.0), "none of the 1 free bodies stands"),
    "what lies": (shelf_text(geom='euler="90 0 0"'), "none of the 0 free bodies"),
    "an endless size": (shelf_text(more=BACK.replace("0.01 0.3 0.2", "0.01 0.3 inf")), "not finite"),
    "a size that is none": (shelf_text(geom='density="nan"'), ""),
    "an object in a wall": (shelf_text().replace('pos="0.1 0.1', 'pos="0.1 0.29'), "inside the north wall"),
    "gravity sideways": (shelf_text().replace("<worldbody>", '<option gravity="9 0 0"/><worldbody>'), "gravity"),
    "copies beyond measure": (
        shelf_text(more='<replicate count="9999"><replicate count="9999"><geom size="1"/></replicate></replicate>'),
        "copies",
    ),
    "nested beyond measure": (
        "<mujoco><worldbody>" + "<body>" * 5000 + "</body>" * 5000 + "</worldbody></mujoco>",
        "nest",
    ),
    "entities": ('<!DOCTYPE a [<!ENTITY b "c">]><mujoco model="&d;"/>', "not valid XML"),
    "a zero byte": ("<mujoco>\0</mujoco>", "not valid XML"),
}


@pytest.mark.parametrize("what", BAD)
def test_what_is_no_shelf_is_refused_in_one_line(
    imported: Import, what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    text, said = BAD[what]
    with pytest.raises(SceneError) as caught:
        imported(text)
    assert said in str(caught.value)
    assert str(caught.value).count("scene.xml: ") == 1
    assert "\n" not in str(caught.value)
    assert [each.name for each in tmp_path.iterdir()] == ["scene.xml"], "MuJoCo writes no log"
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("path", ["absent.xml", ".", "zero\0byte", "a" * 5000])
def test_what_cannot_be_read_is_refused(path: str) -> None:
    with pytest.raises(PhframeError) as caught:
        read_mjcf(path)
    assert "\n" not in str(caught.value)


@settings(max_examples=80, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    data=st.data(), wrong=st.sampled_from(["nan", "inf", "-1", "0", "1e300", "1e-300", "", "x", "1 2 3 4 5 6 7", "&"])
)
def test_whatever_is_wrong_in_a_file_it_is_imported_or_refused(
    imported: Import, data: st.DataObject, wrong: str
) -> None:
    text = FOREIGN.read_text()
    value = data.draw(st.sampled_from(list(re.finditer(r'(?<==")[^"]*', text))))
    start, end = data.draw(st.sampled_from([each.span() for each in re.finditer(r"\S+", value.group())]))
    place = value.start()
    try:
        back = imported(text[: place + start] + wrong + text[place + end :])
    except PhframeError as error:
        assert "\n" not in str(error)  # noqa: PT017 - either is right
    else:
        assert parse_scene(scene_to_yaml(back.scene)) == back.scene
