"""The file of a recording: it grows with the episode, is ended whatever ends that, and what cannot be written is told."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("rerun")

import rerun as rr

from phframe.core import (
    InputError,
    State,
)
from phframe.recorders.rerun_ import RerunRecorder
from tests.recorders.reading import Recording
from tests.recorders.recorded import record
from tests.recorders.synthetic_episode import SCENE, SPEC, Recorded

pytestmark = pytest.mark.needs_rerun


def test_interrupted_action_keeps_the_frames_seen(made: Recorded, tmp_path: Path) -> None:
    def interrupted() -> Iterator[tuple[float, State]]:
        yield from made.frames[0][:60]
        raise KeyboardInterrupt

    recorder = RerunRecorder(tmp_path / "interrupted.rrd")
    recorder.begin(SCENE, SPEC, made.arm)
    recorder.planned(made.episode.plans[0])
    with pytest.raises(KeyboardInterrupt):
        recorder.stepped(made.episode.steps[0], interrupted())
    recorder.close()
    rows = Recording(recorder.path).rows("/world/arm/link", "translation")
    assert rows[-1][0] == pytest.approx(made.frames[0][59][0])


def test_file_grows_action_by_action(made: Recorded, tmp_path: Path) -> None:
    recorder = RerunRecorder(tmp_path / "growing.rrd")
    recorder.begin(SCENE, SPEC, made.arm)
    sizes = []
    for step, frames in zip(made.episode.steps, made.frames, strict=True):
        recorder.stepped(step, frames)
        sizes.append(recorder.path.stat().st_size)
    recorder.close()
    assert sizes == sorted(set(sizes))


def test_close_twice_and_before_the_beginning(made: Recorded, tmp_path: Path) -> None:
    recorder = RerunRecorder(tmp_path / "empty.rrd")
    recorder.close()
    recorder.stepped(made.episode.steps[0], made.frames[0])
    assert not recorder.path.exists(), "nothing is written before an episode begins"
    recorder.begin(SCENE, SPEC, made.arm)
    recorder.close()
    recorder.close()
    assert "/world/objects/mug" in Recording(recorder.path).entities


def test_unwritable_path_is_a_clear_error(made: Recorded, tmp_path: Path) -> None:
    recorder = RerunRecorder(tmp_path / "missing" / "episode.rrd")
    with pytest.raises(InputError, match=r"cannot write the recording .*missing.*No such file or directory"):
        recorder.begin(SCENE, SPEC, made.arm)
    recorder.close()


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="threads are counted as Linux lists them")
def test_no_thread_is_left_behind(made: Recorded, tmp_path: Path) -> None:
    def threads() -> int:
        return sum(1 for _ in Path("/proc/self/task").iterdir())

    def fail() -> None:
        with pytest.raises(InputError):
            record(made, tmp_path / "nowhere" / "episode.rrd")

    record(made, tmp_path / "first.rrd")  # which starts the threads that all recordings share
    before = threads()
    for number in range(5):
        record(made, tmp_path / f"{number}.rrd")
        fail()
    assert threads() <= before


def test_no_global_recording_is_touched(made: Recorded, tmp_path: Path) -> None:
    record(made, tmp_path / "one.rrd")
    assert rr.get_global_data_recording() is None
    assert rr.get_thread_local_data_recording() is None
