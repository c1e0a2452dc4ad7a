"""The commands that repeat a bench or one of its trials."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from typing import Any

from phframe.bench.settings import MEMORY_LIMIT, BenchSettings
from phframe.core import InputError, Loop, RunSpec
from phframe.core.run_spec import PARTS
from phframe.core.variant import split_variant, value_text
from phframe.registry.from_file import is_file

KEY_SHOWN = 12
"""Digits of a trial's key, of which the beginning is enough."""
_PARTS = tuple(part for part in PARTS if part != "planner")


def bench_command(settings: BenchSettings, out: str) -> str:
    """The ``phframe bench`` that runs the same trials."""
    words = ["phframe", "bench", *settings.suites]
    for planner in settings.planners:
        words += ["--planner", planner]
    words += _parts({name: getattr(settings, name) for name in _PARTS}, BenchSettings(("",)))
    words += _options(settings.options, "")
    words += ["--seeds", str(settings.seeds)] if settings.seeds != 1 else []
    words += [*_loop(settings.loop), *_noise(settings.noise)]
    words += ["--memory-limit", str(settings.memory_limit)] if settings.memory_limit != MEMORY_LIMIT else []
    words += ["--trial-limit", value_text(settings.trial_limit)] if settings.trial_limit is not None else []
    return shlex.join([*words, "--out", out])


def replay_command(directory: str, key: str, spec: str) -> str:
    """The ``phframe bench replay`` of a trial; it names the parts that are classes in files, which are not run unasked."""
    words = ["phframe", "bench", "replay", directory, key[:KEY_SHOWN]]
    run = _run(spec)
    named = {} if run is None else {part: getattr(run, part) for part in PARTS}
    for part, name in named.items():
        words += [f"--{part.replace('_', '-')}", name] if name is not None and is_file(name) else []
    return shlex.join(words)


def solve_command(spec: str) -> str:
    """The ``phframe solve`` that does what a trial did; empty: its scene is no name, or its run cannot be read."""
    run = _run(spec)
    if run is None or not isinstance(run.scene, str):
        return ""
    name, options = _merged(run.planner, run.options.get("planner", {}))
    inside = ",".join(_assigned(options))
    words = ["phframe", "solve", run.scene, "--planner", f"{name}[{inside}]" if inside else name]
    words += _parts({name: getattr(run, name) for name in _PARTS}, RunSpec())
    words += _options(run.options, "planner")
    words += ["--seed", str(run.seed), *_loop(run.loop), *_noise(run.noise)]
    return shlex.join(map(str, words))


def _run(spec: str) -> RunSpec | None:
    try:
        return RunSpec.from_json(spec)
    except InputError:
        return None


def _merged(name: str, options: Mapping[str, Any]) -> tuple[str, Mapping[str, Any]]:
    bare, given = split_variant(name)
    return bare, {**given, **options}


def _parts(given: Mapping[str, Any], default: Any) -> list[str]:
    """The flags of the parts that are not the default, and of what is planned in unless it follows from the rest."""
    words = []
    for part, name in given.items():
        usual = given["arm"] if part == "plan_arm" else getattr(default, part)
        if part == "plan_backend" and given["backend"] == default.backend:
            usual = default.backend
        if name is not None and name != usual:
            words += [f"--{part.replace('_', '-')}", name]
    return words


def _options(options: Mapping[str, Mapping[str, Any]], left_out: str) -> Iterator[str]:
    for part, given in sorted(options.items()):
        for text in _assigned(given) if part != left_out else ():
            yield from ("--option", f"{part}.{text}")


def _assigned(options: Mapping[str, Any]) -> list[str]:
    return [f"{key}={value_text(value)}" for key, value in sorted(options.items())]


def _loop(loop: Loop) -> Iterator[str]:
    for name in ("time_limit", "max_replans", "tolerance", "simulations"):
        if getattr(loop, name) != getattr(Loop(), name):
            yield from (f"--{name.replace('_', '-')}", value_text(getattr(loop, name)))


def _noise(noise: Mapping[str, float]) -> list[str]:
    return ["--noise", ",".join(_assigned(noise))] if noise else []
