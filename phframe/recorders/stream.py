"""One recording file and its two timelines: the time in the world, and which action it is."""

from __future__ import annotations

import ctypes
import errno
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
import rerun_bindings

from phframe.core import FloatArray, InputError
from phframe.core.errors import error_text

APPLICATION = "phframe"
ROOM = 2**18
"""More than a recording begins with (bytes): how it is laid out."""
PATIENCE = 3.0
"""With a file that does not grow, though something is to be written to it (s)."""
TIME = "sim_time"
ACTION = "action"


class Stream:
    """A recording that is written to a file as it grows. No global recording is touched.

    Args:
        path: The file; one that exists is overwritten.
        name: What the viewer calls the recording.
        blueprint: How the viewer lays it out.
        properties: Shown with the recording.

    Raises:
        InputError: If the file cannot be written.
    """

    def __init__(self, path: Path, name: str, blueprint: rrb.Blueprint, properties: Mapping[str, str]) -> None:
        if (why := _refusal(path, "wb")) is not None:
            raise InputError(f"cannot write the recording {path}: {why}. Give a file in a directory that exists.")
        self._path, self._lost = path, False
        self._recording = rr.RecordingStream(APPLICATION)
        self._recording.set_log_time_enabled(False)
        self._recording.set_log_tick_enabled(False)
        _save(self._recording, path, blueprint)
        self._recording.send_recording_name(name)
        self._recording.send_property("setup", rr.AnyValues(drop_untyped_nones=True, **properties))

    def at(self, seconds: float, action: int) -> None:
        """Set the moment to which what is put next belongs."""
        self._recording.set_time(TIME, duration=seconds)
        self._recording.set_time(ACTION, sequence=action)

    def put(self, entity: str, *what: Any) -> None:
        """Write something down at the moment set last."""
        self._recording.log(entity, *what)

    def keep(self, entity: str, *what: Any) -> None:
        """Write something down that is true at every moment."""
        self._recording.log(entity, *what, static=True)

    def put_many(self, entity: str, seconds: FloatArray, action: int, columns: Iterable[rr.ComponentColumn]) -> None:
        """Write many moments ``(m,)`` of one action down at once: some thirty times faster than one by one."""
        times = rr.TimeColumn(TIME, duration=seconds)
        actions = rr.TimeColumn(ACTION, sequence=np.full(len(seconds), action))
        self._recording.send_columns(entity, [times, actions], columns)

    def flush(self) -> None:
        """Have everything so far written to the file.

        Raises:
            InputError: If it cannot be, as on a full disk.
        """
        written = -1
        while True:
            try:
                self._recording.flush(timeout_sec=PATIENCE)
            except (RuntimeError, ValueError) as error:
                before, written = written, _size(self._path)
                if written == before:  # what writes it has ended, and Rerun may wait for it for ever
                    self._lose()
                    raise self._failure(error) from None
            else:
                return

    def close(self) -> None:
        """Write the rest and end the file, and the threads that wrote it. Nothing can be put after that.

        Raises:
            InputError: If it could not be written.
        """
        if self._lost:
            return
        self.flush()
        self._recording.disconnect()
        del self._recording
        rerun_bindings.flush_and_cleanup_orphaned_recordings()  # else Rerun keeps the threads of what nobody refers to
        if not rerun_bindings.check_for_rrd_footer(str(self._path)):
            raise self._failure(None)

    def _lose(self) -> None:
        """Leave it as it is, also at the end of the process: Rerun may wait for ever where it lets go of one."""
        self._lost = True
        rr.unregister_shutdown()
        for each in (self._recording, self._recording.to_native()):
            ctypes.pythonapi.Py_IncRef(ctypes.py_object(each))

    def _failure(self, error: Exception | None) -> InputError:
        """Rerun says no more than that it stopped writing, if that; the system says why."""
        why = _refusal(self._path, "ab") or ("its end is missing" if error is None else error_text(error))
        return InputError(f"cannot write the recording {self._path}: {why}")


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0


def _refusal(path: Path, mode: str) -> str | None:
    """Why the system takes no more of a file, which is empty, or as it was, afterwards; None: it takes what Rerun begins with.

    Rerun itself does not come back from the beginning of a file for which there is no room.
    """
    try:
        with path.open(mode, buffering=0) as file:
            length = file.tell()
            try:
                room = file.write(bytes(ROOM))
            finally:
                file.truncate(length)
    except (OSError, ValueError) as error:
        return f"{getattr(error, 'strerror', None) or error}"
    return None if room == ROOM else os.strerror(errno.ENOSPC)


def _save(recording: rr.RecordingStream, path: Path, blueprint: rrb.Blueprint) -> None:
    """What ``recording.save(path, blueprint)`` does, which never lets go of the stream it makes for the blueprint.

    The blueprint's sink in memory and its stream refer to each other; to disconnect the stream parts them.
    """
    native = rerun_bindings.new_blueprint(
        application_id=APPLICATION, make_default=False, make_thread_default=False, default_enabled=True
    )
    stream = rr.RecordingStream._from_native(native)
    stream.set_time("blueprint", sequence=0)
    blueprint._log_to_stream(stream)
    memory = stream.memory_recording().storage
    rerun_bindings.save(path=str(path), default_blueprint=memory, recording=recording.to_native())
    stream.disconnect()
