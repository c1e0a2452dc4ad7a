"""Pictures of scenes from the top, and what they and the tables say of a corridor."""

from __future__ import annotations

from dataclasses import replace
from io import BytesIO
from typing import Any

import numpy as np
import pytest

from phframe.core import Cylinder, Infeasible, Scene, SceneObject, Shelf
from phframe.pushing import Corridor
from phframe.recorders.scene_overview import scene_overview
from phframe.recorders.scene_plot import MEMBER, OBSTACLE, STRIP, TARGET, draw_scene, scene_picture
from phframe.runtime.scenes import find_scene
from tests.prism import PRISM

BASIC = find_scene("vieira/basic")
NARROW = Scene("narrow", Shelf(0.5, 0.2), (SceneObject("a$b", Cylinder(0.03), (0.3, 0.1)),), "a$b")
plotted = pytest.importorskip("matplotlib.figure", reason="needs the extra 'plots'")


def drawn(scene: Scene, **options: Any) -> Any:
    """The axes with a scene on them."""
    axes = plotted.Figure().add_subplot()
    draw_scene(scene, axes, **options)
    return axes


def colours(axes: Any) -> list[str]:
    """Of all that is filled, in the order of drawing."""
    from matplotlib.colors import to_hex

    return [to_hex(patch.get_facecolor()) for patch in axes.patches]


def test_the_overview_names_the_obstacles_in_the_corridor() -> None:
    overview = scene_overview(BASIC)
    assert isinstance(overview.corridor, Corridor)
    assert overview.half_width == 0.12
    assert len(overview.members) == 7  # as in the paper's figure
    assert BASIC.target not in overview.members
    assert isinstance(scene_overview(NARROW).corridor, Infeasible)
    assert scene_overview(NARROW).members == ()


def test_every_object_is_drawn_where_it_stands_with_its_id() -> None:
    axes = drawn(BASIC)
    assert {text.get_text(): text.get_position() for text in axes.texts if text.get_text()} == {
        item.id: item.position for item in BASIC.objects
    }
    centres = [patch.get_xy()[:-1].mean(axis=0) for patch in axes.patches[-len(BASIC.objects) :]]
    assert np.allclose(centres, [item.position for item in BASIC.objects], atol=1e-9)


def test_colours_tell_target_members_and_others_apart() -> None:
    found = colours(drawn(BASIC))
    assert [found.count(each) for each in (STRIP, TARGET, MEMBER, OBSTACLE)] == [1, 1, 7, 3]
    assert [colours(drawn(NARROW)).count(each) for each in (STRIP, TARGET, MEMBER, OBSTACLE)] == [0, 1, 0, 0]


@pytest.mark.parametrize("name", ["vieira/basic", "near/0", "near/2"])
def test_the_strip_is_the_corridor_and_all_of_it_is_seen(name: str) -> None:
    scene = find_scene(name)
    corridor, axes = scene_overview(scene).corridor, drawn(scene)
    assert isinstance(corridor, Corridor)
    (strip,) = [patch for patch, colour in zip(axes.patches, colours(axes), strict=True) if colour == STRIP]
    local = corridor.to_local(strip.get_xy())
    assert np.allclose(local.min(axis=0), [corridor.start, corridor.axis - 0.12])
    assert np.allclose(local.max(axis=0), [corridor.end, corridor.axis + 0.12])
    assert axes.get_xlim()[0] < min(strip.get_xy()[:, 0].min(), -0.05)
    assert axes.get_ylim()[0] < 0.0 < scene.shelf.width < axes.get_ylim()[1]


def test_ids_fit_on_their_objects_and_can_be_left_out() -> None:
    scene = find_scene("dense/9")
    axes = drawn(scene)
    axes.figure.draw_without_rendering()
    (left, _), (right, _) = axes.transData.transform([(0.0, 0.0), (0.06, 0.0)])
    labels = [text for text in axes.texts if text.get_text()]
    assert len(labels) == len(scene.objects)
    assert all(label.get_window_extent().width <= 1.1 * (right - left) for label in labels)
    assert not any(text.get_text() for text in drawn(scene, ids=False).texts)


@pytest.mark.parametrize(
    "scene",
    [BASIC, NARROW, replace(NARROW, name="\u68da $x$"), replace(BASIC, shelf=Shelf(10.0, 0.61))],
    ids=["basic", "narrow", "letters without glyphs", "long"],
)
def test_the_picture_is_a_png_with_something_on_it_whatever_the_scene(scene: Scene) -> None:
    from matplotlib.image import imread

    picture = imread(BytesIO(scene_picture(scene)))
    assert picture.shape[0] > 400
    assert float(picture[..., :3].std()) > 0.01
    assert scene_picture(scene) == scene_picture(scene)


def test_objects_are_drawn_by_their_outlines_turned_as_they_are() -> None:
    prism = replace(BASIC.objects[0], shape=PRISM)
    scenes = [replace(BASIC, objects=(item, *BASIC.objects[1:])) for item in (prism, replace(prism, yaw=0.5))]
    outlines = [drawn(scene).patches[-len(BASIC.objects)].get_xy() - prism.position for scene in scenes]
    assert outlines[0].shape == (len(PRISM.outline) + 1, 2)
    turned = np.array([[np.cos(0.5), -np.sin(0.5)], [np.sin(0.5), np.cos(0.5)]])
    assert np.allclose(outlines[0] @ turned.T, outlines[1])
