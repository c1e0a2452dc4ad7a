"""``phframe solve --video``: the file is there when it is whole, or else there is a line that says why."""

from __future__ import annotations

import io
import json
import signal
import sys
from contextlib import closing
from pathlib import Path

import pytest

from phframe.cli.progress import Progress
from phframe.core import State
from phframe.runtime.scenes import find_scene
from tests.cli.conftest import Install, Invoke, Run, Spawn, until

needs_video = pytest.mark.needs_video


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@needs_video
@pytest.mark.needs_mujoco
@pytest.mark.slow
@pytest.mark.parametrize("backend", ["mujoco", "pymunk"])
def test_an_episode_is_filmed_whatever_backend_it_runs_in(backend: str, invoke: Invoke) -> None:
    for library in ("av", "mujoco"):
        pytest.importorskip(library)
    from PIL import Image

    arguments = ("--backend", backend, "--no-rerun", "--out", "here", "--json")
    result = invoke("solve", "vieira/simple-01", "--video", "film.webp", *arguments)
    assert result.exit_code == 0, result.output
    assert sorted(path.name for path in Path().iterdir()) == ["film.webp", "here"]
    seconds = json.loads(result.stdout)["execution_time"]
    with Image.open("film.webp") as image:
        assert image.n_frames == pytest.approx(1 + 12 * (seconds / 3.0 + 1.0), abs=1)  # type: ignore[attr-defined]


@needs_video
@pytest.mark.parametrize("name", ["film.avi", "file/film.mp4", "folder.mp4"])
def test_a_file_that_cannot_be_written_is_refused_before_anything_runs(name: str, run: Run) -> None:
    for library in ("av", "mujoco"):
        pytest.importorskip(library)
    Path("folder.mp4").mkdir()
    Path("file").touch()
    result = run("solve", "vieira/simple-01", "--video", name)
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr.startswith("error: cannot write ")
    assert name in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert sorted(path.name for path in Path().iterdir()) == ["file", "folder.mp4"]


def test_without_the_libraries_the_install_line_is_said(run: Run, install: Install, tmp_path: Path) -> None:
    install("phframe", version="0.0", requires=("no-such-codec; extra == 'video'",))
    (tmp_path / "site" / "av").mkdir()
    absent = "raise ModuleNotFoundError(\"No module named 'av'\", name='av')"
    (tmp_path / "site" / "av" / "__init__.py").write_text(absent)
    result = run("solve", "vieira/simple-01", "--video", "film.mp4")
    assert result.returncode == 3
    assert "recorder 'video' needs no-such-codec" in result.stderr
    assert 'pip install "phframe[video]"' in result.stderr
    assert list(Path().iterdir()) == []


@needs_video
@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGINT to send to one process")
def test_ctrl_c_while_filming_leaves_no_half_video(spawn: Spawn) -> None:
    for library in ("av", "mujoco"):
        pytest.importorskip(library)
    process = spawn("solve", "vieira/basic", "--no-rerun", "--video", "film.mp4")
    until(lambda: list(Path().glob(".film.mp4.*.part")), process)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=120)
    assert process.returncode == 130
    assert [path.name for path in Path().iterdir()] == ["runs"]


def test_the_line_says_how_much_is_filmed_and_hands_every_frame_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", screen := Terminal())
    monkeypatch.setenv("TERM", "xterm")
    state = find_scene("vieira/basic").initial_state()
    frames: list[tuple[float, State]] = [(0.1 * i, state) for i in range(4)]
    with closing(Progress(after=0.0)) as progress:
        progress.start()
        handed_on = []
        for frame in progress.through(frames):
            handed_on.append(frame)
            until(lambda: f"Filming action 1: {25 * len(handed_on) - 25} %" in screen.getvalue())
    assert handed_on == frames
