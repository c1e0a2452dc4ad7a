"""The top of the command tree: one line per error, and the commands that plugins add."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup

from phframe.cli import plugin_commands
from phframe.cli.console import note, results_only
from phframe.cli.exit_codes import ExitCode
from phframe.cli.failures import report


@contextmanager
def _told_if_interrupted() -> Iterator[None]:
    """A KeyboardInterrupt as a line and an exit code; the option parser makes of it what it likes otherwise."""
    try:
        yield
    except KeyboardInterrupt:
        note("interrupted")
        raise typer.Exit(ExitCode.INTERRUPTED) from None


class CommandGroup(TyperGroup):
    """The commands of phframe and of its plugins.

    A plugin's command is imported only when it is run; the help shows its registered summary.
    """

    def main(self, args: Sequence[str] | None = None, *rest: Any, standalone_mode: bool = True, **extra: Any) -> Any:
        """Run a command and, standing alone, end the process with its exit code."""
        extra["standalone_mode"] = False
        if not standalone_mode:
            return super().main(args, *rest, **extra)
        try:
            result = super().main(args, *rest, **extra)
        except (KeyboardInterrupt, typer.Abort):
            note("interrupted")
            result = ExitCode.INTERRUPTED
        except SystemExit:
            raise
        except BaseException as error:  # noqa: BLE001 - nobody is to see a traceback
            result = report(error)
        sys.exit(result if isinstance(result, int) else ExitCode.SUCCESS)

    def make_context(self, *args: Any, **extra: Any) -> Any:
        """Read the command line; say so if that was interrupted."""
        with _told_if_interrupted():
            return super().make_context(*args, **extra)

    def invoke(self, ctx: Any) -> Any:
        """Run a command; say so if it was interrupted, or if it is a plugin's and went wrong."""
        try:
            with _told_if_interrupted():
                return super().invoke(ctx)
        except typer.Exit:
            raise
        except Exception as error:
            if ctx.invoked_subcommand in self.commands:
                raise
            if (told := plugin_commands.failure(ctx.invoked_subcommand or "", error)) is None:
                raise
            raise told from error

    def list_commands(self, ctx: Any) -> list[str]:
        """The names of all commands: phframe's own, then those of plugins."""
        own = super().list_commands(ctx)
        return [*own, *plugin_commands.names(own)]

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """The command of a name; of a plugin's, no more than its summary."""
        return super().get_command(ctx, cmd_name) or plugin_commands.summary(cmd_name)

    def resolve_command(self, ctx: Any, args: list[str]) -> tuple[str | None, Any, list[str]]:
        """The command that is to be run, a plugin's too.

        Raises:
            UnknownNameError: If there is no such command.
        """
        name = args[0]
        if name in self.commands or name.startswith("-"):
            return super().resolve_command(ctx, args)
        if ctx.resilient_parsing:  # after Tab: no plugin's code is run
            command = plugin_commands.summary(name)
            return name if command else None, command, args[1:]
        return name, plugin_commands.load_command(name, self.commands), args[1:]


class Command(TyperCommand):
    """A command of phframe: while it runs, what a plugin or a library prints is no part of its result."""

    def invoke(self, ctx: Any) -> Any:
        """Run it."""
        with results_only():
            return super().invoke(ctx)


def keep_output(app: typer.Typer) -> None:
    """Have all commands of an application, and of its groups, be of the class ``Command``."""
    for command in app.registered_commands:
        command.cls = Command
    for group in app.registered_groups:
        if group.typer_instance is not None:
            keep_output(group.typer_instance)


def show_help(context: typer.Context) -> None:
    """Show the help of a group of commands that is given none of them, which is no success."""
    if context.invoked_subcommand is None:
        typer.echo(context.get_help())
        raise typer.Exit(ExitCode.BAD_INPUT)
