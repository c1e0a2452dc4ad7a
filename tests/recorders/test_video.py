"""The video is what the states say: its length, its size, what is to be seen and that it moves."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import closing
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("av", reason="needs the extra 'video'")
pytest.importorskip("mujoco", reason="needs the extra 'video'")

import av
from PIL import Image

from phframe.core import BasePose, Condition, InputError, LinkMesh, State, Step
from phframe.recorders import opengl, palette
from phframe.recorders.arm_bodies import bodies_of
from phframe.recorders.coloring import object_color
from phframe.recorders.film import FORMATS, Film, VideoFormat
from phframe.recorders.frames import Frames
from phframe.recorders.offscreen import Offscreen, Picture
from phframe.recorders.stage import Stage, camera
from phframe.recorders.video_ import STILL, VideoRecorder
from tests.recorders.synthetic_episode import SCENE, SPEC, Recorded, hand_made, mounted

pytestmark = pytest.mark.needs_video

MP4, SECONDS = FORMATS[".mp4"], 0.3
Moments = list[tuple[float, State]]


@pytest.fixture(scope="module")
def made() -> Recorded:
    return hand_made()


def shortened(made: Recorded, number: int = 0) -> tuple[Step, Moments]:
    """A step of the episode ten times as quick."""
    step, frames = made.episode.steps[number], made.frames[number]
    moments = [(SECONDS * i / 10, frames[i * (len(frames) - 1) // 9][1]) for i in range(10)]
    return replace(step, motion=replace(step.motion, duration=SECONDS)), moments


def pictures(path: Path) -> list[Picture]:
    with av.open(str(path)) as container:
        return [frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]


def seen(picture: Picture, color: palette.Color) -> int:
    """How many pixels have nearly the hue of a colour, and are no greyer."""
    wanted, pixels = np.array(color[:3]) / max(color[:3]), picture.astype(np.float64)
    bright = pixels.max(axis=2)
    near = np.abs(pixels / np.maximum(bright, 1.0)[..., None] - wanted).max(axis=2) < 0.15
    return int((near & (bright > 60.0)).sum())


@pytest.fixture(scope="module")
def filmed(made: Recorded, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("video")
    recorder = VideoRecorder(folder / "short.mp4")
    recorder.begin(SCENE, SPEC, made.arm)
    recorder.planned(made.episode.plans[0])
    step, moments = shortened(made)
    recorder.stepped(step, moments)
    recorder.finished(made.episode)
    assert not recorder.path.exists(), "it appears when it is whole"
    recorder.close()
    recorder.close()
    assert list(folder.iterdir()) == [recorder.path]
    return recorder.path


def test_a_video_is_as_long_as_what_happened(filmed: Path) -> None:
    with av.open(str(filmed)) as container:
        stream = container.streams.video[0]
        assert (stream.width, stream.height, stream.average_rate) == (MP4.width, MP4.height, MP4.rate)
        times = [frame.time for frame in container.decode(video=0)]
    assert len(times) == 1 + int((SECONDS + STILL) * MP4.rate + 1e-9)
    np.testing.assert_allclose(np.diff(times), 1.0 / MP4.rate, atol=1e-6)


def test_the_target_is_to_be_seen_and_what_belongs_together_has_its_colour(filmed: Path) -> None:
    first, *_, last = pictures(filmed)
    during = pictures(filmed)[3]
    for picture in (first, during, last):
        assert picture.mean() > 40.0
        assert seen(picture, palette.TARGET) > 300
    assert seen(during, palette.component_color(0)) > 3 * seen(first, palette.component_color(0)) + 300
    assert seen(last, palette.TOPPLED) > 300 > seen(during, palette.TOPPLED), "object_3 has toppled at the end"


def test_pictures_change_while_something_moves_and_only_then(filmed: Path) -> None:
    shown = [picture.astype(np.int16) for picture in pictures(filmed)]
    moving = int(SECONDS * MP4.rate)
    differences = [np.abs(b - a).max(axis=2) > 60 for a, b in pairwise(shown)]
    assert max(int(d.sum()) for d in differences[1 : moving - 1]) > 200
    still = [int(d[60:].sum()) for d in differences[-10:]]  # below the caption, which counts the seconds
    assert max(still) == 0


def test_a_small_moving_picture_is_quicker_than_the_world(made: Recorded, tmp_path: Path) -> None:
    recorder, kind = VideoRecorder(tmp_path / "small.WEBP"), FORMATS[".webp"]
    recorder.begin(SCENE, SPEC, made.arm)
    recorder.stepped(made.episode.steps[0], made.frames[0])
    recorder.finished(made.episode)
    recorder.close()
    with Image.open(recorder.path) as image:
        duration = made.episode.steps[0].motion.duration + STILL * kind.speed
        assert image.n_frames == 1 + int(duration / kind.speed * kind.rate)  # type: ignore[attr-defined]
        assert image.size == (kind.width, kind.height)
        assert image.info["loop"] == 0
    assert recorder.path.stat().st_size < 500_000


def test_the_robot_moves_by_its_joints_where_the_states_have_them(made: Recorded) -> None:
    arm = mounted(by_joints=True)
    stage = staged(arm_by_joints=True)
    gripper = np.array([0.3, 0.35, 0.2])
    joints = gripper - [arm.base_pose.x, arm.base_pose.y, 0.0]
    before = made.episode.steps[1].before
    assert before.arm is not None
    show(stage, replace(before, arm=replace(before.arm, gripper=np.zeros(3), joints=joints)), by_joints=True)
    np.testing.assert_allclose(stage.data.body("arm/fingertip").xpos, [0.3, 0.35, 0.06], atol=1e-9)
    show(stage, SCENE.initial_state(), by_joints=True)
    np.testing.assert_allclose(stage.data.body("arm/fingertip").xpos, arm.base_pose.pose[:3], atol=1e-9)


def test_what_lies_is_drawn_toppled() -> None:
    initial, tilted = SCENE.initial_state(), SCENE.initial_state().poses.copy()
    tilted[2] = [0.3, 0.2, 0.03, np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0]
    stage = staged()
    show(stage, State(tilted, initial.conditions))
    np.testing.assert_allclose(stage.data.body("object/2").xmat.reshape(3, 3)[:, 2], [0.0, -1.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(stage.data.body("object/2").xpos, [0.3, 0.2, 0.03])


def test_all_of_the_shelf_and_of_the_gripper_is_in_the_picture() -> None:
    stage = staged()
    show(stage, SCENE.initial_state())
    stage.model.geom_rgba[:] = [0.0, 1.0, 0.0, 1.0]
    screen = Offscreen(stage.model, 320, 180)
    picture = screen.draw(stage.data, camera(SCENE.shelf, mounted().base_pose))
    screen.close()
    green = (picture[..., 1] > 100) & (picture[..., 0] < 60)
    assert 0.1 < green.mean() < 0.7
    assert not green[0].any(), "nothing is cut off above"
    assert not green[:, 0].any(), "nor to the left"


@pytest.mark.parametrize("y", [-0.1, 0.7])
def test_the_camera_is_on_the_side_on_which_the_arm_does_not_stand(y: float) -> None:
    view = camera(SCENE.shelf, BasePose(-0.7, y, 0.0, 0.0))
    sideways = view.lookat[1] - view.distance * np.cos(np.radians(view.elevation)) * np.sin(np.radians(view.azimuth))
    middle = 0.5 * SCENE.shelf.width
    assert (sideways - middle) * (y - middle) < 0.0


def test_meshes_of_any_kind_can_be_drawn() -> None:
    """A surface that is not closed, and a flat one."""
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0.5, 0.5, 1.0]])
    open_, flat = np.array([[0, 1, 4], [1, 2, 4]]), np.array([[0, 1, 2], [0, 2, 3]])
    arm = mounted(by_joints=True)
    model = arm.model

    class Dressed(type(model)):  # type: ignore[misc]
        def meshes(self) -> tuple[LinkMesh, ...]:
            return tuple(LinkMesh("fingertip", 0.1 * corners, rows, (0.0, 0.0, 1.0)) for rows in (open_, flat))

    dressed = replace(arm, model=Dressed(model.options))
    stage = Stage(SCENE, bodies_of(dressed, SCENE), 64, 48)
    assert stage.model.nmesh == 2


def staged(*, arm_by_joints: bool = False) -> Stage:
    return Stage(SCENE, bodies_of(mounted(by_joints=arm_by_joints), SCENE), 320, 180)


def show(stage: Stage, state: State, *, by_joints: bool = False) -> None:
    bodies = bodies_of(mounted(by_joints=by_joints), SCENE)
    frames = Frames.gather(np.zeros(1), [state], bodies.parked)
    stage.show(state, {name: poses[0] for name, poses in bodies.poses(frames).items()}, {})


def test_an_interrupted_video_leaves_nothing_and_what_was_there_stays(made: Recorded, tmp_path: Path) -> None:
    def interrupted(moments: Moments) -> Iterator[tuple[float, State]]:
        yield from moments[:3]
        raise KeyboardInterrupt

    path = tmp_path / "old.mp4"
    path.write_text("what was there")
    recorder = VideoRecorder(path)
    recorder.begin(SCENE, SPEC, made.arm)
    step, moments = shortened(made)
    with pytest.raises(KeyboardInterrupt):
        recorder.stepped(step, interrupted(moments))
    recorder.close()
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_text() == "what was there"


def test_close_before_the_beginning_leaves_nothing(made: Recorded, tmp_path: Path) -> None:
    recorder = VideoRecorder(tmp_path / "never.mp4")
    recorder.stepped(*shortened(made))
    recorder.finished(made.episode)
    recorder.close()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("video.avi", r"give a file that ends in \.mp4 or \.webp"),
        ("video", r"give a file that ends in"),
        ("folder.mp4", "it is a directory"),
        ("file/video.mp4", "not a directory"),
    ],
)
def test_a_file_that_cannot_be_is_refused_at_once(name: str, why: str, tmp_path: Path) -> None:
    (tmp_path / "folder.mp4").mkdir()
    (tmp_path / "file").touch()
    before = set(tmp_path.iterdir())
    with pytest.raises(InputError, match=rf"^cannot write .*{why}") as caught:
        VideoRecorder(tmp_path / name)
    assert "\n" not in str(caught.value)
    assert set(tmp_path.iterdir()) == before


@pytest.mark.parametrize("codec", ["no-such-codec", "gif"])
def test_a_codec_that_is_not_there_or_refuses_is_one_line(codec: str, tmp_path: Path) -> None:
    def write() -> None:
        with closing(Film(tmp_path / "x.mp4", VideoFormat("mp4", codec, 64, 48, 10))) as film:
            film.add(np.zeros((48, 64, 3), dtype=np.uint8))

    with pytest.raises(InputError, match="cannot write the video"):
        write()
    assert list(tmp_path.iterdir()) == []


linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="elsewhere the system itself has OpenGL")


@linux
@pytest.mark.parametrize(
    ("setting", "why"),
    [
        ("", "NoEGL nor NoOSMesa is not installed. Install libegl1 or libosmesa6"),
        ("egl", "NoEGL is not installed. .* MUJOCO_GL=osmesa"),
        ("OSMesa", "NoOSMesa is not installed. .* MUJOCO_GL=egl"),
        ("nonsense", "MUJOCO_GL is 'nonsense'. Set it to egl or osmesa"),
        ("off", "MUJOCO_GL is 'off'"),
    ],
)
def test_where_nothing_draws_is_said_what_to_install_or_set(
    setting: str, why: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("MUJOCO_GL", setting)
    libraries = {name: (f"No{library}", package) for name, (library, package) in opengl.LIBRARIES.items()}
    monkeypatch.setattr(opengl, "LIBRARIES", libraries)
    with pytest.raises(InputError, match=why):
        VideoRecorder(tmp_path / "x.mp4")


@linux
def test_a_screen_that_is_not_there_is_one_line(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("MUJOCO_GL", "glfw")
    with pytest.raises(InputError, match=r"^cannot draw pictures with glfw: .* MUJOCO_GL=egl\.$"):
        VideoRecorder(tmp_path / "x.mp4")


def test_what_toppled_is_red_and_what_is_held_is_not() -> None:
    state = hand_made().episode.final_state
    assert state.held == SCENE.target
    assert object_color(SCENE, SCENE.target, state, {}) == palette.TARGET
    assert state.conditions[SCENE.index("object_3")] is Condition.TOPPLED
    assert object_color(SCENE, "object_3", state, {"object_3": 1}) == palette.TOPPLED
    assert object_color(SCENE, "object_1", state, {"object_1": 1}) == palette.component_color(1)
    assert object_color(SCENE, "object_1", state, {}) == palette.OBJECT
