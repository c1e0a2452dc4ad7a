"""What parts of a run that are not phframe's own are given, and what is taken from them: copies that keep to the interface.

phframe's own parts are trusted and cost nothing here.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from contextlib import contextmanager
from copy import copy, deepcopy
from dataclasses import fields, replace
from typing import Any, TypeVar

import numpy as np
from pydantic import ValidationError

from phframe.core import (
    Action,
    ArmModel,
    Assessment,
    Attempt,
    Condition,
    Contact,
    Goal,
    Motion,
    Phase,
    Plan,
    Planner,
    PluginError,
    Scene,
    State,
    Status,
    StopReason,
    Task,
)
from phframe.core.errors import BudgetExceededError, error_text
from phframe.core.gripper_path import MOST_LEGS
from phframe.core.run_spec import first_fault
from phframe.core.state import ArmState
from phframe.registry import Kind
from phframe.runtime.adapters import adapter_of
from phframe.runtime.blame import is_own, title_of

GoalT = TypeVar("GoalT", bound=Goal[Any])

LONGEST_TEXT = 2000
"""Characters of a reason or a name that a part gives."""
MOST_NODES, MOST_ALL_LEGS, MOST_ACTIONS = 100_000, 1_000_000, 1000
"""Of a plan: nodes of its tree, legs of all paths in that, actions that are to be carried out."""
_FIGURES = ("duration", "largest_force", "tracking_error", "followed")
"""Of a motion, that are finite and not negative."""


def refused(title: str, what: object) -> PluginError:
    """The error of a part that does not keep to its interface."""
    return PluginError(f"{title} does not keep to its interface: {what}")


@contextmanager
def _refusing(title: str) -> Iterator[None]:
    """Have what cannot even be looked at refused, too."""
    try:
        yield
    except (PluginError, BudgetExceededError):
        raise
    except Exception as error:
        raise refused(title, f"what it returned cannot be read: {error_text(error)}") from error


def check_arm(arm: ArmModel[Any], name: Any) -> None:
    """See that a foreign arm says of itself what can be.

    Raises:
        PluginError: If its outlines, its home or its force limit cannot be.
    """
    if is_own(arm):
        return
    title = title_of(Kind.ARM, name)
    with _refusing(title):
        figures = [np.ravel(arm.home), np.ravel(arm.forward(arm.home)), *(each.vertices for each in arm.shape.closed)]
        widths = (arm.force_limit, arm.shape.link_width, arm.shape.max_opening - arm.shape.min_opening)
        if not all(np.isfinite(each).all() for each in figures) or not all(0.0 < each < math.inf for each in widths):
            raise refused(title, "its home, outlines, widths and force limit are finite numbers, the last ones above 0")


def copied_scene(part: Any, scene: Scene) -> Scene:
    """The scene as a part may have it: one of its own, so that what it does to it stays its own."""
    return scene if is_own(part) else deepcopy(scene)


def ask_planner(planner: Planner[Any], task: Task) -> Plan:
    """A planner's plan, of a foreign one a copy that has been checked; it is given copies of all data.

    Raises:
        PluginError: If it is no plan for the task.
    """
    if is_own(planner):
        return planner.plan(task)
    scene, start = task.scene, task.start
    with task.paused():
        for name in ("scene", "start", "goal", "arm", "rejected", "earlier", "budget"):
            setattr(task, name, deepcopy(getattr(task, name)))
    plan = Planner.plan(planner, task)
    with task.paused():
        return _checked_plan(plan, scene, start, title_of(Kind.PLANNER, planner))


def _checked_plan(plan: Plan, scene: Scene, start: State, title: str) -> Plan:
    """The plan as a file would give it back, of the right types and nobody else's; it begins where the task does."""
    adapter = adapter_of(Plan)
    with _refusing(title):
        if (problem := _problem_of_size(plan)) is not None:
            raise refused(title, f"its plan cannot be: {problem}")
        try:
            written = adapter.dump_python(_from_start(plan, start), mode="json", warnings=False)
            json.dumps(written, ensure_ascii=False).encode()  # no text that nobody can write
            checked: Plan = adapter.validate_python(written)
        except ValidationError as error:
            raise refused(title, f"its plan cannot be: {first_fault(error)}") from None
    if (problem := next(problems_of_plan(checked, scene), None)) is not None:
        raise refused(title, f"its plan cannot be: {problem}")
    return replace(checked, cost=plan.cost, reason=checked.reason[:LONGEST_TEXT])


def _from_start(plan: Plan, start: State) -> Plan:
    if plan.tree is None:
        return plan
    root, *rest = plan.tree.nodes
    return replace(plan, tree=replace(plan.tree, nodes=(replace(root, state=start), *rest)))


def _problem_of_size(plan: Plan) -> str | None:
    """Why a plan is more than anybody reads or carries out; it is looked at before it is copied."""
    if plan.tree is None:
        return None
    nodes = plan.tree.nodes
    if len(nodes) > MOST_NODES:
        return f"its tree has {len(nodes)} nodes; at most {MOST_NODES} are taken"
    legs = [len(node.action.path.poses) - 1 for node in nodes if node.action is not None]
    if (longest := max(legs, default=0)) > MOST_LEGS:
        return f"a path in its tree has {longest} legs; at most {MOST_LEGS} are taken"
    if sum(legs) > MOST_ALL_LEGS:
        return f"the paths in its tree have {sum(legs)} legs; at most {MOST_ALL_LEGS} are taken"
    return None


def problems_of_plan(plan: Plan, scene: Scene) -> Iterator[str]:
    """Why something is no plan for a scene: states, motions and actions of its tree that cannot be."""
    if len(plan.actions) > MOST_ACTIONS:
        yield f"it has {len(plan.actions)} actions; at most {MOST_ACTIONS} are carried out"
    for number, node in enumerate(plan.tree.nodes if plan.tree else ()):
        where = f"node {number} of its tree"
        if (problem := problem_of_state(node.state, scene)) is not None:
            yield f"{where}: {problem}"
        if node.motion is not None and (problem := problem_of_motion(node.motion)) is not None:
            yield f"{where}: {problem}"
        if node.action is not None and (problem := problem_of_action(node.action, scene)) is not None:
            yield f"{where}: {problem}"
        if node.value is not None and math.isnan(node.value):
            yield f"{where} has a value that is not a number"


def problem_of_action(action: Action, scene: Scene) -> str | None:
    """Why something is no action in a scene; None: it is one."""
    named = (*action.moves, *(() if action.path.manipuland is None else (action.path.manipuland,)))
    if strange := [name for name in named if name not in scene.ids]:
        return f"the action {action.name[:40]!r} is with {strange[0][:40]!r}, and there is no such object"
    return f"an action has a name of {len(action.name)} characters" if len(action.name) > LONGEST_TEXT else None


def problem_of_state(state: Any, scene: Scene) -> str | None:
    """Why something is no state of a scene; None: it is one."""
    if not isinstance(state, State):
        return f"a {type(state).__name__} is no State"
    count = len(scene.objects)
    poses: Any = state.poses
    if not isinstance(poses, np.ndarray) or poses.shape != (count, 7) or poses.dtype != np.float64:
        return f"a state of {count} objects has float poses of shape ({count}, 7), not {np.shape(poses)}"
    if not np.isfinite(state.poses).all():
        return f"a pose of {scene.ids[int(np.argmin(np.isfinite(state.poses).all(axis=1)))]!r} is not finite"
    if len(state.conditions) != count or not all(isinstance(each, Condition) for each in state.conditions):
        return f"the conditions of a state are {count} of Condition"
    if state.held is not None and (state.held not in scene.ids or state.arm is None):
        return f"{state.held!r:.60} is held, which is no object, or by no arm"
    return None if state.arm is None else _problem_of_arm(state.arm)


def _problem_of_arm(arm: Any) -> str | None:
    if not isinstance(arm, ArmState):
        return f"a {type(arm).__name__} is no ArmState"
    numbers = [*np.ravel(arm.gripper), arm.opening, arm.commanded_opening]
    numbers += [] if arm.joints is None else list(np.ravel(arm.joints))
    if np.shape(arm.gripper) != (3,) or not all(map(math.isfinite, numbers)):
        return "the arm's pose, opening and joints are finite numbers, the pose three"
    return None


def problem_of_motion(motion: Any) -> str | None:
    """Why something is no motion; None: it is one."""
    if not isinstance(motion, Motion):
        return f"a {type(motion).__name__} is no Motion"
    for name in _FIGURES:
        figure = getattr(motion, name)
        if not isinstance(figure, int | float) or not 0.0 <= figure < math.inf:
            return f"the {name} of a motion is {figure!r:.60}"
    if not all(type(flag) is bool for flag in (motion.stalled, motion.settled)):
        return "stalled and settled of a motion are True or False"
    if not (motion.stopped is None or isinstance(motion.stopped, StopReason)):
        return f"a motion stopped for {motion.stopped!r:.60}, which is no StopReason"
    return _problem_of_contacts(motion)


def _problem_of_contacts(motion: Motion) -> str | None:
    contacts: tuple[Any, ...] = (*motion.contacts, *motion.wall_contacts)
    for contact in contacts:
        if not isinstance(contact, Contact):
            return f"{contact!r:.80} is no Contact"
        names: tuple[Any, ...] = (contact.body, contact.part)
        if not all(isinstance(name, str) for name in names) or contact.phase not in list(Phase):
            return f"{contact!r:.80} has no body, part and phase"
        if not math.isfinite(contact.time):
            return f"{contact!r:.80} has no time"
    return None


def checked_state(state: Any, scene: Scene, title: str) -> State:
    """A copy of a state that a foreign part made.

    Raises:
        PluginError: If it is none of the scene.
    """
    with _refusing(title):
        if (problem := problem_of_state(state, scene)) is not None:
            raise refused(title, problem)
        return deepcopy_of_state(state)


def deepcopy_of_state(state: State) -> State:
    """A state that shares no array with another."""
    arm = state.arm if state.arm is None else replace(state.arm)
    held = None if state.held is None else str(state.held)
    return State(state.poses, tuple(state.conditions), held, arm)


def checked_motion(motion: Any, title: str) -> Motion:
    """A copy of a motion that a foreign part made.

    Raises:
        PluginError: If it is none.
    """
    with _refusing(title):
        if (problem := problem_of_motion(motion)) is not None:
            raise refused(title, problem)
        content = {each.name: getattr(motion, each.name) for each in fields(Motion)}
        contacts = {name: tuple(content[name]) for name in ("contacts", "wall_contacts")}
        return Motion(**{**content, **contacts, **{name: float(content[name]) for name in _FIGURES}})


def guarded_goal(goal: GoalT) -> GoalT:
    """A goal as it is to be used: phframe's own as it is, another of a class whose assessments are checked.

    It is given copies, and is still of its own class, which planners may ask for.
    """
    if is_own(goal):
        return goal
    title = title_of(Kind.GOAL, goal)

    def assess(self: Goal[Any], scene: Scene, state: State, last: Attempt | None = None) -> Assessment:
        return _checked_assessment(type(goal).assess(self, *deepcopy((scene, state, last))), title)

    guarded = copy(goal)
    own = type(goal)
    guarded.__class__ = type(own.__name__, (own,), {"assess": assess, "__module__": own.__module__})
    return guarded


def _checked_assessment(found: Any, title: str) -> Assessment:
    if not (isinstance(found, Assessment) and found.status in list(Status) and type(found.reason) is str):
        raise refused(title, f"it assessed a world as {found!r:.80}")
    return Assessment(found.status, found.reason[:LONGEST_TEXT], bool(found.lost))
