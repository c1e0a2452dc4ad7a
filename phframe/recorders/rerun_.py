"""Records an episode for the Rerun viewer while it runs."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain
from pathlib import Path

import numpy as np
import rerun as rr

from phframe.core import Episode, ExploredTree, Plan, RunSpec, Scene, State, Step
from phframe.pushing import PushDecision
from phframe.recorders import (
    arm_entities,
    decision_entities,
    narration,
    object_entities,
    palette,
    persistence_entities,
    series,
    shelf_entities,
    tree_entities,
)
from phframe.recorders.arm_bodies import bodies_of
from phframe.recorders.blueprint import blueprint_for
from phframe.recorders.coloring import components_of
from phframe.recorders.frames import Frames
from phframe.recorders.search_path import farthest_path
from phframe.recorders.stream import Stream
from phframe.runtime.observer import MountedArm, Observer
from phframe.runtime.versions import versions_of

LOG = "story/log"
WARNINGS = f"{LOG}/warnings"
"""An entity of its own: a colour holds for all that an entity says later."""
PAGE = "story/decision"


class RerunRecorder(Observer):
    """Writes an ``.rrd`` file that grows with the episode; whatever ends the episode, what was recorded stays.

    Two timelines: ``sim_time``, the time in the world since the episode began, and ``action``, 0 before the first.

    Args:
        path: The file; one that exists is overwritten. It is created when the episode begins.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._stream: Stream | None = None
        self._seconds, self._actions, self._plans = 0.0, 0, 0

    def begin(self, scene: Scene, spec: RunSpec, arm: MountedArm) -> None:
        """Create the file and write down what stays as it is, and the scene as it begins.

        Raises:
            InputError: If the file cannot be written, or the arm cannot be drawn.
        """
        self._scene, self._arm, self._bodies = scene, arm.shape, bodies_of(arm, scene)
        blueprint = blueprint_for(scene.shelf, arm.base_pose, self._bodies.extent() if arm.by_joints else None)
        stream = Stream(self.path, scene.name, blueprint, _properties(spec))
        self._stream = stream
        self._seconds, self._actions, self._plans = 0.0, 0, 0
        shelf_entities.log_shelf(stream, scene.shelf)
        object_entities.log_objects(stream, scene)
        arm_entities.log_arm(stream, self._arm, self._bodies)
        series.log_styles(stream)
        self._show_beginning(stream, narration.opening_line(scene, spec))

    def planned(self, plan: Plan) -> None:
        """Write down what a plan holds, what it was found among and what it cost; of one that failed, what was tried."""
        if self._stream is not None:
            self._plans += 1
            series.log_planning(self._stream, plan)
            tree_entities.log_tree(self._stream, plan.tree)
            level = "INFO" if plan.succeeded else "WARN"
            self._say(self._stream, narration.plan_line(plan, self._plans), level)
            if plan.tree is not None and not plan.succeeded:
                self._show_tried(self._stream, plan.tree)

    def stepped(self, step: Step, frames: Iterable[tuple[float, State]]) -> None:
        """Write down why an action was chosen, every frame of it, and what it did."""
        if self._stream is None:
            return
        self._actions += 1
        self._stream.at(self._seconds, self._actions)
        self._show_decision(self._stream, step)
        self._show_frames(self._stream, step, frames)
        self._show_outcome(self._stream, step)
        self._stream.flush()

    def finished(self, episode: Episode) -> None:
        """Write down how it ended."""
        if self._stream is not None:
            level = "INFO" if narration.is_good(episode.status) else "WARN"
            self._say(self._stream, narration.ending_line(episode), level)
            self._stream.put(PAGE, rr.TextDocument(narration.ending_page(episode), media_type="text/markdown"))

    def close(self) -> None:
        """Write the rest and end the file."""
        if self._stream is not None:
            self._stream.close()
            self._stream = None

    def _show_beginning(self, stream: Stream, line: str) -> None:
        initial = self._scene.initial_state()
        stream.at(0.0, 0)
        object_entities.log_colors(stream, self._scene, initial, {}, ())
        series.log_beginning(stream)
        self._say(stream, line, "INFO")
        self._log_motion(stream, Frames.gather(np.zeros(1), [initial], self._bodies.parked))

    def _show_tried(self, stream: Stream, tree: ExploredTree) -> None:
        """The path on which a search got farthest, as if it were carried out; objects move at the end of each action."""
        tried = farthest_path(tree)
        for step, closed in tried:
            self._actions += 1
            stream.at(self._seconds, self._actions)
            self._show_decision(stream, step)
            self._show_frames(stream, step, ())
            stream.at(self._seconds, self._actions)
            self._say(stream, narration.tried_line(step, self._scene, self._actions, closed), "WARN")
            self._show_page(stream, step, done=True)

    def _show_decision(self, stream: Stream, step: Step) -> None:
        decision_entities.log_decision(stream, self._scene, step)
        decision = PushDecision.of(step.decision)
        persistence_entities.log_persistence(stream, decision)
        series.log_decision(stream, decision)
        self._color(stream, step, step.before)
        self._say(stream, narration.decision_line(step, self._actions), "INFO")
        self._show_page(stream, step, done=False)

    def _show_frames(self, stream: Stream, step: Step, frames: Iterable[tuple[float, State]]) -> None:
        """Write the frames down in one piece, those before an interruption too."""
        times, states = [0.0], [step.before]
        try:
            for seconds, state in chain(frames, [(step.motion.duration, step.after)]):
                times.append(max(seconds, times[-1]))
                states.append(state)
        finally:
            moments = self._seconds + np.array(times)
            self._write_frames(stream, step, Frames.gather(moments, states, self._bodies.parked))
            self._seconds = float(moments[-1])

    def _write_frames(self, stream: Stream, step: Step, frames: Frames) -> None:
        self._log_motion(stream, frames)
        series.log_motion(stream, self._scene, PushDecision.of(step.decision).corridor, frames, self._actions)
        for frame in frames.falls:
            stream.at(float(frames.times[frame]), self._actions)
            self._color(stream, step, frames.states[frame])

    def _show_outcome(self, stream: Stream, step: Step) -> None:
        stream.at(self._seconds, self._actions)
        series.log_outcome(stream, step)
        level = "WARN" if narration.went_wrong(step, self._scene) else "INFO"
        self._say(stream, narration.outcome_line(step, self._scene, self._actions), level)
        self._show_page(stream, step, done=True)

    def _log_motion(self, stream: Stream, frames: Frames) -> None:
        object_entities.log_motion(stream, self._scene, frames, self._actions)
        arm_entities.log_motion(stream, self._arm, self._bodies, frames, self._actions)

    def _color(self, stream: Stream, step: Step, state: State) -> None:
        decision = PushDecision.of(step.decision)
        object_entities.log_colors(stream, self._scene, state, components_of(decision), decision.chosen)

    def _show_page(self, stream: Stream, step: Step, *, done: bool) -> None:
        page = narration.decision_page(step, self._scene, self._actions, done)
        stream.put(PAGE, rr.TextDocument(page, media_type="text/markdown"))

    def _say(self, stream: Stream, line: str, level: str) -> None:
        if level == "INFO":  # in the colour that the viewer's theme writes in
            stream.put(LOG, rr.TextLog(line, level=level))
        else:
            stream.put(WARNINGS, rr.TextLog(line, level=level, color=palette.RED_INK))


def _properties(spec: RunSpec) -> dict[str, str]:
    """What an episode is run with, as text."""
    named = {"variant": spec.variant_of("planner")}
    named |= {name: spec.name_of(name) for name in ("planner", "backend", "arm", "topology", "goal")}
    options = {f"{part}_{key}": str(value) for part, given in spec.options.items() for key, value in given.items()}
    versions = {f"version_{name}": version for name, version in versions_of(spec).items()}
    return {**named, "seed": str(spec.seed), **options, **versions}
