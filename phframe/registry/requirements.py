"""Which libraries an extension lacks, read from its distribution's metadata, which alone says where wheels exist."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from phframe.core.metadata_fields import UNREADABLE, requirements_of, version_of
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
    for requirement in _requirements(distribution):
        if _belongs(requirement, extra) and not _is_installed(requirement.name):
            return Missing(requirement.name, _remedy(requirement, distribution, extra))
    return None


@cache
def required(distribution: str, extra: str | None = None) -> tuple[str, ...]:
    """The libraries that a distribution, or one extra of it, needs here: canonical names, installed or not.

    Found out once per process: reading requirements takes longer than planning some pushes.
    """
    from packaging.utils import canonicalize_name

    here = [each for each in _requirements(distribution) if _applies(each, extra)]
    return tuple(canonicalize_name(each.name) for each in here if _belongs(each, extra))


def _requirements(distribution: str) -> list[Requirement]:
    """What a distribution asks for; lines that are no requirements are left out."""
    from packaging.requirements import InvalidRequirement, Requirement  # seldom needed, and slow to import

    found = []
    for line in _lines(distribution):
        with suppress(InvalidRequirement):
            found.append(Requirement(line))
    return found


def _lines(distribution: str) -> Sequence[str]:
    try:
        return requirements_of(distribution)
    except Exception:  # noqa: BLE001 - there is none, or none that can be read: it asks for nothing
        return ()


def _applies(requirement: Requirement, extra: str | None) -> bool:
    """Whether it is asked for on this platform; one that compares what cannot be compared is not."""
    try:
        return requirement.marker is None or requirement.marker.evaluate({"extra": extra or ""})
    except ValueError:
        return False


def _belongs(requirement: Requirement, extra: str | None) -> bool:
    """Whether it is asked for by the extra, be it on this platform or not."""
    marker = str(requirement.marker or "")
    return f'extra == "{extra}"' in marker if extra else "extra ==" not in marker


def _is_installed(name: str) -> bool:
    if name == PROJECT:  # it is running, perhaps from its source tree
        return True
    try:
        return bool(version_of(name))
    except UNREADABLE:
        return False


def _remedy(requirement: Requirement, distribution: str, extra: str | None) -> str:
    if _applies(requirement, extra):
        return f'pip install "{distribution}[{extra}]"' if extra else f'pip install "{distribution}"'
    python = f"{platform.python_implementation()} {platform.python_version()}"
    return f"There is no wheel of it for {python} on {platform.system()} {platform.machine()}"
