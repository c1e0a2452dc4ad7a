"""A class straight from a Python file, ``./mine.py:Mine``: a plugin before it is packaged."""

from __future__ import annotations

import sys
from hashlib import sha256
from pathlib import Path
from traceback import extract_tb
from types import ModuleType
from typing import Any

from phframe.core.errors import InputError, PluginError, UnknownNameError, error_text
from phframe.core.paths import user_path
from phframe.core.regular_file import read_regular_file
from phframe.registry.foreign import foreign_code


def is_file(spec: str) -> bool:
    """Whether a spec means a file rather than a registered name."""
    return _split(spec)[0].endswith(".py")


def load_from_file(spec: str, interface: type) -> Any:
    """The object that ``file.py:Name`` stands for. The same file gives the same object again, until it is edited.

    Args:
        spec: Path of the file and name in it.
        interface: What the classes to be listed are subclasses of, where the name does not exist.

    Raises:
        InputError: If there is no such file, or the spec names no class.
        UnknownNameError: If the file has no such name.
        PluginError: If the file cannot be run; with the line.
    """
    file, name = _split(spec)
    module = _run(user_path(file))
    with foreign_code(f"{file} cannot be looked at"):
        known = [key for key, value in vars(module).items() if _is_own(value, interface, module)]
        if not name:
            raise InputError(f"say which class of {file} is meant, such as {file}:{known[0] if known else 'Mine'}")
        if not hasattr(module, name):
            raise UnknownNameError(f"{interface.__name__} in {file}", name, known)
        return getattr(module, name)


def _split(spec: str) -> tuple[str, str]:
    file, _, name = spec.rpartition(":")
    return (spec, "") if spec.endswith(".py") else (file, name)


def _is_own(value: object, interface: type, module: ModuleType) -> bool:
    return isinstance(value, type) and issubclass(value, interface) and value.__module__ == module.__name__


def _run(path: Path) -> ModuleType:
    """The file as a module, under a name that no other file, and no other version of it, has."""
    try:
        source = read_regular_file(path)
    except OSError as error:
        raise InputError(f"cannot read {path}: {(error.strerror or str(error)).lower()}") from None
    name = f"phframe_file_{sha256(bytes(path.resolve()) + source).hexdigest()[:16]}"
    if name not in sys.modules:
        module = ModuleType(name)
        module.__file__ = str(path.resolve())
        sys.modules[name] = module  # before it runs: dataclasses look their own module up
        try:
            with foreign_code(str(path)):
                exec(compile(source, module.__file__, "exec"), vars(module))
        except BaseException as error:
            sys.modules.pop(name, None)
            if error.__cause__ is None or not isinstance(error, PluginError):
                raise
            raise PluginError(f"{_place(error.__cause__, path)}: {_what(error.__cause__)}") from error.__cause__
    return sys.modules[name]


def _place(error: BaseException, path: Path) -> str:
    if isinstance(error, SyntaxError) and error.lineno:
        return f"{error.filename}, line {error.lineno}"
    lines = [frame.lineno for frame in extract_tb(error.__traceback__) if frame.filename == str(path.resolve())]
    return f"{path}, line {lines[-1]}" if lines else str(path)


def _what(error: BaseException) -> str:
    return error.msg if isinstance(error, SyntaxError) else error_text(error)
