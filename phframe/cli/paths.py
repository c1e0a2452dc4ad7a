"""The type of every flag that names a file or directory."""

from __future__ import annotations

from pathlib import Path


def path(text: str | Path) -> Path:
    """What a flag stands for, a leading ``~`` expanded: also in ``--out=~/x``, which the shell leaves alone.

    Raises:
        InputError: If it cannot be a path.
    """
    from phframe.core.paths import user_path  # heavy, and seldom needed

    return user_path(text)
