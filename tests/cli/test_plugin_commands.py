from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Install, Invoke

pytestmark = pytest.mark.usefixtures("plugin")

PLUGIN = """
@hookimpl
def phframe_extensions():
    return [
        Extension(Kind.COMMAND, "greet", "lab_commands:greet", "Greets the shelf", api_version=2),
        Extension(Kind.COMMAND, "many", "lab_commands:many", "Has commands of its own", api_version=2),
        Extension(Kind.COMMAND, "solve", "lab_commands:greet", "Has the name of one that there is", api_version=2),
        Extension(Kind.COMMAND, "useless", "lab_commands:useless", "Is no command", api_version=2),
        Extension(Kind.COMMAND, "absent", "lab_absent:it", "Is not there", api_version=2),
    ]
"""
COMMANDS = """
import typer

useless = 3
many = typer.Typer()

def greet(name: str = "shelf", code: int = 0):
    print(f"hello {name}")
    raise typer.Exit(code)

@many.command()
def first(count: int):
    print("first" * count)

@many.command()
def second():
    raise ValueError("oh")
"""


def test_the_help_names_them_without_importing_them(invoke: Invoke) -> None:
    result = invoke("--help")
    assert "Greets the shelf" in result.stdout
    assert "Has commands of its own" in result.stdout
    assert "lab_commands" not in sys.modules


def test_they_run_with_their_options_and_exit_codes(invoke: Invoke) -> None:
    result = invoke("greet", "--name", "you", "--code", "4")
    assert (result.exit_code, result.stdout) == (4, "hello you\n")
    assert invoke("many", "first", "2").stdout == "firstfirst\n"
    assert "--name" in invoke("greet", "--help").stdout


def test_a_built_in_command_wins_and_the_other_can_be_asked_for(invoke: Invoke) -> None:
    assert "Retrieve the target" in invoke("solve", "--help").stdout
    assert "lab-plugin:solve" in invoke("--help").stdout
    assert invoke("lab-plugin:solve").stdout == "hello shelf\n"


def test_what_goes_wrong_in_them_is_one_line(invoke: Invoke) -> None:
    for arguments, code, said in [
        (["many", "first", "x"], 2, "See 'phframe many first --help'"),
        (["many", "second"], 2, "command 'many' of lab-plugin 1.0 failed: ValueError: oh"),
        (["useless"], 2, "neither a function nor a typer.Typer"),
        (["absent"], 2, "does not load"),
        (["gret"], 2, "Did you mean 'greet'?"),
    ]:
        result = invoke(*arguments)
        assert (result.exit_code, result.stdout) == (code, "")
        assert said in result.stderr
        assert result.stderr.count("\n") == 1


@pytest.fixture
def plugin(install: Install, tmp_path: Path) -> None:
    """A distribution that offers commands, which are in a module of their own."""
    install("lab-plugin", PLUGIN)
    (tmp_path / "site" / "lab_commands.py").write_text(COMMANDS)
