"""What a run leaves: the recording in its directory, made when the episode begins, and a video where it is wanted."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from phframe.cli.console import note
from phframe.cli.run_directory import RunDirectory
from phframe.core import Episode, Plan, RunSpec, Scene, Step
from phframe.core.errors import NotInstalledError, PluginError
from phframe.runtime.observer import Frames, MountedArm, Observer

RECORDING = "recording.rrd"
RecorderType = Callable[[Path], Observer]


class RunFiles(Observer):
    """Makes the run's directory when the episode begins, and hands everything on to a recorder in it.

    Args:
        directory: Where.
        recorder_type: Given a file, the recorder that writes it; None: nothing is recorded.
        made: Is told of the directory once it is there.
    """

    title = "the recording"

    def __init__(
        self,
        directory: RunDirectory,
        recorder_type: RecorderType | None,
        made: Callable[[Path], None] = lambda path: None,
    ) -> None:
        self._directory, self._recorder_type, self._made = directory, recorder_type, made
        self._recorder: Observer | None = None
        self.recording: Path | None = None

    def begin(self, scene: Scene, spec: RunSpec, arm: MountedArm) -> None:
        """Make the directory, and the recording in it.

        Raises:
            InputError: If they cannot be written.
        """
        if not self._directory.keep:
            return
        path = self._directory.make(scene.name, spec.name_of("planner"))
        self._made(path)
        if self._recorder_type is not None:
            self._recorder = self._recorder_type(path / RECORDING)
            self.recording = path / RECORDING
            self._hand_on(lambda recorder: recorder.begin(scene, spec, arm))

    def planned(self, plan: Plan) -> None:
        """Hand it on."""
        self._hand_on(lambda recorder: recorder.planned(plan))

    def stepped(self, step: Step, frames: Frames) -> None:
        """Hand it on."""
        self._hand_on(lambda recorder: recorder.stepped(step, frames))

    def finished(self, episode: Episode) -> None:
        """Hand it on."""
        self._hand_on(lambda recorder: recorder.finished(episode))

    def close(self) -> None:
        """End the recording."""
        self._hand_on(lambda recorder: recorder.close())

    def _hand_on(self, what: Callable[[Observer], None]) -> None:
        """Of a recording that fails nothing is left: half of it shows another run, and the episode may need its room."""
        if self._recorder is None:
            return
        try:
            what(self._recorder)
        except Exception:
            recorder, recording = self._recorder, self.recording
            self._recorder = self.recording = None
            with suppress(Exception):
                recorder.close()
            if recording is not None:
                with suppress(OSError):
                    recording.unlink()
            raise


class VideoFile(Observer):
    """Hands everything on to the recorder that films, and shows how far it is.

    Args:
        path: The file.
        through: Hands on the frames that it is given, and shows how many.

    Raises:
        NotInstalledError: If a library that it needs is not installed.
        InputError: If the file cannot be written, or nothing here can draw.
    """

    title = "the video"

    def __init__(self, path: Path, through: Callable[[Frames], Frames]) -> None:
        from phframe.registry import Kind, load

        self._recorder: Observer = load(Kind.RECORDER, "video")(path)
        self._through = through

    def begin(self, scene: Scene, spec: RunSpec, arm: MountedArm) -> None:
        """Hand it on."""
        self._recorder.begin(scene, spec, arm)

    def stepped(self, step: Step, frames: Frames) -> None:
        """Hand it on, and show how far it is."""
        self._recorder.stepped(step, self._through(frames))

    def finished(self, episode: Episode) -> None:
        """Hand it on."""
        self._recorder.finished(episode)

    def close(self) -> None:
        """Put the video in its place, or leave nothing."""
        self._recorder.close()


def recorder_type(wanted: bool | None, *, quiet: bool) -> RecorderType | None:
    """The recorder to use.

    Args:
        wanted: None: if it is installed, else with a hint.
        quiet: Without a hint.

    Raises:
        NotInstalledError: If it is wanted and not installed.
        PluginError: If it is wanted and does not load.
    """
    from phframe.registry import Kind, load

    if wanted is False:
        return None
    try:
        loaded: RecorderType = load(Kind.RECORDER, "rerun")
    except (NotInstalledError, PluginError) as error:
        if wanted:
            raise
        if not quiet:
            note(f"hint: nothing is recorded: {' '.join(str(error).split())} (--no-rerun leaves this hint out)")
        return None
    return loaded
