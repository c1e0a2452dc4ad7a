"""Which libraries an extension lacks, read from its distribution's metadata, which alone says where wheels exist."""

from __future__ import annotations

import platform
from dataclasses import dataclass
from functools import cache
from importlib import metadata
from typing import TYPE_CHECKING

from phframe.registry.hookspec import PROJECT

if TYPE_CHECKING:
    from packaging.requirements import Requirement


@dataclass(frozen=True, slots=True)
class Missing:
    """A library that is not installed.

    Attributes:
        library: Its name.
        remedy: The line that installs it, or why nothing can.
    """

    library: str
    remedy: str


def missing(distribution: str, extra: str | None) -> Missing | None:
    """The first library that is not installed though a distribution, or one extra of it, needs it.

    Args:
        distribution: Its name. One that has no metadata here needs nothing.
        extra: The extra; None asks for what the distribution itself needs.
    """
    from packaging.requirements import Requirement  # seldom needed, and slow to import

    try:
        requirements = [Requirement(line) for line in metadata.requires(distribution) or ()]
    except metadata.PackageNotFoundError:
        return None
    for requirement in requirements:
        if _belongs(requirement, extra) and not _is_installed(requirement.name):
            return Missing(requirement.name, _remedy(requirement, distribution, extra))
    return None


@cache
def required(distribution: str, extra: str | None = None) -> tuple[str, ...]:
    """The libraries that a distribution, or one extra of it, needs here: canonical names, installed or not.

    Found out once per process: reading requirements takes longer than planning some pushes.
    """
    from packaging.requirements import Requirement
    from packaging.utils import canonicalize_name

    try:
        requirements = [Requirement(line) for line in metadata.requires(distribution) or ()]
    except metadata.PackageNotFoundError:
        return ()
    here = [each for each in requirements if each.marker is None or each.marker.evaluate({"extra": extra or ""})]
    return tuple(canonicalize_name(each.name) for each in here if _belongs(each, extra))


def _belongs(requirement: Requirement, extra: str | None) -> bool:
    """Whether it is asked for by the extra, be it on this platform or not."""
    marker = str(requirement.marker or "")
    return f'extra == "{extra}"' in marker if extra else "extra ==" not in marker


def _is_installed(name: str) -> bool:
    if name == PROJECT:  # it is running, perhaps from its source tree
        return True
    try:
        return bool(metadata.version(name))
    except metadata.PackageNotFoundError:
        return False


def _remedy(requirement: Requirement, distribution: str, extra: str | None) -> str:
    if requirement.marker is None or requirement.marker.evaluate({"extra": extra or ""}):
        return f'pip install "{distribution}[{extra}]"' if extra else f'pip install "{distribution}"'
    python = f"{platform.python_implementation()} {platform.python_version()}"
    return f"There is no wheel of it for {python} on {platform.system()} {platform.machine()}"
