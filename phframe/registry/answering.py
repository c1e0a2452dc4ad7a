"""The process in which a distribution is asked what it offers: its code runs here, and not in the process that asks."""

from __future__ import annotations

import os
import signal
import sys
import sysconfig
from collections.abc import Iterable, Mapping
from importlib.metadata import EntryPoint
from itertools import islice
from typing import Any

import pluggy

from phframe.core.errors import PluginError, error_text
from phframe.core.process_limits import limit_process
from phframe.registry import hookspec
from phframe.registry.answer import MOST_EXTENSIONS, MOST_NAMES, Answer, to_json
from phframe.registry.extension import Extension

_MOST_FILES = 2000


def main(request: Mapping[str, Any]) -> None:
    """Ask the plugins of one distribution, write what they answer, and end this process.

    Args:
        request: ``hooks``, as in ``PluginDistribution``, or ``suite``, a suite of scenes as ``module:Class``; ``answer``, the
            file to write; ``memory`` (bytes) and ``seconds`` that this may take.
    """
    _limit(request["memory"], request["seconds"])
    before = set(sys.modules)
    try:
        if suite := request.get("suite"):
            answer = Answer(names=_scene_names(_loaded(suite)))
        else:
            extensions = tuple(each for hook in request["hooks"] for each in ask(_loaded(hook)))
            answer = Answer(_few(extensions), files=_files(before))
    except BaseException as error:  # noqa: BLE001 - whatever it does, it is told
        answer = Answer(error=_told(error, request["memory"]), files=_files(before))
    _write(request["answer"], to_json(answer))
    os._exit(0)  # whatever threads it started, and whatever it wants to do at the end


def ask(plugin: object) -> list[Extension]:
    """What one plugin offers. It has a pluggy manager of its own: in a shared one, one error would silence all.

    Raises:
        PluginError: If it has no hook, or that returns no list of extensions.
    """
    manager = pluggy.PluginManager(hookspec.PROJECT)
    manager.add_hookspecs(hookspec)
    manager.register(plugin)
    manager.check_pending()
    if not manager.hook.phframe_extensions.get_hookimpls():
        raise PluginError("it has no function phframe_extensions() marked with @hookimpl")
    answers = manager.hook.phframe_extensions()
    answer = answers[0] if answers else None
    if not isinstance(answer, list):
        raise PluginError(f"phframe_extensions() returned a {type(answer).__name__}, not a list of Extension")
    for extension in answer[: MOST_EXTENSIONS + 1]:
        if not isinstance(extension, Extension):
            raise PluginError(f"phframe_extensions() returned {extension!r} among its extensions")
    return answer


def _loaded(hook: str) -> object:
    return EntryPoint("plugin", hook, hookspec.PROJECT).load()


def _scene_names(suite: Any) -> tuple[str, ...]:
    names = tuple(islice(suite(suite.options_type()).names(), MOST_NAMES + 1))
    if len(names) > MOST_NAMES:
        raise PluginError(f"it lists more than {MOST_NAMES} scenes")
    return names


def _few(extensions: tuple[Extension, ...]) -> tuple[Extension, ...]:
    if len(extensions) > MOST_EXTENSIONS:
        raise PluginError(f"it offers {len(extensions)} extensions; one distribution may offer {MOST_EXTENSIONS}")
    return extensions


def _told(error: BaseException, memory: int) -> str:
    if isinstance(error, MemoryError):
        return f"it asked for more memory than the {memory >> 20} MB that it may have"
    return error_text(error)


def _files(before: Iterable[str]) -> tuple[str, ...]:
    """The files of the modules that have been imported since, without those of Python and of phframe."""
    own = (sysconfig.get_path("stdlib"), os.path.dirname(os.path.dirname(__file__)))  # noqa: PTH120 - quicker
    modules = [sys.modules.get(name) for name in set(sys.modules) - set(before)]
    files = {file for each in modules if isinstance(file := getattr(each, "__file__", None), str)}
    foreign = (file for file in files if not file.startswith(own) or "-packages" in file)
    return tuple(sorted(foreign)[:_MOST_FILES])


def _write(path: str, text: str) -> None:
    """Write a file that is there whole or not at all."""
    with open(f"{path}.part", "w", encoding="ascii") as file:  # noqa: PTH123 - whatever became of pathlib here
        file.write(text)
    os.replace(f"{path}.part", path)  # noqa: PTH105


def _limit(memory: int, seconds: float) -> None:
    """End this process in time even if the one that asks is gone, and bound its memory."""
    most = int(2 * seconds) + 1
    if hasattr(signal, "alarm"):
        signal.alarm(most)
    limit_process(RLIMIT_CORE=0, RLIMIT_CPU=most, RLIMIT_DATA=memory)
