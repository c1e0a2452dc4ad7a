"""MuJoCo XML in which anything is wrong: a scene, or one line; nothing is printed, nothing is left."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("mujoco")

from hypothesis import HealthCheck, given, settings

from phframe.core import SceneError
from phframe.core.bounded_process import ProcessLimits
from phframe.runtime.scenes import find_scene
from phframe.scenes import parse_scene, scene_to_yaml
from phframe.scenes.foreign_file import read_foreign
from phframe.scenes.mjcf import scene_to_mjcf
from tests.faults.files.mjcf_reader import ENDED, MjcfReader
from tests.faults.files.spoiling import TEXTS, a_line, spoilt_text
from tests.faults.files.spoiling_xml import VALUES, spoilt_xml
from tests.trials import many, tried

pytestmark = [pytest.mark.slow, pytest.mark.needs_mujoco]
FOREIGN = (Path(__file__).parents[2] / "scenes" / "foreign.xml").read_text(encoding="utf-8")
OURS = scene_to_mjcf(find_scene("vieira/simple-10"))
PIECES = (
    *TEXTS,
    *VALUES,
    "<",
    ">",
    "/>",
    "</body>",
    "<!--",
    "&x;",
    "<freejoint/>",
    "<geom/>",
    '<geom type="plane" size="1 1 1"/>',
)
LIMITS = ProcessLimits(memory=1000, seconds=30.0)


@pytest.fixture(scope="module")
def reader(tmp_path_factory: pytest.TempPathFactory) -> Iterator[MjcfReader]:
    folder = tmp_path_factory.mktemp("mjcf") / "work"
    folder.mkdir()
    made = MjcfReader(folder)
    yield made
    made.close()


def judged(text: str, reader: MjcfReader) -> str:
    """What a text is: a scene, or what is wrong with it, after a ``!``."""
    path = reader.folder / "scene.xml"
    path.write_text(text, encoding="utf-8", errors="surrogatepass")
    told = reader.read(path)
    if told == ENDED:  # what ends that process is told of by the one that is made for such files
        with pytest.raises(SceneError) as caught:
            read_foreign(path, LIMITS)
        told = f"!{caught.value}"
    assert reader.chatter == ""
    assert [each.name for each in reader.folder.iterdir()] == ["scene.xml"]
    if told.startswith("!"):
        a_line(ValueError(told))
    else:
        assert scene_to_yaml(parse_scene(told)) == told
    return told


@settings(max_examples=many(40), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=spoilt_xml(FOREIGN) | spoilt_xml(OURS))
def test_whatever_an_mjcf_is_made_of_it_is_a_scene_or_one_line(reader: MjcfReader, text: str) -> None:
    tried("inputs: MJCF with elements changed")
    judged(text, reader)


@settings(max_examples=many(20), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(text=spoilt_text(FOREIGN, PIECES))
def test_whatever_is_written_in_an_mjcf_it_is_a_scene_or_one_line(reader: MjcfReader, text: str) -> None:
    tried("inputs: MJCF with a word or line changed")
    judged(text, reader)
