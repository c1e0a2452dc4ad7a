from __future__ import annotations

import os
import subprocess
import sys

from tests.cli.conftest import ROOT, Invoke

HEAVY = (
    "numpy",
    "pydantic",
    "pluggy",
    "scipy",
    "ripser",
    "pymunk",
    "rerun",
    "ruamel",
    "phframe.core",
    "phframe.registry",
)


def test_help_imports_nothing_heavy() -> None:
    script = (
        "import sys; from phframe.cli.main import app\n"
        "try: app(['--help'], prog_name='phframe')\n"
        f"finally: print([name for name in {HEAVY!r} if name in sys.modules], file=sys.stderr)"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PHFRAME_PLUGINS": ""}
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, check=True, env=environment, timeout=60
    )
    assert done.stderr.strip() == "[]"
    assert "solve" in done.stdout


def test_every_command_and_option_says_what_it_is(invoke: Invoke) -> None:
    top = invoke("--help").stdout
    for name in ("solve", "export", "scenes", "planners", "backends", "arms", "topology"):
        assert name in top
        help_text = invoke(name, "--help").stdout
        assert "Example: phframe" in help_text
    assert "Example: phframe solve vieira/basic" in top
    for group, name in (("arm", "reach"), ("scene", "import")):
        assert name in invoke(group, "--help").stdout
        assert f"Example: phframe {group} {name}" in invoke(group, name, "--help").stdout


def test_solve_help_gives_units_and_defaults(invoke: Invoke) -> None:
    help_text = " ".join(invoke("solve", "--help").stdout.replace("│", " ").split())
    for part in (
        "[default: phia]",
        "[default: vieira/basic]",
        "wall time, s",
        "[default: 300.0]",
        "a new one in runs/",
    ):
        assert part in help_text


def test_no_command_shows_the_help_and_is_no_success(invoke: Invoke) -> None:
    result = invoke()
    assert result.exit_code == 2
    assert "solve" in result.stdout


def test_version(invoke: Invoke) -> None:
    result = invoke("--version")
    assert result.exit_code == 0
    assert result.stdout.startswith("phframe")
