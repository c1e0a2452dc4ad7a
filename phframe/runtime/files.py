"""Plans and episodes as files of JSON.

What a later phframe of the same format adds is passed over; what changes the meaning gets a new format number.
"""

from __future__ import annotations

import json
from collections.abc import Collection
from dataclasses import replace
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from phframe.core import Episode, InputError, Plan
from phframe.core.errors import error_text
from phframe.core.files import write_file
from phframe.core.paths import path_shown, user_path
from phframe.core.regular_file import read_regular_file
from phframe.core.run_spec import first_fault
from phframe.core.stored_json import parse_json
from phframe.runtime.adapters import adapter_of
from phframe.runtime.stored_episode import problem_of_episode

FORMAT = 2
"""Of the files; a file of another one is refused."""

MOST_BYTES = 256 << 20
"""Of a file that is read."""

_KINDS: dict[str, type[Plan] | type[Episode]] = {"plan": Plan, "episode": Episode}


def save(value: Plan | Episode, path: str | Path) -> Path:
    """Write a plan or an episode; what was there before stays until the new file is whole.

    Raises:
        InputError: If the file cannot be written, or an episode was run with an object instead of a name.
    """
    kind = next((name for name, cls in _KINDS.items() if isinstance(value, cls)), None)
    if kind is None:
        raise InputError(f"only a Plan or an Episode can be saved, not {value!r}")
    return write_file(user_path(path), json.dumps({"phframe": FORMAT, "kind": kind, kind: content_of(value)}))


def content_of(value: Plan | Episode, without: Collection[str] = ()) -> Any:
    """What a file holds of a plan or an episode; of large search trees that is a part.

    Args:
        value: The plan or the episode.
        without: Names of fields to leave out.

    Raises:
        InputError: If an episode was run with an object instead of a name.
    """
    if isinstance(value, Episode) and "spec" not in without:
        value.spec.to_json()  # refuses what cannot be stored, which a serializer would wrap
    return adapter_of(Episode if isinstance(value, Episode) else Plan).dump_python(
        _bounded(value), mode="json", exclude=set(without)
    )


def _bounded(value: Plan | Episode) -> Plan | Episode:
    """The same with search trees of no more nodes than a file holds: large ones are summarised."""
    if isinstance(value, Plan):
        return _bounded_plan(value)
    return replace(value, plans=tuple(map(_bounded_plan, value.plans)))


def _bounded_plan(plan: Plan) -> Plan:
    return plan if plan.tree is None else replace(plan, tree=plan.tree.summarised())


def load(path: str | Path) -> Plan | Episode:
    """Read what ``save`` wrote.

    Raises:
        InputError: If the file cannot be read, is of a newer format or is not a plan or an episode, or one that cannot be.
    """
    shown = path_shown(path)
    try:
        document = parse_json(_content(user_path(path), shown))
    except OSError as error:
        raise InputError(f"cannot read {shown}: {error.strerror}") from None
    except (ValueError, RecursionError, OverflowError) as error:
        raise InputError(f"{shown} is not JSON: {error}") from None
    decoded = _decoded(document, shown)
    if isinstance(decoded, Episode) and (problem := problem_of_episode(decoded)) is not None:
        raise InputError(f"{shown}: {problem}")
    return decoded


def _content(path: Path, shown: str) -> str:
    content = read_regular_file(path, MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise InputError(f"{shown} is larger than {MOST_BYTES >> 20} MB; that is no plan or episode")
    return content.decode()


def _decoded(document: Any, shown: str) -> Plan | Episode:
    kind = document.get("kind") if isinstance(document, dict) else None
    if not isinstance(kind, str) or kind not in _KINDS:
        raise InputError(f"{shown} is not a phframe plan or episode")
    if type(document.get("phframe")) is not int or document["phframe"] != FORMAT:
        raise InputError(f"{shown} is of format {document.get('phframe')!r:.40}; this phframe reads format {FORMAT}")
    try:
        decoded: Plan | Episode = adapter_of(Episode if kind == "episode" else Plan).validate_python(document.get(kind))
    except ValidationError as error:
        raise InputError(f"{shown}: {first_fault(error)} ({error.error_count()} problems in all)") from None
    except (InputError, ValueError, TypeError, OverflowError) as error:
        raise InputError(f"{shown}: {error_text(error)}") from None
    return decoded
