"""The one hook: how phframe asks a plugin, and itself, what there is.

A plugin is a module with this function, named in the entry-point group ``phframe`` of its distribution::

    from phframe.registry import Extension, Kind, hookimpl

    @hookimpl
    def phframe_extensions() -> list[Extension]:
        return [Extension(Kind.PLANNER, "mine", "my_package.mine:Mine", "What it does, in a line", api_version=2)]
"""

from __future__ import annotations

import pluggy

from phframe.registry.extension import Extension

PROJECT = "phframe"
"""Name of the pluggy project, and of the entry-point group."""

hookspec = pluggy.HookspecMarker(PROJECT)
hookimpl = pluggy.HookimplMarker(PROJECT)


@hookspec
def phframe_extensions() -> list[Extension]:  # type: ignore[empty-body]
    """What the plugin offers."""
