from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from phframe.core import InputError, NotInstalledError
from phframe.recorders.view import open_viewer, require_viewer, web_viewer_command

elsewhere = pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="there is always a display")


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    path = tmp_path / "episode.rrd"
    path.touch()
    return path


def test_without_rerun_the_error_names_the_install_line(recording: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rerun", None)
    with pytest.raises(NotInstalledError, match=r"rerun-sdk, which is not installed.*phframe\[rerun\]"):
        open_viewer(recording)


@elsewhere
@pytest.mark.needs_rerun
def test_without_a_display_the_error_names_the_web_viewer(recording: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("rerun")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    with pytest.raises(InputError, match="no display") as caught:
        require_viewer(recording)
    assert web_viewer_command(recording) in str(caught.value)


def test_recording_that_does_not_exist(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no recording"):
        open_viewer(tmp_path / "none.rrd")


@elsewhere
@pytest.mark.needs_rerun
def test_viewer_is_a_process_of_its_own(recording: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("rerun")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setenv("DISPLAY", ":987654")  # there is none: the viewer starts, finds that out and ends
    viewer = open_viewer(recording)
    try:
        assert viewer.wait(timeout=20) != 0
    except subprocess.TimeoutExpired:
        viewer.kill()
        viewer.wait()
        raise
