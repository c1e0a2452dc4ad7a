"""The commands that repeat a bench or one of its trials."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping
from typing import Any

from phframe.bench.settings import MEMORY_LIMIT, BenchSettings
from phframe.core import InputError, Loop, RunSpec
from phframe.core.variant import split_variant, variant_name

KEY_SHOWN = 12
"""Digits of a trial's key, of which the beginning is enough."""
_PARTS = ("backend", "arm", "plan_backend", "plan_arm", "topology", "goal")


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
    words += ["--trial-limit", f"{settings.trial_limit:g}"] if settings.trial_limit is not None else []
    return shlex.join([*words, "--out", out])


def replay_command(directory: str, key: str) -> str:
    """The ``phframe bench replay`` of a trial."""
    return shlex.join(["phframe", "bench", "replay", directory, key[:KEY_SHOWN]])


def solve_command(spec: str) -> str:
    """The ``phframe solve`` that does what a trial did; empty: its scene is no name, or its run cannot be read."""
    try:
        run = RunSpec.from_json(spec)
    except InputError:
        return ""
    if not isinstance(run.scene, str):
        return ""
    planner = variant_name(*_merged(run.planner, run.options.get("planner", {})))
    words = ["phframe", "solve", run.scene, "--planner", planner]
    words += _parts({name: getattr(run, name) for name in _PARTS}, RunSpec())
    words += _options(run.options, "planner")
    words += ["--seed", str(run.seed), *_loop(run.loop), *_noise(run.noise)]
    return shlex.join(map(str, words))


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
        for key in sorted(given) if part != left_out else ():
            text = variant_name("", {key: given[key]})[1:-1]
            yield from ("--option", f"{part}.{text}")


def _loop(loop: Loop) -> Iterator[str]:
    for name in ("time_limit", "max_replans", "tolerance", "simulations"):
        if getattr(loop, name) != getattr(Loop(), name):
            yield from (f"--{name.replace('_', '-')}", f"{getattr(loop, name):g}")


def _noise(noise: Mapping[str, float]) -> list[str]:
    return ["--noise", ",".join(f"{key}={value:g}" for key, value in sorted(noise.items()))] if noise else []
