"""Films an episode off screen, whichever backend it runs in: the states it went through, drawn by MuJoCo."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from contextlib import closing
from itertools import chain
from pathlib import Path

import numpy as np

from phframe.core import Episode, NotInstalledError, RunSpec, Scene, State, Step
from phframe.core.files import check_writable
from phframe.pushing import PushDecision
from phframe.recorders.arm_bodies import bodies_of
from phframe.recorders.coloring import components_of
from phframe.recorders.film import Film, format_of
from phframe.recorders.frames import Frames
from phframe.recorders.opengl import find_opengl
from phframe.runtime.observer import MountedArm, Observer

STILL = 1.0
"""For how long the end is shown (s of the video)."""


class VideoRecorder(Observer):
    """Writes a video of the world's time, which is there when the episode is over; an interrupted one leaves none.

    The robot is drawn by its joints where the states have them, else as its outlines made solid. Objects have the
    colours of the recording for Rerun: the target amber, what belongs together alike, what fell red.

    Args:
        path: The file, ``.mp4`` or ``.webp``; a regular one that exists is replaced.

    Raises:
        InputError: If the file cannot be written, or nothing here can draw.
        NotInstalledError: If MuJoCo is not installed.
    """

    def __init__(self, path: Path) -> None:
        self.path, self._kind = path, format_of(path)
        check_writable(path)
        find_opengl()  # before mujoco is imported: it wants what the environment asks for
        try:
            from phframe.recorders.offscreen import require_drawing
        except ModuleNotFoundError as error:
            raise NotInstalledError("recorder 'video'", str(error.name), 'pip install "phframe[video]"') from error

        require_drawing()
        self._shooting: _Shooting | None = None

    def begin(self, scene: Scene, spec: RunSpec, arm: MountedArm) -> None:
        """Build the picture and show the scene as it begins.

        Raises:
            InputError: If the file cannot be written.
        """
        film = Film(self.path, self._kind)
        try:
            self._shooting = _Shooting(film, scene, arm)
        except BaseException:  # an interruption, too, leaves nothing
            film.close()
            raise
        self._shooting.show(0.0, [(0.0, scene.initial_state())], {}, scene.name)
        self._seconds, self._actions, self._over = 0.0, 0, False

    def stepped(self, step: Step, frames: Iterable[tuple[float, State]]) -> None:
        """Film an action."""
        if self._shooting is None:
            return
        self._actions += 1
        moments = chain(frames, [(step.motion.duration, step.after)])
        title = f"{self._actions}. {step.action.name}"
        self._shooting.show(self._seconds, moments, components_of(PushDecision.of(step.decision)), title)
        self._seconds += step.motion.duration

    def finished(self, episode: Episode) -> None:
        """Hold the last picture for a while, with how it ended.

        Raises:
            InputError: If the file cannot be written.
        """
        if self._shooting is not None:
            still = [(STILL * self._kind.speed, episode.final_state)]
            self._shooting.show(self._seconds, still, {}, str(episode.status))
            self._over = True

    def close(self) -> None:
        """Put the video in its place if the episode is over, else leave nothing.

        Raises:
            InputError: If the file cannot be written.
        """
        if self._shooting is not None:
            shooting, self._shooting = self._shooting, None
            shooting.close(keep=self._over)


class _Shooting:
    """A stage, somebody who draws it, and a film."""

    def __init__(self, film: Film, scene: Scene, arm: MountedArm) -> None:
        from phframe.recorders.offscreen import Offscreen
        from phframe.recorders.stage import Stage, camera

        width, height = film.kind.width, film.kind.height
        self._film, self._bodies, self._camera = film, bodies_of(arm, scene), camera(scene.shelf, arm.base_pose)
        self._stage = Stage(scene, self._bodies, width, height)
        self._screen = Offscreen(self._stage.model, width, height)
        self._next = 0.0

    def show(
        self, start: float, moments: Iterable[tuple[float, State]], components: Mapping[str, int], title: str
    ) -> None:
        """Draw every picture that is due by the last of the moments, each of the first moment at or after it.

        Args:
            start: Seconds of the world that the moments count from.
            moments: Seconds, and the world then.
            components: Of objects, by id.
            title: Of the pictures.
        """
        for seconds, state in moments:
            if self._next > start + seconds:
                continue
            frames = Frames.gather(np.zeros(1), [state], self._bodies.parked)
            arm = {name: poses[0] for name, poses in self._bodies.poses(frames).items()}
            self._stage.show(state, arm, components)
            while self._next <= start + seconds:
                caption = f"{title}\n{self._next:.1f} s", ""
                self._film.add(self._screen.draw(self._stage.data, self._camera, caption))
                self._next += self._film.kind.speed / self._film.kind.rate

    def close(self, *, keep: bool) -> None:
        self._screen.close()
        with closing(self._film) as film:
            if keep:
                film.finish()
