from __future__ import annotations

import io
import sys
import time
from contextlib import closing

import pytest

from phframe.cli.progress import Progress
from phframe.core import BasePose, Plan, RunSpec, Scene, Status
from phframe.registry import Kind, create
from phframe.runtime.observer import MountedArm

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


def _watch(progress: Progress, scene: Scene, arm: MountedArm, seconds: float) -> None:
    with closing(progress):
        progress.start()
        progress.begin(scene, SPEC, arm)
        time.sleep(seconds)
        progress.planned(Plan(Status.FAILED, "no way"))


def test_a_terminal_is_told_what_is_going_on(monkeypatch: pytest.MonkeyPatch, scene: Scene, arm: MountedArm) -> None:
    monkeypatch.setattr(sys, "stderr", screen := Terminal())
    monkeypatch.setenv("TERM", "xterm")
    _watch(Progress(after=0.0), scene, arm, 0.3)
    assert "Planning with phia for vieira/basic" in screen.getvalue()


def test_nothing_is_shown_of_what_is_quickly_done(
    monkeypatch: pytest.MonkeyPatch, scene: Scene, arm: MountedArm
) -> None:
    monkeypatch.setattr(sys, "stderr", screen := Terminal())
    monkeypatch.setenv("TERM", "xterm")
    began = time.monotonic()
    _watch(Progress(), scene, arm, 0.0)
    assert "Planning" not in screen.getvalue()
    assert time.monotonic() - began < 0.5


def test_nothing_is_shown_where_there_is_no_terminal(
    monkeypatch: pytest.MonkeyPatch, scene: Scene, arm: MountedArm
) -> None:
    monkeypatch.setattr(sys, "stderr", screen := io.StringIO())
    _watch(Progress(after=0.0), scene, arm, 0.1)
    assert screen.getvalue() == ""
