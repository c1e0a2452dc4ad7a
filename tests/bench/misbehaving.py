"""Planners that do what none should. Each is PHIA beside that, where it gets so far."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from phframe.core import Plan, Planner, Task
from phframe.planners.phia import PHIA, PHIAOptions


class Marking(PHIAOptions):
    """Options.

    Attributes:
        mark: The file in which the ids of processes are left that might live on; empty: nowhere.
    """

    mark: str = ""


class Decent(Planner[Marking]):
    options_type = Marking

    def search(self, task: Task) -> Plan:
        return PHIA(self.options).search(task)

    def leave(self, *ids: int) -> None:
        """Say which processes there are."""
        if self.options.mark:
            with Path(self.options.mark).open("a", encoding="ascii") as file:
                file.writelines(f"{each}\n" for each in ids)


class Segfaults(Decent):
    def search(self, task: Task) -> Plan:
        ctypes.string_at(0)
        return super().search(task)


class Exits(Decent):
    def search(self, task: Task) -> Plan:
        print("I have had enough")
        sys.stdout.flush()
        os._exit(3)


class ExitsAsIfAllWereWell(Decent):
    def search(self, task: Task) -> Plan:
        os._exit(0)


class AsksToExit(Decent):
    def search(self, task: Task) -> Plan:
        sys.exit(4)


class Aborts(Decent):
    def search(self, task: Task) -> Plan:
        os.abort()


class Hangs(Decent):
    def search(self, task: Task) -> Plan:
        self.leave(os.getpid())
        while True:
            time.sleep(60)


class EatsMemory(Decent):
    def search(self, task: Task) -> Plan:
        eaten = []
        while True:
            eaten.append(np.ones(10_000_000))


class ReturnsThree(Decent):
    def search(self, task: Task) -> Any:
        return 3


class ReturnsNonsense(Decent):
    def search(self, task: Task) -> Plan:
        return Plan("great", 3, [])  # type: ignore[arg-type]


class Raises(Decent):
    def search(self, task: Task) -> Plan:
        raise RuntimeError("no\nidea")


class Interrupts(Decent):
    def search(self, task: Task) -> Plan:
        raise KeyboardInterrupt


class Prints(Decent):
    def search(self, task: Task) -> Plan:
        for _ in range(20_000):
            print("x" * 99)
        os.write(1, b"\xff\x00")
        return super().search(task)


class ClosesItsOutput(Decent):
    def search(self, task: Task) -> Plan:
        os.close(1)
        os.close(2)
        return super().search(task)


class Forks(Decent):
    def search(self, task: Task) -> Plan:
        child = os.fork()
        if child == 0:
            time.sleep(600)
            os._exit(0)
        self.leave(child, subprocess.Popen(["sleep", "600"]).pid)
        return super().search(task)


class ForksAndHangs(Hangs):
    def search(self, task: Task) -> Plan:
        if os.fork() == 0:
            self.leave(os.getpid())
            time.sleep(600)
        self.leave(subprocess.Popen(["sleep", "600"]).pid)
        return super().search(task)


class ForksAndReturnsTwice(Decent):
    def search(self, task: Task) -> Plan:
        os.fork()
        return super().search(task)


class MovesTheStart(Decent):
    def search(self, task: Task) -> Plan:
        plan = super().search(task)
        task.start.poses.setflags(write=True)
        task.start.poses[0, 0] += 0.1
        return plan


class ChangesTheScene(Decent):
    def search(self, task: Task) -> Plan:
        plan = super().search(task)
        object.__setattr__(task.scene.objects[0], "friction", 0.9)
        return plan
