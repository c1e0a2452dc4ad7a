"""Where the mesh files are that a URDF names: ``package://``, ``file://``, absolute and relative paths."""

from __future__ import annotations

import os
import sysconfig
from collections.abc import Iterator
from pathlib import Path

from phframe.core import ArmError
from phframe.yaml.wording import shown

PACKAGES = ("package://", "model://")
PATHS = ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH")


def find_mesh(name: str, folder: Path | None) -> Path:
    """The file that a URDF names.

    Args:
        name: As in the URDF.
        folder: The URDF's; None: it is a mere text.

    Raises:
        ArmError: If there is no such file; says where it was looked for.
    """
    found = next((path for path in _candidates(name, folder) if _is_there(path)), None)
    if found is None:
        raise ArmError(f"the mesh {shown(name)} of the URDF is not there; looked {_where(name, folder)}")
    return found.absolute()


def _is_there(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):  # a name that no file can have
        return False


def _where(name: str, folder: Path | None) -> str:
    if Path(name.removeprefix("file://")).is_absolute():
        return "there only"
    above = (
        "nowhere, since the URDF is not a file" if folder is None else f"in {folder.absolute()} and every folder above"
    )
    if not name.startswith(PACKAGES):
        return above
    paths = (f"{path} ({os.environ.get(path) or 'not set'})" for path in PATHS)
    return ", in ".join([above, *paths, str(_installed())])


def _candidates(name: str, folder: Path | None) -> Iterator[Path]:
    above = [] if folder is None else [folder.absolute(), *folder.absolute().parents]
    if not name.startswith(PACKAGES):
        path = Path(name.removeprefix("file://"))
        yield from [path] if path.is_absolute() else [each / path for each in above]
        return
    package, _, rest = name.partition("://")[2].partition("/")
    for place in (*above, *_package_folders()):
        if place.name == package:
            yield place / rest
        yield place / package / rest


def _package_folders() -> Iterator[Path]:
    """Where ROS looks for packages, and where pip puts them."""
    for place in (Path(each) for path in PATHS for each in os.environ.get(path, "").split(os.pathsep) if each):
        yield place
        yield place / "share"
    yield _installed()


def _installed() -> Path:
    """Where pip puts the packages of robots."""
    return Path(sysconfig.get_path("purelib")) / "cmeel.prefix" / "share"
