"""An episode recorded as a run does it."""

from __future__ import annotations

from pathlib import Path

from phframe.recorders.rerun_ import RerunRecorder
from tests.recorders.synthetic_episode import Recorded


def record(made: Recorded, path: Path) -> None:
    recorder, episode = RerunRecorder(path), made.episode
    recorder.begin(episode.scene, episode.spec, made.arm)
    recorder.planned(episode.plans[0])
    recorder.stepped(episode.steps[0], made.frames[0])
    recorder.planned(episode.plans[1])
    for step, frames in zip(episode.steps[1:], made.frames[1:], strict=True):
        recorder.stepped(step, iter(frames))
    recorder.finished(episode)
    recorder.close()
