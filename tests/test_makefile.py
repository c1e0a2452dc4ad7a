"""The Makefile finds an interpreter that really runs, and says what to do when there is none."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
TOOLS = ("sh", "echo", "sed", "cat", "rm", "touch")

pytestmark = pytest.mark.skipif(shutil.which("make") is None, reason="make is not installed")


def can_make_environments() -> bool:
    """Whether the interpreter that runs the tests has ensurepip (Debian ships it separately)."""
    probe = subprocess.run([sys.executable, "-c", "import ensurepip, venv"], capture_output=True, check=False)
    return probe.returncode == 0


@pytest.fixture
def bin_folder(tmp_path: Path) -> Path:
    """A folder to be the whole PATH: the few tools that make needs, and no Python."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name in TOOLS:
        tool = shutil.which(name)
        assert tool is not None
        (folder / name).symlink_to(tool)
    return folder


def write_script(path: Path, body: str) -> Path:
    """An executable shell script, with the folders it lies in."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{body}\n", "utf-8")
    path.chmod(0o755)
    return path


def real_python(path: Path) -> Path:
    """A script that runs the interpreter of the tests."""
    return write_script(path, f'exec "{sys.executable}" "$@"')


def failing_shim(path: Path) -> Path:
    """What pyenv leaves behind for a version that is not selected."""
    return write_script(path, "echo 'pyenv: python3.11: command not found' >&2; exit 127")


def find_interpreter(bin_folder: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """`make interpreter` with that PATH and an empty home."""
    make = shutil.which("make")
    assert make is not None
    return subprocess.run(
        [make, "--silent", "--no-print-directory", "-C", str(ROOT), "interpreter"],
        env={"PATH": str(bin_folder), "HOME": str(bin_folder.parent), **environment},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


needs_ensurepip = pytest.mark.skipif(not can_make_environments(), reason="this Python has no ensurepip")
needs_python_311 = pytest.mark.skipif(sys.version_info[:2] != (3, 11), reason="needs CPython 3.11")


@needs_ensurepip
@needs_python_311
def test_python_311_is_preferred(bin_folder: Path) -> None:
    real_python(bin_folder / "python3.11")
    real_python(bin_folder / "python3")
    assert find_interpreter(bin_folder).stdout == "python3.11\n"


@needs_ensurepip
def test_failing_shim_is_passed_over(bin_folder: Path) -> None:
    failing_shim(bin_folder / "python3.11")
    real_python(bin_folder / "python3")
    assert find_interpreter(bin_folder).stdout == "python3\n"


@needs_ensurepip
@needs_python_311
def test_pyenv_version_is_found_without_its_shim(bin_folder: Path) -> None:
    failing_shim(bin_folder / "python3.11")
    python = real_python(bin_folder.parent / ".pyenv/versions/3.11.9/bin/python")
    assert find_interpreter(bin_folder).stdout == f"{python}\n"


@needs_ensurepip
def test_named_interpreter_comes_first_even_with_a_space_in_its_path(bin_folder: Path) -> None:
    real_python(bin_folder / "python3.11")
    named = real_python(bin_folder.parent / "my pythons" / "python")
    assert find_interpreter(bin_folder, PYTHON=str(named)).stdout == f"{named}\n"


@needs_ensurepip
def test_named_interpreter_that_does_not_fit_is_reported(bin_folder: Path) -> None:
    real_python(bin_folder / "python3")
    result = find_interpreter(bin_folder, PYTHON="/nowhere/python")
    assert result.stdout == "python3\n"
    assert "PYTHON=/nowhere/python" in result.stderr


def test_too_old_interpreter_is_refused_in_one_line_that_says_what_to_do(bin_folder: Path) -> None:
    old = f"""exec "{sys.executable}" -c "import sys; sys.version_info = (3, 10, 1); exec(sys.argv[2])" "$@" """
    write_script(bin_folder / "python3", old)
    result = find_interpreter(bin_folder)
    lines = [line for line in result.stderr.splitlines() if not line.startswith("make")]
    assert result.returncode != 0
    assert result.stdout == ""
    assert len(lines) == 1
    assert "install one" in lines[0]
    assert "PYTHON=" in lines[0]


def test_help_lists_every_target_that_is_meant_for_people(bin_folder: Path) -> None:
    make = shutil.which("make")
    assert make is not None
    result = subprocess.run(
        [make, "--no-print-directory", "-C", str(ROOT)],
        env={"PATH": str(bin_folder)}, capture_output=True, text=True, check=True,
    )  # fmt: skip
    listed = {line.split("\t")[0].strip() for line in result.stdout.splitlines()[1:]}
    assert listed == {
        "help", "demo", "test", "test-3d", "test-long", "trials", "mutants", "lint", "bench", "pictures", "clean",
    }  # fmt: skip


def recipe(target: str, *options: str) -> str:
    """What `make` would run for a target."""
    make = shutil.which("make")
    assert make is not None
    command = [make, "--dry-run", "--no-print-directory", "-C", str(ROOT), *options, target]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def test_the_core_is_tested_without_the_libraries_for_3d_and_the_rest_with_all_of_them() -> None:
    core, rest = recipe("test"), recipe("test-3d")
    assert "-p tests.without_3d" in core
    assert "tests.without_3d" not in rest
    selected = [re.search(r"-m '(not )?\(([a-z0-9_ ]+)\) and not long'", lines) for lines in (core, rest)]
    assert selected[0] is not None
    assert selected[1] is not None
    assert (selected[0][1], selected[1][1]) == ("not ", None)
    assert selected[0][2] == selected[1][2]
    demanded = re.search(r'bin/python -c "import (av.*)"', rest)
    assert demanded is not None
    assert set(demanded[1].split(", ")) == {"av", "mujoco", "ompl.base", "pinocchio", "toppra", "trimesh"}
    assert "__import__('pybullet')" in rest


def test_mutants_are_made_of_the_room_as_many_as_asked_for_and_by_the_seed() -> None:
    lines = recipe("mutants", "ROOM=pushing", "SAMPLE=7", "SEED=3", "--always-make")
    assert "-m tests.mutation.mutants pushing --sample 7 --seed 3" in lines
    assert ".[dev,mutation]" in lines


def test_plugins_are_installed_for_the_tests_and_not_for_the_demonstration() -> None:
    plugins = sorted(path.parent.relative_to(ROOT).as_posix() for path in ROOT.glob("plugins/*/pyproject.toml"))
    assert plugins
    for target in ("test", "test-3d", "lint"):
        installing = next(
            line for line in recipe(target, "--always-make").replace("\\\n", "").splitlines() if "--editable" in line
        )
        assert "--constraint constraints.txt" in installing
        assert re.findall(r"--editable \./(\S+)", installing) == plugins
    assert "plugins" not in recipe("demo", "--always-make")
    assert all(f"'{Path(plugin).name}'.split()" in recipe("test") for plugin in plugins)
