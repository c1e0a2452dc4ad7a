"""The command ``phframe``. Importing this imports nothing but typer, so that ``--help`` is there at once."""

from __future__ import annotations

import os
from typing import Annotated

import typer

from phframe.cli import arm, bench, listings, scene
from phframe.cli.console import emit, reserve_output
from phframe.cli.exit_codes import ExitCode
from phframe.cli.export import export
from phframe.cli.group import CommandGroup, keep_output, show_help
from phframe.cli.replay import replay
from phframe.cli.report import report
from phframe.cli.scenes import scenes
from phframe.cli.solve import solve
from phframe.cli.supervised import SUPERVISED

app = typer.Typer(
    cls=CommandGroup,
    name="phframe",
    help="Retrieve an object from a crowded shelf by pushing, guided by persistent homology.",
    epilog="Example: phframe solve vieira/basic",
    invoke_without_command=True,
    pretty_exceptions_enable=False,
)
app.command("solve", epilog="Example: phframe solve papallas/s01 --planner ooa --option margin=0.02 --no-rerun --json")(
    solve
)
app.command("export", epilog="Example: phframe export vieira/basic --arm planar --out basic.xml")(export)
app.command("replay", epilog="Example: phframe replay runs/basic --backend mujoco")(replay)
app.command("report", epilog="Example: phframe report runs/paper --figures figures")(report)
app.command("scenes", epilog="Example: phframe scenes dense/9 --out dense.png")(scenes)
app.add_typer(bench.app, name="bench")
listings.add_to(app)
app.add_typer(arm.app, name="arm")
app.add_typer(scene.app, name="scene")
keep_output(app)


@app.callback()
def _top(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Show the version and exit.")] = False,
) -> None:
    if version:
        emit(_version())
        raise typer.Exit(ExitCode.SUCCESS)
    show_help(context)


def _version() -> str:
    from phframe.core.version import own_version

    return f"phframe {own_version()}"


def main() -> None:
    """Carry out what the command line asks for; ends the process. The command itself begins in ``entry``."""
    reserve_output()
    os.environ.setdefault("PYTHONSAFEPATH", "1")  # processes that are started import nothing from the working directory
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # it would ask every distribution for them
    os.environ.setdefault("RUST_LOG", "off")  # Rerun would tell of its troubles itself, in colours
    app(prog_name="phframe", obj=SUPERVISED)
