"""URDFs and descriptions of arms with anything in them: an arm, or one line; also from the engine that takes it."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from phframe.core import ArmError, PhframeError
from phframe.core.bounded_process import ProcessLimits
from phframe.registry import Kind, create
from phframe.urdf.convex_hull import read_hull
from phframe.urdf.reader import MOST_LINKS, read_robot
from phframe.urdf.trimesh_ import mesh_points
from tests.trials import many, tried

CORPUS = Path(__file__).parent / "corpus"
WRONG = [
    *("nan", "inf", "-1", "0", "1e300", "-1e300", "1e-300", "", "x", "1 2 3 4 5 6 7", "0 0 0", "&", "<b/>", "\u202e"),
    *(
        "box",
        "mesh",
        "prismatic",
        "fixed",
        "continuous",
        "floating",
        "world",
        "a" * 5000,
        "*a",
        "&a",
        "!!float 1",
        "[]",
    ),
]
"""What is put in the place of one word."""
WORDS = {"robot.urdf": r'(?<=")[^"<>=]+(?=")', "arm.yaml": r"[^\s,:\[\]{}]+"}
Made = Callable[[str, str], None]


@pytest.fixture
def made(tmp_path: Path) -> Made:
    """Makes an arm of the example's files, one of them changed, and asks it for all that it says of itself."""
    for library in ("pinocchio", "ompl", "toppra", "coal"):
        pytest.importorskip(library)
    from phframe.arms.articulated import EXAMPLE

    shutil.copytree(EXAMPLE.parent, tmp_path / "arm")

    def make(file: str, text: str) -> None:
        (tmp_path / "arm" / file).write_text(text, encoding="utf-8")
        try:
            arm = create(Kind.ARM, "articulated", {"description": str(tmp_path / "arm" / "arm.yaml")})
            assert len(arm.joints) == len(arm.home)
            assert arm.forward(arm.home).shape == (7,)
            assert arm.shape.outlines(arm.shape.max_opening)
            assert read_robot(arm.urdf()).name
        finally:
            shutil.copytree(EXAMPLE.parent, tmp_path / "arm", dirs_exist_ok=True)

    return make


@pytest.mark.slow
@pytest.mark.needs_baxter
@settings(max_examples=many(150), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data(), file=st.sampled_from(sorted(WORDS)), wrong=st.sampled_from(WRONG))
def test_whatever_is_wrong_in_a_file_there_is_an_arm_or_one_line(
    made: Made, data: st.DataObject, file: str, wrong: str
) -> None:
    from phframe.arms.articulated import EXAMPLE

    text = (EXAMPLE.parent / file).read_text()
    start, end = data.draw(st.sampled_from([each.span() for each in re.finditer(WORDS[file], text)]))
    tried(f"inputs: an arm's {file} with one word changed")
    try:
        made(file, text[:start] + wrong + text[end:])
    except PhframeError as error:
        assert "\n" not in str(error)  # noqa: PT017 - either is right


@pytest.mark.parametrize("path", sorted(CORPUS.glob("*.urdf")), ids=lambda path: path.stem)
def test_urdfs_that_went_wrong_once_are_one_line(path: Path) -> None:
    with pytest.raises(ArmError) as caught:
        read_robot(path.read_text())
    assert "\n" not in str(caught.value)


@pytest.mark.needs_baxter
@pytest.mark.parametrize("path", sorted(CORPUS.glob("*.yaml")), ids=lambda path: path.stem)
def test_descriptions_that_went_wrong_once_are_one_line(path: Path, made: Made) -> None:
    with pytest.raises(PhframeError) as caught:
        made("arm.yaml", path.read_text())
    assert "\n" not in str(caught.value)
    assert "line " in str(caught.value)


def _expanding(entities: int) -> str:
    """A billion laughs."""
    nested = "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10}">' for n in range(1, entities))
    return f'<!DOCTYPE robot [<!ENTITY e0 "laugh">{nested}]><robot name="&e{entities - 1};"/>'


@pytest.mark.parametrize(
    "text",
    [
        _expanding(12),
        "<a>" * 100_000,
        "<robot>" + "<a>" * 100_000 + "</a>" * 100_000 + "</robot>",
        f"<robot>{''.join(f'<link name=_{n}_/>'.replace('_', chr(34)) for n in range(MOST_LINKS + 1))}</robot>",
        "<robot/>",
        "\0",
        "",
    ],
    ids=["entities", "open", "deep", "many links", "nothing", "a zero byte", "empty"],
)
def test_a_urdf_beyond_measure_is_one_line(text: str) -> None:
    with pytest.raises(ArmError) as caught:
        read_robot(text)
    assert "\n" not in str(caught.value)


@pytest.mark.slow
@pytest.mark.needs_mujoco
@pytest.mark.needs_baxter
@pytest.mark.parametrize(
    ("old", "new"),
    [('mass value="', 'mass value="1e-300" was="'), ('iyz="', 'iyz="-1e10" was="'), ('iyy="', 'iyy="9" was="')],
)
def test_what_mujoco_does_not_take_of_an_arm_is_one_line(old: str, new: str, tmp_path: Path) -> None:
    pytest.importorskip("mujoco")
    for library in ("pinocchio", "ompl", "toppra", "coal"):
        pytest.importorskip(library)
    from phframe.arms.articulated import EXAMPLE
    from phframe.runtime.planning_world import PlanningWorld
    from phframe.runtime.scenes import find_scene
    from phframe.runtime.world import WorldSpec

    shutil.copytree(EXAMPLE.parent, tmp_path / "arm")
    urdf = tmp_path / "arm" / "robot.urdf"
    urdf.write_text(urdf.read_text().replace(old, new))
    options = {"description": str(tmp_path / "arm" / "arm.yaml")}
    with (
        pytest.raises(PhframeError, match="MuJoCo cannot load the URDF") as caught,
        PlanningWorld(WorldSpec(find_scene("vieira/simple-07"), "mujoco", "articulated", arm_options=options)) as world,
    ):
        world.physics.restore(world.scene.initial_state())
    assert "\n" not in str(caught.value)


@pytest.mark.slow
@pytest.mark.needs_meshes
def test_meshes_that_other_libraries_read_are_read_within_limits(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    for library in ("trimesh", "collada"):
        pytest.importorskip(library)
    with ZipFile(tmp_path / "bomb.zae", "w", ZIP_DEFLATED) as bomb:
        bomb.writestr("manifest.xml", "<dae_root>bomb.dae</dae_root>")
        with bomb.open("bomb.dae", "w", force_zip64=True) as stream:
            for _ in range(300):
                stream.write(b" " * 1_000_000)
    for name in ("bomb.zae", "text.dae", "empty.glb", "half.ply"):
        path = tmp_path / name
        if not path.exists():
            path.write_bytes(b"" if name == "empty.glb" else b"ply\nformat ascii 1.0\nelement vertex 99999999\n")
        with pytest.raises(ValueError, match="trimesh cannot read it") as caught:
            mesh_points(path.read_bytes(), path.suffix, ProcessLimits(200, 30.0))
        assert "\n" not in str(caught.value)
    assert capfd.readouterr() == ("", "")


def test_a_mesh_beyond_measure_is_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("phframe.urdf.convex_hull.MOST_POINTS", 100)
    monkeypatch.setattr("phframe.urdf.convex_hull.MOST_BYTES", 10_000)
    (tmp_path / "fine.obj").write_text("".join(f"v {n} {n * n % 7} {n * n * n % 11}\n" for n in range(200)))
    (tmp_path / "large.obj").write_text("#" * 20_000)
    for name, said in (("fine.obj", "200 points; at most 100"), ("large.obj", "larger than")):
        with pytest.raises(ArmError, match=said):
            read_hull(tmp_path / name, (1.0, 1.0, 1.0))
