"""Writes pictures to a video file, which appears when it is whole."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

import av
import numpy as np
from numpy.typing import NDArray

from phframe.core import InputError
from phframe.core.files import NewFile


@dataclass(frozen=True, slots=True)
class VideoFormat:
    """What a kind of file holds.

    Attributes:
        container: As FFmpeg calls it.
        codec: As FFmpeg calls it.
        width: Of the pictures (pixels).
        height: Of the pictures (pixels).
        rate: Pictures per second of the video.
        speed: Seconds of the world per second of the video.
        encoding: Of the codec.
        writing: Of the container.
    """

    container: str
    codec: str
    width: int
    height: int
    rate: int
    speed: float = 1.0
    encoding: Mapping[str, str] = field(default_factory=dict)
    writing: Mapping[str, str] = field(default_factory=dict)


FORMATS: Mapping[str, VideoFormat] = MappingProxyType(
    {
        ".mp4": VideoFormat(
            "mp4",
            "libx264",
            960,
            540,
            25,
            encoding={"crf": "21", "preset": "veryfast"},
            writing={"movflags": "faststart"},
        ),
        ".webp": VideoFormat(
            "webp", "libwebp_anim", 720, 404, 12, 3.0, encoding={"quality": "70"}, writing={"loop": "0"}
        ),
    }
)
"""By the file's ending: a video, and a small moving picture for a page, quicker than the world."""


def format_of(path: Path) -> VideoFormat:
    """What a file is to hold, by its ending.

    Raises:
        InputError: If there is no such kind.
    """
    try:
        return FORMATS[path.suffix.lower()]
    except KeyError:
        endings = " or ".join(FORMATS)
        raise InputError(f"cannot write the video {path}: give a file that ends in {endings}.") from None


class Film:
    """A video that is being written. It lies beside its place under another name until it is whole.

    Args:
        path: The file; a regular one that exists is replaced.
        kind: What it holds.

    Raises:
        InputError: If it cannot be written.
    """

    def __init__(self, path: Path, kind: VideoFormat) -> None:
        self.path, self.kind = path, kind
        self._pictures, self._file = 0, NewFile(path)
        try:
            self._container = av.open(str(self._file.part), "w", format=kind.container, options=dict(kind.writing))
            self._stream = self._container.add_stream(kind.codec, rate=kind.rate, options=dict(kind.encoding))
        except BaseException as error:  # an interruption, too, leaves nothing
            self._file.close()
            if isinstance(error, OSError | ValueError):
                raise _unwritable(path, error) from None
            raise
        self._stream.width, self._stream.height, self._stream.pix_fmt = kind.width, kind.height, "yuv420p"

    def add(self, picture: NDArray[np.uint8]) -> None:
        """The next picture, ``(height, width, 3)`` red, green and blue.

        Raises:
            InputError: If it cannot be written.
        """
        frame = av.VideoFrame.from_ndarray(picture, format="rgb24")
        frame.pts = self._pictures
        self._pictures += 1
        self._write(frame)

    def finish(self) -> None:
        """End the video and put it in its place.

        Raises:
            InputError: If it cannot be written.
        """
        self._write(None)
        try:
            self._container.close()
        except OSError as error:
            raise _unwritable(self.path, error) from None
        self._file.put()

    def close(self) -> None:
        """Leave nothing, unless it is finished. May be called twice."""
        with suppress(OSError, ValueError):
            self._container.close()
        self._file.close()

    def _write(self, frame: av.VideoFrame | None) -> None:
        try:
            self._container.mux(self._stream.encode(frame))
        except (OSError, ValueError) as error:
            raise _unwritable(self.path, error) from None


def _unwritable(path: Path, error: Exception) -> InputError:
    why = getattr(error, "strerror", None) or " ".join(str(error).split())
    return InputError(f"cannot write the video {path}: {why}")
