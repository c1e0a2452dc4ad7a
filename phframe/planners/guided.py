"""GRTC with a human in the loop (Papallas and Dogar 2020): a person names the object and its place, the planner pushes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator

from phframe.core import FloatArray, Hint, InputError, Plan, Planner, Question, State, Task, UnknownNameError
from phframe.pushing import Corridor, GrtcSearch, Obstruction, StraightPushOptions
from phframe.pushing.hints import HintOption, read_hints

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
    """Drives straight at the target in simulation; asks what to push where as long as something is in the way; grasps."""

    options_type = GuidedOptions

    def search(self, task: Task) -> Plan:
        """One push for each hint that can be used.

        Raises:
            InputError: If a hint of the options is about an object that is not there, or a place outside the shelf.
        """
        grtc = GrtcSearch(task, self.options)
        if self.options.hints is None:
            return grtc.run(lambda met: _asked(task, grtc, met))
        hints = self.options.hints
        for number, hint in enumerate(hints, start=1):
            _refuse(grtc, hint, number)
        return grtc.run(lambda met: self._next(grtc, met))

    def _next(self, grtc: GrtcSearch, met: Obstruction) -> int | str:
        """Do as the first hint says that is not done."""
        hints = self.options.hints or ()
        number = next(_undone(grtc, hints, met.state), None)
        if number is None:
            return f"the straight drive still meets {met.blocker}, and all {len(hints)} hints are done"
        hint = hints[number]
        pushed = _push(grtc, met, Hint(hint.object, hint.to))
        return f"{_name(hint, number + 1)}: {pushed}" if isinstance(pushed, str) else pushed


def _asked(task: Task, grtc: GrtcSearch, met: Obstruction) -> int | str:
    """Ask until an answer can be used."""
    refusal, corridor = "", _outline(met.drive.grasp.corridor)
    for _ in range(MOST_REFUSALS):
        hint = task.ask(Question(grtc.search.pushing.scene, met.state, met.blocker, corridor, refusal))
        if hint is None:
            return f"no hint what to do about {met.blocker}, which is in the way: {REMEDY}"
        pushed = _push(grtc, met, hint)
        if isinstance(pushed, int):
            return pushed
        refusal = pushed
    return f"{MOST_REFUSALS} answers in a row could not be used; the last one: {refusal}"


def _push(grtc: GrtcSearch, met: Obstruction, hint: Hint) -> int | str:
    """Do as a hint says; why not, where that cannot be."""
    if mistake := _mistake(grtc, hint):
        return mistake
    place, row = np.array(hint.to), grtc.search.pushing.scene.index(hint.object)
    if refusal := grtc.pusher.refusal(met.state, row, place):
        return refusal
    return grtc.push(met, hint.object, place, hint)


def _undone(grtc: GrtcSearch, hints: Iterable[HintOption], state: State) -> Iterator[int]:
    """Which hints are still to be done: those whose object is neither at that place nor at one of a later hint for it."""
    done: set[str] = set()
    undone: list[int] = []
    for number, hint in reversed(list(enumerate(hints))):
        if grtc.pusher.is_there(state, grtc.search.pushing.scene.index(hint.object), np.array(hint.to)):
            done.add(hint.object)
        if hint.object not in done:
            undone.append(number)
    return reversed(undone)


def _refuse(grtc: GrtcSearch, hint: HintOption, number: int) -> None:
    """Refuse a hint that can never be done."""
    if why := _mistake(grtc, Hint(hint.object, hint.to)):
        raise InputError(f"{_name(hint, number)}: {why}")


def _mistake(grtc: GrtcSearch, hint: Hint) -> str:
    """Why a hint can be done in no state; empty: it can."""
    scene = grtc.search.pushing.scene
    if hint.object not in scene.ids:
        return str(UnknownNameError("object", hint.object, scene.ids))
    if hint.object == scene.target:
        return f"{hint.object} is the target: it is grasped, not pushed"
    return grtc.pusher.outside(scene.index(hint.object), np.array(hint.to))


def _name(hint: HintOption, number: int) -> str:
    """Where a hint was written, or which of the list it is, from 1."""
    return hint.where or f"hint {number}"


def _outline(corridor: Corridor) -> FloatArray:
    """Corners ``(4, 2)`` of a corridor in the shelf frame (m)."""
    low, high = corridor.axis - corridor.half_width, corridor.axis + corridor.half_width
    ends = corridor.start, corridor.end
    return corridor.to_shelf(np.array([(ends[0], low), (ends[1], low), (ends[1], high), (ends[0], high)]))
