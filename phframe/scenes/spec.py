"""How a scene is asked for: by ``suite/name``, or as a file."""

from __future__ import annotations

from pathlib import Path

_SUFFIXES = (".yaml", ".yml")
_STARTS = ("/", "./", "../", "~", ".\\", "..\\")


def is_file_spec(spec: str | Path) -> bool:
    """Whether a scene is asked for as a file rather than as ``suite/name``.

    A file is what ends in ``.yaml`` or ``.yml``, begins like a path (``/``, ``./``, ``../``, ``~``), or is a file that
    exists. Nothing is read.
    """
    if isinstance(spec, Path) or spec.lower().endswith(_SUFFIXES) or spec.startswith(_STARTS):
        return True
    try:
        return Path(spec).is_file()
    except (OSError, ValueError):  # too long, or a zero byte
        return False
