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
from phframe.cli.limits_told import LimitsTold
from phframe.cli.partial import PartialEpisode
from phframe.cli.progress import Progress
from phframe.cli.recording import RECORDING, RunFiles, VideoFile, recorder_type
from phframe.cli.run_directory import RUNS, RunDirectory
from phframe.cli.supervised import WatchdogLink
from phframe.core import Advisor, Episode, RunSpec
from phframe.recorders.view import open_viewer, require_viewer
from phframe.runtime.audience import ObserverError
from phframe.runtime.observer import Observer

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


@dataclass(frozen=True, slots=True)
class Carried:
    """A run that was carried out to its end.

    Attributes:
        episode: What came of it.
        summary: The same in one flat object.
        failure: Of what looked on, such as the recorder; None: none.
    """

    episode: Episode
    summary: dict[str, Any]
    failure: ObserverError | None


def run(spec: RunSpec, report: RunOutput, link: WatchdogLink) -> int:
    """Carry out a run, and leave and print what is wanted of it.

    Args:
        spec: The run.
        report: What is wanted.
        link: To the watchdog.

    Returns:
        The exit code.

    Raises:
        PhframeError: If something asked for cannot be used; nothing was written then. Or if a part of the run failed.
    """
    directory = RunDirectory(report.out)
    carried = carry_out(spec, report, directory, link=link)
    if carried is None:
        return ExitCode.INTERRUPTED
    if report.as_json:
        emit(json.dumps(carried.summary, allow_nan=False))
    elif not report.quiet:
        from phframe.cli.result_table import result_table

        show(result_table(carried.summary, directory.path))
    if carried.failure is not None:
        raise carried.failure
    show_recording(report, directory)
    return ExitCode.SUCCESS if carried.episode.status.is_success else ExitCode.OTHER_OUTCOME


def carry_out(
    spec: RunSpec,
    report: RunOutput,
    directory: RunDirectory,
    advisor: Advisor | None = None,
    link: WatchdogLink = WatchdogLink(),  # noqa: B008 - without a pipe it holds nothing
) -> Carried | None:
    """Carry out a run and leave the files that are wanted.

    Args:
        spec: The run.
        report: What it is to leave and to print.
        directory: Where.
        advisor: Whom the planner may ask; None: whoever is at the terminal.
        link: To the watchdog.

    Returns:
        What came of it; None: it was interrupted, and that has been said.

    Raises:
        PhframeError: If something asked for cannot be used; nothing was written then. Or if a part of the run failed;
            what there is of the episode was written, and the error says where.
    """
    if report.view:
        require_viewer((report.out or RUNS / "DIR") / RECORDING)
    files = RunFiles(directory, recorder_type(report.record, quiet=report.quiet), link.folder)
    progress, partial, limits = Progress(), PartialEpisode(directory), LimitsTold(link)
    videos = () if report.video is None else (VideoFile(report.video, progress.through),)
    if report.video is not None:
        link.video(report.video)
    observers = (limits, files, partial, *videos)
    try:
        asked = advisor or terminal_advisor(limits.stopping(progress.aside))
        episode, failure = _watched(spec, observers, progress, asked, quiet=report.quiet)
        return Carried(episode, _write(episode, directory, files.recording, partial), failure)
    except KeyboardInterrupt:
        _tell_interrupted(partial, directory)
        return None
    except Exception as error:
        if partial.kept:
            error.add_note(f"what was done until then is in {directory.path}")
        raise
    finally:
        directory.discard_if_empty()


def show_recording(report: RunOutput, directory: RunDirectory) -> None:
    """Open the viewer, if that is wanted."""
    if report.view and directory.path is not None and (directory.path / RECORDING).exists():
        open_viewer(directory.path / RECORDING)


def _watched(
    spec: RunSpec, observers: Sequence[Observer], progress: Progress, advisor: Advisor, *, quiet: bool
) -> tuple[Episode, ObserverError | None]:
    with ExitStack() as stack:
        for observer in (*observers, progress):
            stack.callback(observer.close)
        if not quiet:
            progress.start()
        from phframe.runtime.run import run  # the libraries take a second: progress tells of it

        stack.pop_all()  # it closes them
        try:
            return run(spec, (*observers, progress), advisor), None
        except ObserverError as error:
            return error.episode, error


def _write(
    episode: Episode, directory: RunDirectory, recording: Path | None, partial: PartialEpisode
) -> dict[str, Any]:
    from phframe.core.files import write_file
    from phframe.runtime.summary import summarize

    summary = summarize(episode, recording)
    if not directory.keep:
        return summary
    folder = directory.path or directory.make(episode.scene.name, episode.spec.name_of("planner"))
    partial.save(episode)
    write_file(folder / SUMMARY, json.dumps(summary, allow_nan=False) + "\n")
    return summary


def _tell_interrupted(partial: PartialEpisode, directory: RunDirectory) -> None:
    """Say where what there is is kept."""
    if partial.episode is not None and directory.path is not None:
        note(f"interrupted; what was recorded is in {directory.path}")
    else:
        note("interrupted; nothing was recorded yet")
