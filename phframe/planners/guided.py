"""GRTC with a human in the loop (Papallas and Dogar 2020): a person names the object and its place, the planner pushes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator

from phframe.core import (
    FloatArray,
    Hint,
    InputError,
    Plan,
    Planner,
    Question,
    Scene,
    SearchNode,
    State,
    Task,
    UnknownNameError,
)
from phframe.pushing import Corridor, GrtcSearch, Obstruction, StraightPushOptions
from phframe.pushing.hints import HintOption, read_hints
from phframe.pushing.straight_push import outside_shelf

MOST_REFUSALS = 100
"""Answers in a row that cannot be used, after which nobody is asked again."""
REMEDY = "answer in a terminal, or give a file of hints: --option hints=FILE"


def _read(value: Any) -> Any:
    """The hints of a file that is named; else what is given."""
    if isinstance(value, str | Path):
        return tuple(read_hints(value))
    return tuple(value) if isinstance(value, list) else value


class GuidedOptions(StraightPushOptions):
    """Figures of GRTC with straight pushes, and hints.

    Attributes:
        hints: A YAML file of hints, or their list: objects and their places, in order; None: whoever is there is asked.
            One whose object is at that place already, or at that of a later hint for it, counts as done.
    """

    hints: Annotated[tuple[HintOption, ...], BeforeValidator(_read)] | None = None


class Guided(Planner[GuidedOptions]):
    """Drives straight at the target in simulation; asks what to push where as long as something blocks that; grasps."""

    options_type = GuidedOptions

    def check(self, scene: Scene) -> None:
        """Refuse hints about objects that are not there, and places outside the shelf.

        Raises:
            InputError: Where it was written, what is wrong, and what there is.
        """
        for number, hint in enumerate(self.options.hints or (), start=1):
            if mistake := _mistake(scene, hint.object, np.array(hint.to)):
                raise InputError(f"{_name(hint, number)}: {mistake}")

    def search(self, task: Task) -> Plan:
        """One push for each hint that can be used."""
        grtc = GrtcSearch(task, self.options)
        if self.options.hints is None:
            return grtc.run(lambda met: _asked(task, grtc, met))
        pending = _undone(grtc, self.options.hints, task.start)
        return grtc.run(lambda met: self._next(grtc, pending, met))

    def _next(self, grtc: GrtcSearch, pending: Sequence[int], met: Obstruction) -> int | str:
        """Do as the next hint says, of those that were to be done at the start."""
        hints = self.options.hints or ()
        left = pending
        for node in grtc.search.tree.path(met.node):
            left = left[next(at for at, number in enumerate(left) if hints[number].hint == _hint(node)) + 1 :]
        number = next((number for number in left if not _is_done(grtc, hints[number], met.state)), None)
        if number is None:
            return f"the straight drive still meets {met.blocker}, and all {len(hints)} hints are done"
        pushed = _push(grtc, met, hints[number].hint)
        return f"{_name(hints[number], number + 1)}: {pushed}" if isinstance(pushed, str) else pushed


def _asked(task: Task, grtc: GrtcSearch, met: Obstruction) -> int | str:
    """Ask until an answer can be used."""
    refusal, corridor = "", _outline(met.drive.grasp.corridor)
    for _ in range(MOST_REFUSALS):
        hint = task.ask(Question(grtc.search.pushing.scene, met.state, met.blocker, corridor, refusal))
        if hint is None:
            return f"no hint what to do about {met.blocker}, which blocks the drive: {REMEDY}"
        pushed = _push(grtc, met, hint)
        if isinstance(pushed, int):
            return pushed
        refusal = pushed
    return f"{MOST_REFUSALS} answers in a row could not be used; the last one: {refusal}"


def _push(grtc: GrtcSearch, met: Obstruction, hint: Hint) -> int | str:
    """Do as a hint says; why not, where that cannot be."""
    scene, place = grtc.search.pushing.scene, np.array(hint.to)
    if mistake := _mistake(scene, hint.object, place):
        return mistake
    if hint.object == scene.target:
        return f"{hint.object} is the target: it is grasped, not pushed"
    if refusal := grtc.pusher.refusal(met.state, scene.index(hint.object), place):
        return refusal
    return grtc.push(met, hint.object, place, hint)


def _mistake(scene: Scene, name: str, place: FloatArray) -> str:
    """Why an object can stand at a place ``(2,)`` (m) in no state of a scene; empty: it can."""
    if name not in scene.ids:
        return str(UnknownNameError("object", name, scene.ids))
    return outside_shelf(scene, scene.index(name), place)


def _undone(grtc: GrtcSearch, hints: Sequence[HintOption], state: State) -> list[int]:
    """Which hints are still to be done: those whose object is neither at that place nor at one of a later hint for it."""
    done: set[str] = set()
    undone: list[int] = []
    for number, hint in reversed(list(enumerate(hints))):
        if _is_done(grtc, hint, state):
            done.add(hint.object)
        if hint.object not in done:
            undone.append(number)
    return undone[::-1]


def _is_done(grtc: GrtcSearch, hint: HintOption, state: State) -> bool:
    ids = grtc.search.pushing.scene.ids
    return hint.object in ids and grtc.pusher.is_there(state, ids.index(hint.object), np.array(hint.to))


def _hint(node: SearchNode) -> Hint | None:
    return None if node.decision is None else node.decision.hint


def _name(hint: HintOption, number: int) -> str:
    """Where a hint was written, or which of the list it is, from 1."""
    return hint.where or f"hint {number}"


def _outline(corridor: Corridor) -> FloatArray:
    """Corners ``(4, 2)`` of a corridor in the shelf frame (m)."""
    low, high = corridor.axis - corridor.half_width, corridor.axis + corridor.half_width
    ends = corridor.start, corridor.end
    return corridor.to_shelf(np.array([(ends[0], low), (ends[1], low), (ends[1], high), (ends[0], high)]))
