from __future__ import annotations

import io
import sys
from collections.abc import Callable
from contextlib import closing

import pytest

from phframe.cli.progress import Progress
from phframe.core import BasePose, Plan, RunSpec, Scene, Status
from phframe.registry import Kind, create
from phframe.runtime.observer import MountedArm
from tests.cli.conftest import until

SPEC = RunSpec()


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def scene() -> Scene:
    scene: Scene = create(Kind.SCENES, "vieira").load("basic")
    return scene


@pytest.fixture
def arm() -> MountedArm:
    return MountedArm(create(Kind.ARM, "planar"), BasePose(-0.1, 0.3, 0.06, 0.0), by_joints=False)


def _watch(progress: Progress, scene: Scene, arm: MountedArm, shown: Callable[[], object] = lambda: True) -> None:
    with closing(progress):
        progress.start()
        progress.begin(scene, SPEC, arm)
        until(shown)
        progress.planned(Plan(Status.FAILED, "no way"))


def test_a_terminal_is_told_what_is_going_on(monkeypatch: pytest.MonkeyPatch, scene: Scene, arm: MountedArm) -> None:
    monkeypatch.setattr(sys, "stderr", screen := Terminal())
    monkeypatch.setenv("TERM", "xterm")
    _watch(Progress(after=0.0), scene, arm, lambda: "Planning with phia for vieira/basic" in screen.getvalue())


def test_nothing_is_shown_of_what_is_quickly_done(
    monkeypatch: pytest.MonkeyPatch, scene: Scene, arm: MountedArm
) -> None:
    monkeypatch.setattr(sys, "stderr", screen := Terminal())
    monkeypatch.setenv("TERM", "xterm")
    _watch(Progress(after=3600.0), scene, arm)  # which is not waited for
    assert "Planning" not in screen.getvalue()


def test_nothing_is_shown_where_there_is_no_terminal(
    monkeypatch: pytest.MonkeyPatch, scene: Scene, arm: MountedArm
) -> None:
    monkeypatch.setattr(sys, "stderr", screen := io.StringIO())
    _watch(Progress(after=0.0), scene, arm)
    assert screen.getvalue() == ""


def test_it_steps_aside_while_somebody_else_has_the_screen(
    monkeypatch: pytest.MonkeyPatch, scene: Scene, arm: MountedArm
) -> None:
    monkeypatch.setattr(sys, "stderr", screen := Terminal())
    monkeypatch.setenv("TERM", "xterm")
    with closing(Progress(after=0.0)) as progress:
        progress.start()
        progress.begin(scene, SPEC, arm)
        until(lambda: "Planning with phia" in screen.getvalue())
        with progress.aside():
            before = screen.getvalue()
            assert before.endswith("\x1b[2K")  # the line is wiped, and the cursor is at its beginning
            progress.planned(Plan(Status.FAILED, "no way"))
            assert screen.getvalue() == before
        until(lambda: len(screen.getvalue()) > len(before))


def test_what_was_not_begun_does_not_come_back(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stderr", screen := Terminal())
    monkeypatch.setenv("TERM", "xterm")
    with closing(Progress(after=0.0)) as progress, progress.aside():
        pass
    assert screen.getvalue() == ""
