"""What ``phframe solve`` does: check, solve, write the files, print the result."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from phframe.cli.console import emit, note, show
from phframe.cli.exit_codes import ExitCode
from phframe.cli.interrupt import dependable_interrupts
from phframe.cli.partial import PartialEpisode
from phframe.cli.progress import Progress
from phframe.cli.recording import RECORDING, RunFiles, VideoFile, recorder_type
from phframe.cli.request import Request
from phframe.cli.run_directory import RUNS, RunDirectory
from phframe.core import Episode, Status
from phframe.recorders.view import open_viewer, require_viewer
from phframe.runtime.observer import Observer

EPISODE = "episode.json"
SUMMARY = "summary.json"


def run(request: Request) -> int:
    """Solve a scene.

    Returns:
        The exit code.

    Raises:
        PhframeError: If something asked for cannot be used; nothing was written then.
    """
    directory = RunDirectory(request.out)
    if request.view:
        require_viewer((request.out or RUNS / "DIR") / RECORDING)
    files = RunFiles(directory, recorder_type(request.record, quiet=request.quiet))
    progress, partial = Progress(), PartialEpisode()
    videos = () if request.video is None else (VideoFile(request.video, progress.through),)
    try:
        with dependable_interrupts():
            episode = _solve(request, (partial, files, *videos), progress)
            summary = _write(episode, directory, files.recording)
    except KeyboardInterrupt:
        _tell_interrupted(partial, directory)
        return ExitCode.INTERRUPTED
    finally:
        directory.discard_if_empty()
    _print(summary, request, directory)
    if request.view and files.recording is not None:
        open_viewer(files.recording)
    return ExitCode.SUCCESS if episode.status is Status.RETRIEVED else ExitCode.OTHER_OUTCOME


def _solve(request: Request, observers: Sequence[Observer], progress: Progress) -> Episode:
    from phframe.runtime.solve import solve

    with ExitStack() as stack:
        for observer in (*observers, progress):
            stack.callback(observer.close)
        if not request.quiet:
            progress.start()
        return solve(
            request.scene,
            planner=request.planner,
            backend=request.backend,
            arm=request.arm,
            plan_backend=request.plan_backend,
            plan_arm=request.plan_arm,
            topology=request.topology,
            seed=request.seed,
            noise=request.noise,
            options=request.options,
            time_limit=request.time_limit,
            max_replans=request.max_replans,
            tolerance=request.tolerance,
            observers=(*observers, progress),
        )


def _write(episode: Episode, directory: RunDirectory, recording: Path | None) -> dict[str, Any]:
    from phframe.core.files import write_file
    from phframe.runtime.files import save
    from phframe.runtime.summary import summarize

    summary = summarize(episode, recording)
    folder = directory.path or directory.make(episode.scene.name, episode.setup.planner)
    save(episode, folder / EPISODE)
    write_file(folder / SUMMARY, _as_json(summary) + "\n")
    return summary


def _as_json(summary: Mapping[str, Any]) -> str:
    return json.dumps(summary, allow_nan=False)


def _print(summary: Mapping[str, Any], request: Request, directory: RunDirectory) -> None:
    if request.as_json:
        emit(_as_json(summary))
    elif not request.quiet:
        from phframe.cli.result_table import result_table

        show(result_table(summary, directory.path))


def _tell_interrupted(partial: PartialEpisode, directory: RunDirectory) -> None:
    """Keep what there is, and say where."""
    from phframe.runtime.files import save

    episode = partial.episode("interrupted by Ctrl-C")
    if episode is not None and directory.path is not None:
        save(episode, directory.path / EPISODE)
        note(f"interrupted; what was recorded is in {directory.path}")
    else:
        note("interrupted; nothing was recorded yet")
