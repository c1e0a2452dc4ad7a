"""The interface of planners."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace
from typing import ClassVar, Generic, TypeVar, final

from phframe.core.arm import FINGER_ROOM, GRAZING, ArmShape
from phframe.core.errors import BudgetExceededError, PluginError, SimulationDivergedError
from phframe.core.options import Options
from phframe.core.plan import Plan
from phframe.core.scene import Scene
from phframe.core.status import Status
from phframe.core.task import Task

OptionsT = TypeVar("OptionsT", bound=Options)


class Planner(ABC, Generic[OptionsT]):
    """Finds the actions that achieve a goal. Stateless: one object may plan many tasks.

    A planner is one class with ``search`` and, where it has options, ``options_type``::

        class Mine(Planner[MyOptions]):
            options_type = MyOptions

            def search(self, task: Task) -> Plan: ...
    """

    options_type: ClassVar[type[Options]] = Options
    pushes_target: ClassVar[bool] = False
    """Whether it may push the object that has to be grasped. If not, ``search`` is not asked where that is out of reach."""

    def __init__(self, options: OptionsT) -> None:
        self.options = options

    @final
    def plan(self, task: Task) -> Plan:
        """Search, and always return a plan: a spent budget or a diverged simulation is a result with a reason.

        Where the object that has to be grasped is too low or too wide for the fingers, or out of the arm's reach and not to
        be pushed, that is the reason, and nothing is searched.

        Raises:
            PluginError: If ``search`` returns something else than a plan.
        """
        try:
            plan = self._beyond_reach(task) or self.search(task)
        except BudgetExceededError as error:
            plan = task.offered or Plan(Status.TIMEOUT, str(error), task.explored)
        except SimulationDivergedError as error:
            plan = task.offered or Plan(Status.FAILED, str(error), task.explored)
        if not isinstance(plan, Plan):
            raise PluginError(f"planner {type(self).__name__} returned {plan!r} instead of a Plan")
        return replace(plan, cost=task.cost)

    def _beyond_reach(self, task: Task) -> Plan | None:
        """That the object to be grasped cannot be, if so: shelf, arm and object do not fit together, or it is out of reach."""
        if (wanted := task.goal.grasped(task.scene)) is None:
            return None
        if misfit := _misfit(task.scene, wanted, task.arm):
            return Plan(Status.FAILED, misfit)
        beyond = None if self.pushes_target else task.out_of_reach(wanted)
        return None if beyond is None else Plan(Status.FAILED, f"{wanted} is out of reach: {beyond.why}")

    def check(self, scene: Scene) -> None:
        """Refuse, before anything is simulated or written, a scene that the options do not fit. By default they do.

        Raises:
            InputError: If they name something that is not in the scene.
        """

    @abstractmethod
    def search(self, task: Task) -> Plan:
        """Find a plan, trying actions with ``task.apply``.

        What cannot be solved is a plan with status ``FAILED`` and a reason, never an exception and never None. Let
        ``BudgetExceededError`` pass: ``plan`` deals with it. Do not print. Take chance from ``task.rng`` only.
        """


def _misfit(scene: Scene, wanted: str, arm: ArmShape) -> str:
    """Why an arm cannot grasp an object of a shelf, wherever it stands; empty: it can."""
    item = scene.objects[scene.index(wanted)]
    tall, fingers = item.shape.height, arm.fingers_bottom
    if (top := arm.top) >= (ceiling := scene.shelf.height):
        return f"the shelf is {ceiling:g} m high: the arm, up to {top:g} m high, does not go in"
    if tall <= fingers + GRAZING:
        return (
            f"{wanted} is {tall:g} m tall, and the fingers pass over the board at {fingers:g} m: they cannot grasp it"
        )
    if 2.0 * (item.radius + FINGER_ROOM) > arm.max_opening:
        return f"{wanted} is {2.0 * item.radius:g} m wide, too wide for a gripper that opens {arm.max_opening:g} m"
    return ""
