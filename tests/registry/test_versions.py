"""Versions are those of the distributions used, of what they ask for, and of what the libraries of an extra use."""

from __future__ import annotations

import platform
from importlib import metadata
from pathlib import Path

import pytest

from phframe.registry import Catalogue, Entry, Extension, Kind, versions


def distribution(site: Path, name: str, version: str, *requires: str) -> None:
    info = site / f"{name.replace('-', '_')}-{version}.dist-info"
    info.mkdir()
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {name}",
        f"Version: {version}",
        *(f"Requires-Dist: {each}" for each in requires),
    ]
    (info / "METADATA").write_text("\n".join(lines) + "\n")


@pytest.fixture
def lab(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Catalogue:
    """A plugin that asks for a library, and with extras for others."""
    distribution(
        tmp_path,
        "lab",
        "3.1",
        "Lab_Base",
        'lab-arm; extra == "arm"',
        'lab-way; extra == "way"',
        'lab-off; extra == "off"',
    )
    for name, requires in {"lab-base": (), "lab-arm": ("lab-deep", "lab-absent"), "lab-way": (), "lab-off": ()}.items():
        distribution(tmp_path, name, "1.0", *requires)
    distribution(tmp_path, "lab-deep", "2.0", "lab-deeper")
    distribution(tmp_path, "lab-deeper", "2.0")
    monkeypatch.syspath_prepend(str(tmp_path))
    arm = Extension(Kind.ARM, "lab-arm", "lab:Arm", "An arm", extra="arm", uses=("way",))
    return Catalogue((Entry(arm, "lab", "3.1", "lab-arm"),))


def test_a_plugin_and_what_it_uses_are_named(lab: Catalogue) -> None:
    found = versions([(Kind.ARM, "lab-arm")], lab)
    assert {name: version for name, version in found.items() if name.startswith("lab")} == {
        "lab": "3.1",
        "lab-base": "1.0",
        "lab-arm": "1.0",
        "lab-deep": "2.0",
        "lab-way": "1.0",
    }


def test_phframe_and_what_it_asks_for_are_always_named(lab: Catalogue) -> None:
    found = versions([(Kind.PLANNER, "./mine.py:Mine")], lab)
    assert found["python"] == platform.python_version()
    assert {"phframe", "numpy", "pymunk", "ripser", "scipy"} <= set(found)
    assert all(found[name] == metadata.version(name) for name in ("numpy", "pymunk"))
    assert not {"lab", "mujoco", "pytest"} & set(found)


@pytest.mark.needs_baxter
@pytest.mark.needs_mujoco
def test_baxter_in_mujoco_names_what_moves_it() -> None:
    for name in ("mujoco", "pinocchio", "coal", "ompl.base", "toppra"):
        pytest.importorskip(name)
    found = versions([(Kind.BACKEND, "mujoco"), (Kind.ARM, "baxter")])
    assert {"mujoco", "pin", "coal", "ompl", "toppra"} <= set(found)
