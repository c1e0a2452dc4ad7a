"""The watchdog alone: children that report, overrun, close their pipe or die."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from phframe.cli import watchdog
from phframe.cli.processes import descendants, memory_of
from phframe.cli.watchdog import Watchdog
from tests.cli.conftest import until

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="the watchdog needs fork, and what is tested of it /proc"),
]
Child = Callable[[Callable[..., object]], None]


@pytest.fixture(autouse=True)
def _impatient(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    ours = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGCHLD)
    before = {number: signal.getsignal(number) for number in ours}
    for name in ("GRACE", "LAST_GRACE", "TO_SAVE_AT_ONCE", "TO_EXIT"):
        monkeypatch.setattr(watchdog, name, 0.05)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


def watched(child: Child, memory: int | None = None) -> int:
    """What the watchdog makes of a child."""
    reader, writer = os.pipe()
    process = os.fork()
    if not process:
        signal.alarm(60)  # whatever the test does
        signal.signal(signal.SIGALRM, signal.SIG_IGN)
        child(lambda **what: os.write(writer, json.dumps(what).encode() + b"\n"))
        os._exit(7)
    os.close(writer)
    os.set_blocking(reader, False)
    try:
        return Watchdog(process, reader, memory).wait()
    finally:
        os.close(reader)


def forever() -> None:
    while True:
        signal.pause()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Of a run under way."""
    unfinished = {"phframe": 2, "kind": "episode", "episode": {"status": "failed", "reason": "unfinished"}}
    run = tmp_path / "run"
    run.mkdir()
    (run / "episode.json").write_text(json.dumps(unfinished))
    for name in (".recording.0a.part", ".episode.json.0b.part"):
        (run / name).touch()
    return run


def found(folder: Path) -> tuple[str, str]:
    episode = json.loads((folder / "episode.json").read_text())["episode"]
    assert [path.name for path in folder.iterdir()] == ["episode.json"]
    return episode["status"], episode["reason"]


def test_who_says_that_all_is_done_is_believed_however_the_process_ends(folder: Path) -> None:
    def ends(tell: Callable[..., object]) -> None:
        tell(folder=str(folder))
        tell(ended=1)

    def hangs_after(tell: Callable[..., object]) -> None:
        tell(ended=0)
        forever()

    assert (watched(ends), watched(hangs_after)) == (1, 0)


@pytest.mark.parametrize(("code", "said"), [(0, "ended with exit code 0"), (9, "ended with exit code 9")])
def test_who_dies_before_has_failed(code: int, said: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    def dies(tell: Callable[..., object]) -> None:
        tell(folder=str(folder))
        os._exit(code)

    assert watched(dies) == 1
    assert found(folder) == ("failed", f"its process {said} before there was a result")
    assert (
        capsys.readouterr().err
        == f"error: its process {said} before there was a result; what was recorded is in {folder}\n"
    )


@pytest.mark.parametrize("closes", [False, True], ids=["listens", "closes its pipe"])
def test_who_takes_too_long_is_killed_with_all_that_it_started(
    *, closes: bool, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    started = folder.parent / "started"

    def overruns(tell: Callable[..., object]) -> None:
        started.write_text(str(subprocess.Popen(["sleep", "600"]).pid))
        tell(folder=str(folder))
        tell(limit=0.05, what="carrying out")
        if closes:
            os.closerange(3, 100)
        forever()

    assert watched(overruns) == 1
    assert found(folder) == ("timeout", "carrying out took longer than 0.05 s and was stopped")
    assert "error: carrying out took longer" in capsys.readouterr().err
    until(lambda: has_ended(int(started.read_text())))


def has_ended(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


def test_an_episode_that_was_over_stays_as_it_was_judged(folder: Path) -> None:
    judged = {"phframe": 2, "kind": "episode", "episode": {"status": "retrieved", "reason": ""}}
    (folder / "episode.json").write_text(json.dumps(judged))

    def dies(tell: Callable[..., object]) -> None:
        tell(folder=str(folder))
        os._exit(9)

    assert watched(dies) == 1
    assert found(folder) == ("retrieved", "")


def test_what_is_left_of_a_video_is_swept_whatever_it_is_called(folder: Path) -> None:
    video = folder.parent / "sure[confirm=false].mp4"
    part = folder.parent / f".{video.name}.0c.part"
    part.touch()

    def dies(tell: Callable[..., object]) -> None:
        tell(video=str(video))
        os._exit(9)

    assert watched(dies) == 1
    assert not part.exists()


def test_who_ignores_the_end_of_children_gets_the_exit_code_all_the_same() -> None:
    before = signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    reader, writer = os.pipe()
    process = os.fork()
    if not process:
        os.write(writer, b'{"ended": 0}\n')
        os._exit(7)
    os.close(writer)
    os.set_blocking(reader, False)
    try:
        until(lambda: not Path(f"/proc/{process}").exists())  # the kernel has waited for it
        assert Watchdog(process, reader, None).wait() == 0
    finally:
        os.close(reader)
        signal.signal(signal.SIGCHLD, before)


def test_a_limit_that_is_lifted_in_time_does_not_count(folder: Path) -> None:
    def heeds(tell: Callable[..., object]) -> None:
        tell(limit=0.0, what="planning")
        tell(limit=None)
        signal.sigtimedwait([signal.SIGUSR1], 1.0)
        tell(ended=1)

    assert watched(heeds) == 1
    assert folder.exists()


def test_nonsense_in_the_pipe_is_passed_over() -> None:
    def babbles(tell: Callable[..., object]) -> None:
        for what in ({"limit": "x"}, {"folder": 3}, {"ended": None}, {"limit": [1]}, {}):
            tell(**what)
        tell(ended=1)

    assert watched(babbles) == 1


def test_memory_is_that_of_all_that_was_started() -> None:
    assert memory_of(os.getpid()) > 2**22
    process = subprocess.Popen([sys.executable, "-c", "x = bytes(range(256)) * 400_000; print(1, flush=True); input()"],
                               stdin=subprocess.PIPE, stdout=subprocess.PIPE)  # fmt: skip
    assert process.stdout is not None
    process.stdout.readline()
    assert process.pid in descendants(os.getpid())
    assert memory_of(os.getpid()) > memory_of(process.pid) > 100_000_000
    process.communicate(b"\n")
    assert memory_of(process.pid) == 0
