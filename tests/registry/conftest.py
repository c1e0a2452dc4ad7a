"""Real distributions, installed into a folder of their own on the path."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from importlib import metadata
from itertools import count
from pathlib import Path
from textwrap import dedent

import pytest

from phframe.registry import Catalogue, discover

HEADER = "from phframe.registry import Extension, Kind, hookimpl\n"
SERIAL = count()

Install = Callable[..., str]
Discover = Callable[..., Catalogue]


@pytest.fixture
def site(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty folder that packages can be installed into."""
    folder = tmp_path / "site"
    folder.mkdir()
    monkeypatch.syspath_prepend(str(folder))
    before = set(sys.modules)
    yield folder
    for name in set(sys.modules) - before:
        if name.startswith(("plugin_", "phframe_file_")):
            del sys.modules[name]


@pytest.fixture
def install(site: Path) -> Install:
    """Install a distribution with one plugin module; returns the module's name, which is new every time."""

    def install(name: str, source: str, *, version: str = "1.0", requires: tuple[str, ...] = ()) -> str:
        module = f"plugin_{next(SERIAL)}"
        (site / f"{module}.py").write_text(HEADER + dedent(source).replace("MODULE", module), encoding="utf-8")
        info = site / f"{name.replace('-', '_')}-{version}.dist-info"
        info.mkdir()
        metadata_lines = ["Metadata-Version: 2.1", f"Name: {name}", f"Version: {version}"]
        metadata_lines += [f"Requires-Dist: {line}" for line in requires]
        (info / "METADATA").write_text("\n".join(metadata_lines) + "\n", encoding="utf-8")
        (info / "entry_points.txt").write_text(f"[phframe]\nplugin = {module}\n", encoding="utf-8")
        return module

    return install


@pytest.fixture
def found(site: Path) -> Discover:
    """Discover the built-ins and what was installed here, and nothing else."""

    def found(**settings: object) -> Catalogue:
        return discover(metadata.distributions(path=[str(site)]), **settings)  # type: ignore[arg-type]

    return found


def offering(*names: str, kind: str = "planner", **more: object) -> str:
    """Source of a plugin that offers planners, all of the class ``Straight`` that it defines."""
    more = {"api_version": 2, **more}
    extra = "".join(f", {key}={value!r}" for key, value in more.items())
    lines = [f"Extension(Kind({kind!r}), {name!r}, 'MODULE:Straight', 'A test'{extra})," for name in names]
    return f"{STRAIGHT}\n@hookimpl\ndef phframe_extensions():\n    return [{' '.join(lines)}]\n"


STRAIGHT = """
from phframe.core import Options, Plan, Planner, Status

class Choice(Options):
    tries: int = 3

class Straight(Planner[Choice]):
    options_type = Choice

    def search(self, task):
        return Plan(Status.FAILED, "not made for this")
"""
