"""An arm whose collision geometry is meshes: convex hulls in outlines, motion planning and engines, as with its boxes."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pinocchio", reason="needs the extra 'baxter'")

import phframe
from phframe.arms.articulated import EXAMPLE, DescribedArm, DescribedArmOptions
from phframe.core import ArmError
from phframe.recorders.bodies import Surface
from phframe.recorders.robot import drawn_robot
from phframe.runtime.scenes import find_scene
from phframe.testing import check_arm
from tests.urdf.meshes import meshed

pytestmark = pytest.mark.needs_baxter

BOXES = DescribedArm(DescribedArmOptions())
SCENE = find_scene("vieira/simple-07")


@pytest.fixture(scope="module")
def description(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example, its boxes in mesh files of a package."""
    package = tmp_path_factory.mktemp("ws") / "meshed_robot"
    (package / "urdf").mkdir(parents=True)
    shutil.copy(EXAMPLE, package / "urdf")
    text = EXAMPLE.with_name("robot.urdf").read_text("utf-8")
    (package / "urdf" / "robot.urdf").write_text(meshed(text, package, "package://meshed_robot/"), "utf-8")
    return package / "urdf" / EXAMPLE.name


@pytest.fixture
def arm(description: Path) -> DescribedArm:
    return DescribedArm(DescribedArmOptions(description=description))


def test_its_outlines_are_those_of_the_boxes(arm: DescribedArm) -> None:
    assert len(arm.robot.hulls) == 10
    for meshes, boxes in zip(arm.shape.closed, BOXES.shape.closed, strict=True):
        np.testing.assert_allclose(sorted(meshes.vertices.tolist()), sorted(boxes.vertices.tolist()), atol=1e-6)
        assert (meshes.bottom, meshes.top) == pytest.approx((boxes.bottom, boxes.top), abs=1e-6)


def test_it_passes_the_conformance_checks_and_is_drawn(arm: DescribedArm) -> None:
    assert check_arm(arm).passed
    text = arm.urdf()
    drawn = drawn_robot(text[: text.index("<visual")] + text[text.index("<collision") :])
    base = next(body for body in drawn.bodies if body.name == "base")
    surface = base.pieces[0].shape
    assert isinstance(surface, Surface)
    assert np.ptp(surface.vertices, axis=0) == pytest.approx([0.12, 1.3, 0.12], abs=1e-6)


@pytest.mark.needs_mujoco
def test_mujoco_has_its_hulls_where_the_boxes_are_and_needs_no_files(arm: DescribedArm) -> None:
    mujoco = pytest.importorskip("mujoco")
    from phframe.backends.mujoco_.arm import arm_spec
    from phframe.backends.mujoco_.options import MujocoOptions

    models = [arm_spec(each, MujocoOptions()).compile() for each in (arm, BOXES)]
    for meshes, boxes in zip(*(_seen(mujoco, model) for model in models), strict=True):
        assert meshes == pytest.approx(boxes, abs=1e-5)
    spec = arm_spec(arm, MujocoOptions())
    spec.compile()
    assert mujoco.MjSpec.from_string(spec.to_xml()).compile().nmesh == 10


def _seen(mujoco: object, model: object) -> list[tuple[float, ...]]:
    """Bounding boxes of all that collides, in the world, by link."""
    data = mujoco.MjData(model)  # type: ignore[attr-defined]
    mujoco.mj_kinematics(model, data)  # type: ignore[attr-defined]
    found = []
    for geom in range(model.ngeom):  # type: ignore[attr-defined]
        center, half = model.geom_aabb[geom].reshape(2, 3)  # type: ignore[attr-defined]
        axes = data.geom_xmat[geom].reshape(3, 3)
        at = data.geom_xpos[geom] + axes @ center
        found.append((float(model.geom_bodyid[geom]), *at, *np.abs(axes @ half)))  # type: ignore[attr-defined]
    return sorted(found)


@pytest.mark.slow
@pytest.mark.needs_ompl
@pytest.mark.parametrize(
    "backend",
    [
        pytest.param("mujoco", marks=pytest.mark.needs_mujoco),
        pytest.param("pybullet", marks=pytest.mark.needs_pybullet),
    ],
)
def test_it_retrieves_by_its_joints(description: Path, backend: str) -> None:
    for library in (backend, "ompl", "toppra"):
        pytest.importorskip(library)
    episode = phframe.solve(
        SCENE, backend=backend, arm="articulated", options={"arm": {"description": str(description)}}
    )
    assert (episode.status, episode.clean) == ("retrieved", True)


def test_a_mesh_that_is_not_there_is_told(tmp_path: Path) -> None:
    text = EXAMPLE.with_name("robot.urdf").read_text("utf-8")
    shutil.copy(EXAMPLE, tmp_path)
    (tmp_path / "robot.urdf").write_text(
        text.replace('<box size="0.5 0.08 0.08" />', '<mesh filename="up.stl"/>'), "utf-8"
    )
    with pytest.raises(ArmError, match=r"the mesh 'up\.stl' of the URDF is not there; looked in"):
        DescribedArm(DescribedArmOptions(description=tmp_path / "arm.yaml")).urdf()
