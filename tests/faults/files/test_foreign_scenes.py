"""A few lines of MuJoCo XML that ask for all memory, for ever, or for the end of the process: one line each."""

from __future__ import annotations

import os
import re
import signal
import sys
from pathlib import Path

import pytest

pytest.importorskip("mujoco")

from phframe.core import SceneError
from phframe.core.bounded_process import ProcessLimits
from phframe.scenes.foreign_file import read_foreign
from phframe.scenes.mujoco_ import read_mjcf
from tests.cli.conftest import Spawn, spawn, until

pytestmark = [pytest.mark.slow, pytest.mark.needs_mujoco]
__all__ = ["spawn"]  # a fixture
posix = pytest.mark.skipif(sys.platform == "win32", reason="pipes and limits of POSIX")

LIMITS = ProcessLimits(memory=400, seconds=20.0)
FREE = '<worldbody><body name="cup"><freejoint/><geom type="cylinder" size="0.03 0.06"/></body></worldbody>'
GREEDY = {
    "a height field": '<asset><hfield name="h" nrow="60000" ncol="60000" size="1 1 1 1"/></asset>',
    "a texture": '<asset><texture name="t" type="2d" builtin="flat" width="60000" height="60000"/></asset>',
    "figures of users": '<size nuser_geom="2000000000"/>',
    "a sensor": '<sensor><user name="u" dim="2000000000" objtype="body" objname="cup"/></sensor>',
    "an arena": '<size memory="400G"/>',
    "copies in copies": (
        '<worldbody><replicate count="100"><replicate count="99">'
        + '<body><freejoint/><geom type="box" size="1 1 1"/></body>' * 30
        + "</replicate></replicate></worldbody>"
    ),
}


def _written(folder: Path, more: str) -> Path:
    path = folder / "scene.xml"
    path.write_text(f"<mujoco>{more}{FREE}</mujoco>")
    return path


def _refused(path: Path, limits: ProcessLimits = LIMITS) -> str:
    with pytest.raises(SceneError) as caught:
        read_foreign(path, limits)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 600
    return str(caught.value)


@pytest.mark.skipif(sys.platform != "linux", reason="where memory is limited")
@pytest.mark.parametrize("what", GREEDY)
def test_what_asks_for_much_memory_is_refused(
    what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    try:
        told = str(read_foreign(_written(tmp_path, GREEDY[what]), LIMITS).ignored)
    except SceneError as error:
        told = str(error)
    assert re.search("memory|as it wants|more than|exception", told)
    assert "\n" not in told
    assert len(told) < 600
    assert [each.name for each in tmp_path.iterdir()] == ["scene.xml"], "no log and no core is left"
    assert capfd.readouterr() == ("", "")


@posix
def test_what_waits_for_a_pipe_is_ended(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    assert "more than 2 s" in _refused(_written(tmp_path, '<include file="pipe"/>'), ProcessLimits(400, 2.0))


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="what has no end")
def test_what_has_no_end_is_refused(tmp_path: Path) -> None:
    _refused(_written(tmp_path, '<include file="/dev/zero"/>'))


def test_what_ends_the_process_that_reads_it_is_refused(tmp_path: Path) -> None:
    itself = '<asset><model name="s" file="scene.xml"/></asset><worldbody><attach model="s" prefix="a"/></worldbody>'
    assert "SIGSEGV" in _refused(_written(tmp_path, itself))  # a stack has an end


HALF_BUILT = {
    "a plugin that is not there": '<extension><plugin plugin="x.y"/></extension>',
    "a joint to nothing": '<equality><joint joint1="j"/></equality>',
    "a tendon to nothing": '<tendon><fixed name="t"><joint joint="j" coef="1"/></fixed></tendon>',
    "a default twice": '<default class="a"><default class="a"/></default>',
    "a negative size": '<size nuser_geom="-7"/>',
    "no number": '<size nuser_geom="many"/>',
    "a strange unit": '<compiler angle="gon"/>',
    "a name of a million letters": f'<custom><text name="{"a" * 1_000_000}" data=""/></custom>',
}


@pytest.mark.parametrize("what", HALF_BUILT)
def test_what_mujoco_cannot_make_a_model_of_is_one_line(what: str, tmp_path: Path) -> None:
    with pytest.raises(SceneError) as caught:
        read_mjcf(_written(tmp_path, HALF_BUILT[what]))
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 600


@posix
@pytest.mark.parametrize("often", [1, 5])
def test_an_interruption_ends_the_reading(often: int, tmp_path: Path, spawn: Spawn) -> None:
    os.mkfifo(tmp_path / "pipe")
    process = spawn("scene", "import", _written(tmp_path, '<include file="pipe"/>'))
    until(lambda: _is_read(tmp_path / "pipe"), process)
    for _ in range(often):
        process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (130, "")
    assert re.fullmatch("(interrupted\n)?", err)
    until(lambda: not _is_read(tmp_path / "pipe"))


def _is_read(pipe: Path) -> bool:
    """Whether a process waits for what comes out of a pipe."""
    try:
        os.close(os.open(pipe, os.O_WRONLY | os.O_NONBLOCK))
    except OSError:
        return False
    return True
