"""Parts of a run that do what none should: planners, backends, topology engines, arms and goals, each decent beside that."""

from __future__ import annotations

import ctypes
import os
import sys
import time
from contextlib import suppress
from typing import Any

import numpy as np

from phframe.arms.planar import PlanarArm
from phframe.backends.pymunk_.physics import PymunkPhysics
from phframe.core import (
    Action,
    Assessment,
    Attempt,
    Contacts,
    FloatArray,
    GripperPath,
    Motion,
    Options,
    PersistenceDiagram,
    Phase,
    PhaseRule,
    Plan,
    Planner,
    Scene,
    Settle,
    State,
    Status,
    Stop,
    Task,
    Trajectory,
    Watch,
)
from phframe.planners.phia import PHIA, PHIAOptions
from phframe.pushing.retrieve import Retrieve
from phframe.topology.single_linkage import SingleLinkage


def raises() -> None:
    raise RuntimeError("no\nidea")


def raises_what_has_no_text() -> None:
    raise MuteError


def raises_no_exception() -> None:
    raise Unruly("x")


def asks_to_exit() -> None:
    sys.exit(0)


def exits() -> None:
    os._exit(0)


def segfaults() -> None:
    ctypes.string_at(0)


def turns() -> None:
    while True:
        pass


def swallows_all() -> None:
    while True:
        with suppress(BaseException):
            time.sleep(1)


def hangs_in_c() -> None:
    """As an engine does that never comes back and never gives Python a turn."""
    ctypes.PyDLL(None).pause()


def hangs() -> None:
    time.sleep(3600)


def eats() -> None:
    eaten = []
    while True:
        eaten.append(bytearray(40_000_000))
        time.sleep(0.01)


class MuteError(Exception):
    def __str__(self) -> str:
        raise ValueError("no text")


class Unruly(BaseException):
    pass


DEEDS = {
    deed.__name__: deed
    for deed in (
        raises,
        raises_what_has_no_text,
        raises_no_exception,
        asks_to_exit,
        exits,
        segfaults,
        turns,
        swallows_all,
        hangs_in_c,
        hangs,
        eats,
    )
}


class DeedOptions(PHIAOptions):
    """Options.

    Attributes:
        deed: What is done instead of planning.
        at: Which time the planner is asked, counted from 0.
    """

    deed: str = "raises"
    at: int = 0


class DoesIt(Planner[DeedOptions]):
    options_type = DeedOptions
    asked = 0

    def search(self, task: Task) -> Plan:
        DoesIt.asked += 1
        if DoesIt.asked > self.options.at:
            DEEDS[self.options.deed]()
        plan = PHIA(self.options).search(task)
        assert plan.tree is not None
        first = plan.tree.path[0]
        assert first.action is not None
        return Plan.of(Status.CLEARED, "", task.start, [(first.action, task.start)])  # one push, and asked again


class DoesItWhileExecuting(PymunkPhysics):
    """Does it in the second action that is carried out. ``raises`` unless the environment says something else."""

    executed = 0

    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        if watch is not None:
            DoesItWhileExecuting.executed += 1
            if DoesItWhileExecuting.executed > 1:
                DEEDS[os.environ.get("DEED", "raises")]()
        return super().execute(trajectory, settle=settle, stop=stop, watch=watch)


class Tells(PymunkPhysics):
    """Makes a file of its name as the action of a number (``TELL``) is carried out, and waits for an end of the world."""

    executed = 0

    def execute(
        self, trajectory: Trajectory, *, settle: Settle | None, stop: Stop | None = None, watch: Watch | None = None
    ) -> Motion:
        if watch is not None:
            if Tells.executed == int(os.environ["TELL"]):
                with open("told", "w", encoding="ascii"):  # noqa: PTH123
                    pass
                time.sleep(600)
            Tells.executed += 1
        return super().execute(trajectory, settle=settle, stop=stop, watch=watch)


class DoesItInTopology(SingleLinkage):
    def diagram(self, points: FloatArray) -> PersistenceDiagram:
        DEEDS[os.environ.get("DEED", "raises")]()
        return super().diagram(points)


class DoesItInArm(PlanarArm):
    def inverse(self, pose: Any, seed: Any = None) -> Any:
        DEEDS[os.environ.get("DEED", "raises")]()
        return super().inverse(pose, seed)


class DoesItInGoal(Retrieve):
    def assess(self, scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        DEEDS[os.environ.get("DEED", "raises")]()
        return super().assess(scene, state, last)


class ManyActions(Planner[Options]):
    """3,000 actions, each of which takes its time."""

    number, legs = 3000, 4

    def search(self, task: Task) -> Plan:
        action = Action("back and forth", self.path(task))
        return Plan.of(Status.CLEARED, "", task.start, [(action, task.start)] * self.number)

    def path(self, task: Task) -> GripperPath:
        rule = PhaseRule(0.01, task.arm.min_opening, Contacts.OBJECTS)
        poses = np.tile([-0.6, 0.3, 0.0], (self.legs + 1, 1))
        poses[::2, 1] += 0.2
        return GripperPath(poses, (Phase.APPROACH,) * self.legs, {Phase.APPROACH: rule})


class AllThatMayBe(ManyActions):
    """As many actions as a plan may have."""

    number = 1000


class LongAction(ManyActions):
    """One that takes more than an hour."""

    number, legs = 1, 200


class LongPath(ManyActions):
    """A path of a million poses."""

    number, legs = 1, 1_000_000


class ForcedLongPath(ManyActions):
    """The same, behind the back of the class that paths are of."""

    number = 1

    def path(self, task: Task) -> GripperPath:
        path = super().path(task)
        object.__setattr__(path, "poses", np.tile(path.poses[:1], (1_000_000, 1)))
        object.__setattr__(path, "phases", (Phase.APPROACH,) * 999_999)
        return path


class ManyPaths(ManyActions):
    """Paths that are no longer than they may be, with a million poses altogether."""

    number, legs = 201, 5000


class LargeTree(ManyActions):
    """A tree of more nodes than anybody looks at."""

    number = 100_000


class NeverEnough(Planner[Options]):
    """Tries what it has tried, whatever it is told."""

    def search(self, task: Task) -> Plan:
        plan = PHIA(PHIAOptions()).search(task)
        assert plan.actions
        while True:
            with suppress(BaseException):
                task.apply(task.start, plan.actions[0])
