"""Finds out where trials run: versions, code, machine."""

from __future__ import annotations

import hashlib
import os
import platform
import subprocess
from collections.abc import Iterable, Iterator
from importlib.util import find_spec
from pathlib import Path

import phframe
from phframe.bench.environment import Environment
from phframe.core import RunSpec
from phframe.core.distributions import HOME
from phframe.core.run_spec import PARTS
from phframe.core.variant import split_variant
from phframe.registry import Kind, look_up
from phframe.registry.from_file import is_file
from phframe.runtime.versions import CPU, versions_of

_ROOT = Path(phframe.__file__).parent
_NO_SAY = (
    *(f"{folder}/" for folder in ("cli", "recorders", "testing")),
    *(f"bench/{what}" for what in ("report/", "export/", "meters/", "schedulers/", "merge", "statistics", "summary")),
)
"""How the names of phframe's files begin that change no result."""
_LENGTH = 16


def surroundings(specs: Iterable[RunSpec]) -> Environment:
    """Where runs are carried out by this process and its children."""
    specs = list(specs)
    versions = {name: version for spec in specs for name, version in versions_of(spec).items() if name != CPU}
    return Environment(
        dict(sorted(versions.items())),
        _commit(),
        {HOME: _digest(_own_files()), **dict(sorted(_foreign_code(specs)))},
        f"{platform.system()} {platform.release()}",
        _cpu(),
        _cores(),
        _memory(),
    )


def _own_files() -> list[Path]:
    return [path for path in code_files(_ROOT) if not path.relative_to(_ROOT).as_posix().startswith(_NO_SAY)]


def code_files(package: Path) -> list[Path]:
    """The files of a package that may change results: its code and its data, without what Python keeps of the code.

    Args:
        package: Its directory.
    """
    files = [path.relative_to(package).as_posix() for path in package.rglob("*") if path.is_file()]
    return [package / name for name in sorted(files) if "__pycache__/" not in name and not name.endswith(".pyc")]


def _foreign_code(specs: Iterable[RunSpec]) -> Iterator[tuple[str, str]]:
    """Digests of the files that parts come from, and of the packages of plugins, by what they are called."""
    parts = {(Kind(part.removeprefix("plan_")), getattr(spec, part)) for spec in specs for part in PARTS}
    for kind, text in parts:
        name = split_variant(text)[0] if isinstance(text, str) else ""
        if is_file(name):
            file = name.rpartition(":")[0]
            yield file, _digest([Path(file).expanduser()])
        elif name and (entry := look_up(kind, name)) and entry.distribution != HOME:
            yield entry.distribution, _digest(_package(entry.extension.target))


def _package(target: str) -> list[Path]:
    """The files of the package that a target is in."""
    found = find_spec(target.partition(":")[0].partition(".")[0])
    if found is None or found.origin is None:
        return []
    origin = Path(found.origin)
    return code_files(origin.parent) if origin.name == "__init__.py" else [origin]


def _digest(files: Iterable[Path]) -> str:
    content = hashlib.sha256()
    for file in files:
        content.update(f"{file.name}\0".encode() + file.read_bytes())
    return content.hexdigest()[:_LENGTH]


def _commit() -> str:
    """Of the source tree that phframe is run from; empty: it is installed."""
    if not (_ROOT.parent / ".git").exists():
        return ""
    commit, changes = (_git(*words) for words in (("rev-parse", "HEAD"), ("status", "--porcelain", "-uno", "phframe")))
    return f"{commit}{'+' if commit and changes else ''}"


def _git(*words: str) -> str:
    try:
        command = ["git", "-C", str(_ROOT.parent), *words]
        return subprocess.run(command, capture_output=True, text=True, timeout=60, check=True).stdout.strip()
    except (OSError, subprocess.SubprocessError):
        return ""


def _cpu() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, platform.machine())


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 0


def _memory() -> int:
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2**20
    except (ValueError, OSError, AttributeError):
        return 0
