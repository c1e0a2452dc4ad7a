"""The command group that is a command too: ``phframe bench paper`` is ``phframe bench run paper``."""

from __future__ import annotations

from typing import Any

from typer.core import TyperGroup

DEFAULT = "run"
"""The command that is meant where none is named."""
_HELP = ("--help",)


class BenchGroup(TyperGroup):
    """Commands, one of which is meant where the first word is none of them."""

    def with_default(self, args: list[str]) -> list[str]:
        """The words of a command line, beginning with a command."""
        named = not args or args[0] in self.commands or args[0] in _HELP
        return args if named else [DEFAULT, *args]

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Read the words, with the command that is meant."""
        return super().parse_args(ctx, self.with_default(args))

    def shell_complete(self, ctx: Any, incomplete: str) -> list[Any]:
        """What the shell offers: the commands, and what may follow the one that is meant."""
        command = self.commands[DEFAULT]
        with command.make_context(DEFAULT, [], parent=ctx, resilient_parsing=True) as inner:
            offers = command.shell_complete(inner, incomplete)
            if not incomplete.startswith("-"):
                offers += [each for param in command.params[:1] for each in param.shell_complete(inner, incomplete)]
        return [*super().shell_complete(ctx, incomplete), *offers]
