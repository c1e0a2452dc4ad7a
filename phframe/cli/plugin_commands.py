"""Commands that plugins add. Where no plugin is installed this costs next to nothing."""

from __future__ import annotations

import os
from collections.abc import Collection
from importlib import metadata
from typing import TYPE_CHECKING, Any

import typer

from phframe.cli.console import release_output, results_only

if TYPE_CHECKING:
    from phframe.registry import Entry


def names(own: Collection[str]) -> list[str]:
    """What the plugins' commands are called; one that has the name of an own command, by ``distribution:name``."""
    return [entry.qualified_name if entry.name in own else entry.name for entry in _entries()]


def summary(name: str) -> Any:
    """A stand-in for a plugin's command that says what it does; None if there is no such command."""
    entry = _entry(name)
    return _as_command(lambda: None, name, entry.extension.summary) if entry else None


def load_command(name: str, own: Collection[str]) -> Any:
    """Import a plugin's command.

    Args:
        name: What it was asked for by.
        own: The names of phframe's own commands, for the error.

    Raises:
        UnknownNameError: If there is no such command.
        PluginError: If it does not load, or is neither a function nor a ``typer.Typer``.
    """
    from phframe.core.errors import PluginError, UnknownNameError
    from phframe.registry import Kind, load

    if _entry(name) is None:
        raise UnknownNameError("command", name, [*own, *names(own)], "See 'phframe --help'.")
    with results_only():
        loaded = load(Kind.COMMAND, name)
    if not callable(loaded):
        raise PluginError(f"command {name!r} is neither a function nor a typer.Typer")
    release_output()
    return _as_command(loaded, name)


def failure(name: str, error: Exception) -> Exception | None:
    """Who raised what, if a plugin's command raised an exception that is not meant to be told as it is; else None."""
    from phframe.core.errors import PhframeError, PluginError, error_text

    entry = _entry(name)
    meant = isinstance(error, PhframeError | BrokenPipeError | typer.Exit | typer.Abort) or hasattr(
        error, "format_message"
    )
    if entry is None or meant:
        return None
    return PluginError(f"command {name!r} of {entry.distribution} {entry.version} failed: {error_text(error)}")


def _entry(name: str) -> Entry | None:
    return next((each for each in _entries() if name in (each.name, each.qualified_name)), None)


def _entries() -> tuple[Entry, ...]:
    """The registered commands. The registry is imported only if there are plugins."""
    if os.environ.get("PHFRAME_PLUGINS", "all").strip() == "":
        return ()
    from phframe.core.distributions import with_plugins

    if not with_plugins(metadata.distributions()):
        return ()
    from phframe.core.errors import PhframeError
    from phframe.registry import Kind, catalogue

    try:
        return catalogue().extensions(Kind.COMMAND)
    except PhframeError:  # a broken plugin is told of by what needs it, not by the help
        return ()


def _as_command(loaded: Any, name: str, help_text: str | None = None) -> Any:
    if not isinstance(loaded, typer.Typer):
        app = typer.Typer(add_completion=False)
        app.command(name, help=help_text)(loaded)
        loaded = app
    command = typer.main.get_command(loaded)
    command.name = name
    return command
