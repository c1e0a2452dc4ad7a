"""What ``phframe solve`` does: carry out a run, write its files, print the result."""

from __future__ import annotations

import json
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from phframe.cli.advice import terminal_advisor
from phframe.cli.console import emit, note, show
from phframe.cli.exit_codes import ExitCode
from phframe.cli.interrupt import dependable_interrupts
from phframe.cli.partial import PartialEpisode
from phframe.cli.progress import Progress
from phframe.cli.recording import RECORDING, RunFiles, VideoFile, recorder_type
from phframe.cli.run_directory import RUNS, RunDirectory
from phframe.core import Advisor, Episode, RunSpec
from phframe.recorders.view import open_viewer, require_viewer
from phframe.runtime.observer import Observer

EPISODE = "episode.json"
SUMMARY = "summary.json"


@dataclass(frozen=True, slots=True)
class RunOutput:
    """What a run is to leave and to print.

    Attributes:
        out: Directory for the files; None: a new one.
        record: Whether to write a recording; None: if the recorder is installed.
        video: The file of a video to make; None: none.
        view: Whether to open the viewer.
        as_json: Whether to print JSON.
        quiet: Whether to print errors only.
    """

    out: Path | None = None
    record: bool | None = None
    video: Path | None = None
    view: bool = False
    as_json: bool = False
    quiet: bool = False


def run(spec: RunSpec, report: RunOutput) -> int:
    """Carry out a run, and leave and print what is wanted of it.

    Returns:
        The exit code.

    Raises:
        PhframeError: If something asked for cannot be used; nothing was written then.
    """
    directory = RunDirectory(report.out)
    carried = carry_out(spec, report, directory)
    if carried is None:
        return ExitCode.INTERRUPTED
    episode, summary = carried
    if report.as_json:
        emit(json.dumps(summary, allow_nan=False))
    elif not report.quiet:
        from phframe.cli.result_table import result_table

        show(result_table(summary, directory.path))
    show_recording(report, directory)
    return ExitCode.SUCCESS if episode.status.is_success else ExitCode.OTHER_OUTCOME


def carry_out(
    spec: RunSpec, report: RunOutput, directory: RunDirectory, advisor: Advisor | None = None
) -> tuple[Episode, dict[str, Any]] | None:
    """Carry out a run and leave the files that are wanted.

    Args:
        spec: The run.
        report: What it is to leave and to print.
        directory: Where.
        advisor: Whom the planner may ask; None: whoever is at the terminal.

    Returns:
        The episode and its summary; None: it was interrupted, and that has been said.

    Raises:
        PhframeError: If something asked for cannot be used; nothing was written then.
    """
    if report.view:
        require_viewer((report.out or RUNS / "DIR") / RECORDING)
    files = RunFiles(directory, recorder_type(report.record, quiet=report.quiet))
    progress, partial = Progress(), PartialEpisode()
    videos = () if report.video is None else (VideoFile(report.video, progress.through),)
    try:
        with dependable_interrupts():
            asked = advisor or terminal_advisor(progress.aside)
            episode = _watched(spec, (partial, files, *videos), progress, asked, quiet=report.quiet)
            return episode, _write(episode, directory, files.recording)
    except KeyboardInterrupt:
        _tell_interrupted(partial, directory)
        return None
    finally:
        directory.discard_if_empty()


def show_recording(report: RunOutput, directory: RunDirectory) -> None:
    """Open the viewer, if that is wanted."""
    if report.view and directory.path is not None and (directory.path / RECORDING).exists():
        open_viewer(directory.path / RECORDING)


def _watched(
    spec: RunSpec, observers: Sequence[Observer], progress: Progress, advisor: Advisor, *, quiet: bool
) -> Episode:
    with ExitStack() as stack:
        for observer in (*observers, progress):
            stack.callback(observer.close)
        if not quiet:
            progress.start()
        from phframe.runtime.run import run  # the libraries take a second: progress tells of it

        stack.pop_all()  # it closes them
        return run(spec, (*observers, progress), advisor)


def _write(episode: Episode, directory: RunDirectory, recording: Path | None) -> dict[str, Any]:
    from phframe.core.files import write_file
    from phframe.runtime.files import save
    from phframe.runtime.summary import summarize

    summary = summarize(episode, recording)
    if not directory.keep:
        return summary
    folder = directory.path or directory.make(episode.scene.name, episode.spec.name_of("planner"))
    save(episode, folder / EPISODE)
    write_file(folder / SUMMARY, json.dumps(summary, allow_nan=False) + "\n")
    return summary


def _tell_interrupted(partial: PartialEpisode, directory: RunDirectory) -> None:
    """Keep what there is, and say where."""
    from phframe.runtime.files import save

    episode = partial.episode
    if episode is not None and directory.path is not None:
        save(episode, directory.path / EPISODE)
        note(f"interrupted; what was recorded is in {directory.path}")
    else:
        note("interrupted; nothing was recorded yet")
