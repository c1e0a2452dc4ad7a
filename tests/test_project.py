"""The project's own files agree with one another, and the package ships what it needs."""

import ast
import functools
import re
import tomllib
import zipfile
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from ruamel.yaml import YAML

ROOT = Path(__file__).resolve().parent.parent
ENGINES = {
    "fast",
    "rerun",
    "mujoco",
    "pybullet",
    "ompl",
    "baxter",
    "meshes",
    "video",
    "plots",
    "parquet",
    "cluster",
    "report",
}


@functools.cache
def project() -> dict[str, Any]:
    """The project table of pyproject.toml."""
    table: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    return table


def citation() -> dict[str, Any]:
    """CITATION.cff."""
    data: dict[str, Any] = YAML(typ="safe", pure=True).load(ROOT / "CITATION.cff")
    return data


def requirements(extra: str | None = None) -> list[Requirement]:
    """What phframe needs, by default or with an extra."""
    lines = project()["dependencies"] if extra is None else project()["optional-dependencies"][extra]
    return [Requirement(line) for line in lines]


def constraints() -> dict[str, str]:
    """Name to version, from constraints.txt."""
    lines = (ROOT / "constraints.txt").read_text("utf-8").splitlines()
    pairs = [line.split("==") for line in lines if line and not line.startswith("#")]
    return dict(pairs)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    """The wheel that users install, built from the tree."""
    from hatchling.builders.wheel import WheelBuilder

    folder = tmp_path_factory.mktemp("wheel")
    (path,) = WheelBuilder(str(ROOT)).build(directory=str(folder), versions=["standard"])
    return zipfile.ZipFile(path)


def test_version_is_the_same_everywhere() -> None:
    import phframe

    assert phframe.__version__ == project()["version"]
    assert citation()["version"] == project()["version"]


def test_changelog_has_a_section_to_add_to_and_one_per_release() -> None:
    text = (ROOT / "CHANGELOG.md").read_text("utf-8")
    sections = re.findall(r"^## \[(.+?)\]", text, flags=re.MULTILINE)
    assert sections[0] == "Unreleased"
    assert all(re.fullmatch(r"\d+\.\d+\.\d+", section) for section in sections[1:])


def test_citation_names_the_paper() -> None:
    (paper,) = citation()["references"]
    assert paper["title"] == "Persistent Homology for Effective Non-Prehensile Manipulation"
    assert [author["family-names"] for author in paper["authors"]] == [
        "Vieira", "Nakhimovich", "Gao", "Wang", "Yu", "Bekris",
    ]  # fmt: skip
    assert citation()["license"] == project()["license"] == "MIT"


def test_wheel_ships_types_data_licence_and_command(wheel: zipfile.ZipFile) -> None:
    names = set(wheel.namelist())
    data = [path for path in (ROOT / "phframe").rglob("*") if path.suffix in {".py", ".yaml", ".html", ".typed"}]
    assert {path.relative_to(ROOT).as_posix() for path in data} <= names
    assert "phframe/py.typed" in names
    assert any(name.endswith("/licenses/LICENSE") for name in names)
    assert not any(name.startswith(("tests/", ".ci/")) for name in names)


def test_command_is_installed_and_its_function_exists() -> None:
    (command,) = entry_points(group="console_scripts", name="phframe")
    assert command.value == project()["scripts"]["phframe"]
    assert callable(command.load())


def test_all_means_every_engine() -> None:
    (everything,) = requirements("all")
    assert everything.extras == ENGINES
    assert set(project()["optional-dependencies"]) == ENGINES | {"all", "dev", "mutation"}


@pytest.mark.parametrize("extra", [None, "dev", "mutation", *sorted(ENGINES)])
def test_constraints_meet_each_requirement(extra: str | None) -> None:
    pinned = constraints()
    for requirement in requirements(extra):
        version = pinned[canonicalize_name(requirement.name)]
        assert requirement.specifier.contains(version), f"{requirement} against {version}"


def test_constraints_are_plain_names_and_versions_in_order() -> None:
    text = (ROOT / "constraints.txt").read_text("utf-8")
    for block in text.split("\n\n"):
        lines = [line for line in block.splitlines() if not line.startswith("#")]
        assert lines == sorted(lines)
        assert all(re.fullmatch(r"[a-z0-9-]+==[0-9][0-9a-z.]*", line) for line in lines), lines


@pytest.mark.parametrize(
    ("extra", "library", "environment", "available"),
    [
        (
            "pybullet",
            "pybullet",
            {"sys_platform": "linux", "platform_machine": "x86_64", "python_version": "3.11"},
            True,
        ),
        (
            "pybullet",
            "pybullet",
            {"sys_platform": "linux", "platform_machine": "x86_64", "python_version": "3.12"},
            False,
        ),
        (
            "pybullet",
            "pybullet",
            {"sys_platform": "linux", "platform_machine": "aarch64", "python_version": "3.11"},
            False,
        ),
        (
            "pybullet",
            "pybullet",
            {"sys_platform": "win32", "platform_machine": "AMD64", "python_version": "3.11"},
            False,
        ),
        (
            "ompl",
            "ompl",
            {"sys_platform": "linux", "python_version": "3.13", "platform_version": "#1 SMP Debian"},
            True,
        ),
        (
            "ompl",
            "ompl",
            {"sys_platform": "linux", "python_version": "3.14", "platform_version": "#1 SMP Debian"},
            False,
        ),
        ("ompl", "ompl", {"sys_platform": "darwin", "platform_version": "Darwin Kernel Version 24.1.0: Thu"}, True),
        ("ompl", "ompl", {"sys_platform": "darwin", "platform_version": "Darwin Kernel Version 23.6.0: Mon"}, False),
        ("ompl", "ompl", {"sys_platform": "win32", "platform_version": "10.0.22631"}, False),
        ("baxter", "pin", {"sys_platform": "darwin", "platform_machine": "x86_64"}, True),
        ("baxter", "pin", {"sys_platform": "win32", "platform_machine": "AMD64"}, False),
        ("baxter", "toppra", {"sys_platform": "linux", "platform_machine": "x86_64"}, True),
        ("baxter", "toppra", {"sys_platform": "linux", "platform_machine": "aarch64"}, False),
        ("baxter", "toppra", {"sys_platform": "darwin", "platform_machine": "arm64"}, False),
        ("mujoco", "mujoco", {"sys_platform": "darwin", "platform_machine": "arm64"}, True),
        ("mujoco", "mujoco", {"sys_platform": "darwin", "platform_machine": "x86_64"}, False),
        ("fast", "numba", {"sys_platform": "darwin", "platform_machine": "arm64"}, True),
        ("fast", "numba", {"sys_platform": "darwin", "platform_machine": "x86_64"}, False),
        ("rerun", "rerun-sdk", {"sys_platform": "win32", "platform_machine": "AMD64"}, True),
        ("rerun", "rerun-sdk", {"sys_platform": "darwin", "platform_machine": "x86_64"}, False),
    ],
)
def test_extra_is_left_out_where_its_engine_has_no_wheel(
    extra: str, library: str, environment: dict[str, str], *, available: bool
) -> None:
    (marker,) = [each.marker for each in requirements(extra) if each.name == library]
    assert marker is not None
    here = {"python_version": "3.11", "implementation_name": "cpython"}
    assert marker.evaluate({**here, **environment}) is available


def test_what_mutants_are_made_of_and_the_tests_that_are_to_notice_them_exist() -> None:
    rooms = tomllib.loads((ROOT / "tests/mutation/rooms.toml").read_text("utf-8"))["rooms"]
    assert rooms
    for room in rooms.values():
        assert all(list((ROOT / path).glob("**/*.py")) or (ROOT / path).is_file() for path in room["code"])
        assert all(list((ROOT / path).glob("**/test_*.py")) or (ROOT / path).is_file() for path in room["tests"])


def test_every_part_of_the_package_is_described_to_contributors() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    parts = {path.parent.name for path in (ROOT / "phframe").glob("*/__init__.py")}
    assert parts
    assert {part for part in parts if f"`{part}`" not in text} == set()


def test_no_module_is_longer_than_400_lines() -> None:
    lengths = {path: len(path.read_text("utf-8").splitlines()) for path in (ROOT / "phframe").rglob("*.py")}
    assert {path.name: lines for path, lines in lengths.items() if lines > 400} == {}


def test_every_module_says_what_it_is() -> None:
    modules = list((ROOT / "phframe").rglob("*.py"))
    assert modules
    assert [path for path in modules if not ast.get_docstring(ast.parse(path.read_text("utf-8")))] == []


def test_every_class_has_a_name_of_its_own() -> None:
    homes: dict[str, list[str]] = {}
    for path in sorted((ROOT / "phframe").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ClassDef):
                homes.setdefault(node.name, []).append(str(path.relative_to(ROOT)))
    assert {name: paths for name, paths in homes.items() if len(paths) > 1} == {}
