"""The commands in a report are understood and run the same again."""

from __future__ import annotations

import shlex
from typing import Any

import pytest
import typer
from hypothesis import given
from hypothesis import strategies as st

from phframe.bench.report.commands import bench_command, replay_command, solve_command
from phframe.bench.settings import BenchSettings
from phframe.cli.main import app
from phframe.cli.options import parse_options
from phframe.core import Loop, RunSpec
from phframe.core.run_spec import PARTS as PARTS_OF_A_RUN
from phframe.core.variant import split_variant
from phframe.runtime.noise import Noise

PARTS = ("backend", "arm", "plan_backend", "plan_arm", "topology", "goal")
RUNS = [
    RunSpec(),
    RunSpec("random/12", "ooa", options={"planner": {"margin": 0.02}, "scenes": {"count": 12}}, seed=3),
    RunSpec("papallas/s01", backend="mujoco", arm="baxter", plan_backend="mujoco", plan_arm="planar"),
    RunSpec("papallas/s01", backend="mujoco", arm="planar", plan_backend="pymunk", plan_arm="planar"),
    RunSpec(loop=Loop(3, 0.02, 60.0, 500), noise={"position": 0.005, "friction": 0.3}, topology="single-linkage"),
    RunSpec("./a b.yaml", planner="./my planner.py:Mine"),
    RunSpec(
        "near/0",
        loop=Loop(1000000, 0.0123456789, 1234567.5, 1234567),
        noise={"position": 0.00123456789},
        options={"planner": {"margin": 0.0123456789, "text": "x" * 60}, "arm": {"name": "y" * 60}},
    ),
]


def read(command: str) -> dict[str, Any]:
    """What a command line gives its command."""
    top: Any = typer.main.get_command(app)
    words = shlex.split(command)
    assert words.pop(0) == "phframe"
    group = top.commands[words[0]]
    if hasattr(group, "commands"):
        words = [
            "bench",
            "run" if words[1] not in group.commands else words[1],
            *words[1 + (words[1] in group.commands) :],
        ]
        group = group.commands[words[1]]
        words = words[1:]
    with group.make_context(words[0], words[1:]) as context:
        return dict(context.params)


def loop_of(found: dict[str, Any]) -> Loop:
    return Loop(found["max_replans"], found["tolerance"], found["time_limit"], found["simulations"])


def noise_of(found: dict[str, Any]) -> dict[str, float]:
    return Noise.of(found["noise"]).model_dump(exclude_defaults=True)


@pytest.mark.parametrize("spec", RUNS, ids=lambda spec: f"{spec.scene}-{spec.backend}")
def test_solving_anew_is_the_run_of_the_trial(spec: RunSpec) -> None:
    found = read(solve_command(spec.to_json()))
    assert (found["scene"], found["seed"]) == (spec.scene, spec.seed)
    name, options = split_variant(found["planner"])
    assert name == spec.planner
    given_options = {**parse_options(found["option"] or ()), "planner": options}
    assert {part: of for part, of in given_options.items() if of} == {
        part: {key: str(value) for key, value in of.items()} for part, of in spec.options.items()
    }
    assert (loop_of(found), noise_of(found)) == (spec.loop, spec.noise)
    for part in PARTS:
        usual = {"plan_backend": "pymunk", "plan_arm": found["arm"]}.get(part)
        assert (found[part] or usual) == (getattr(spec, part) or usual), part


@pytest.mark.parametrize(
    "settings",
    [
        BenchSettings(("paper",)),
        BenchSettings(
            ("paper", "random/0..99"), ("phia[sweeps=paper]", "ooa"), seeds=3, memory_limit=2000, trial_limit=9.5
        ),
        BenchSettings(
            ("near",), backend="mujoco", arm="baxter", plan_arm="planar", options={"arm": {"link_width": 0.1}}
        ),
        BenchSettings(
            ("near",), loop=Loop(simulations=1234567), trial_limit=1234567.5, noise={"friction": 0.123456789}
        ),
        BenchSettings(("near",), loop=Loop(time_limit=60.0, simulations=9), noise={"friction": 0.3}, goal="retrieve"),
    ],
    ids=str,
)
def test_the_command_of_a_bench_has_its_settings(settings: BenchSettings) -> None:
    found = read(bench_command(settings, "runs/a b"))
    assert (tuple(found["suites"]), tuple(found["planner"])) == (settings.suites, settings.planners)
    assert str(found["out"]) == "runs/a b"
    for name in ("seeds", "memory_limit", "trial_limit", *PARTS):
        assert found[name] == getattr(settings, name), name
    assert (loop_of(found), noise_of(found)) == (settings.loop, settings.noise)
    assert {part: of for part, of in parse_options(found["option"] or ()).items() if of} == {
        part: {key: str(value) for key, value in of.items()} for part, of in settings.options.items()
    }


@given(st.text(min_size=1))
def test_a_directory_is_one_word_however_it_is_called(directory: str) -> None:
    words = shlex.split(replay_command(directory, "0123456789abcdef", RunSpec().to_json()))
    assert words == ["phframe", "bench", "replay", directory, "0123456789ab"]


def test_a_repetition_names_the_parts_that_are_in_files() -> None:
    spec = RunSpec(planner="./my planner.py:Mine", arm="./arm.py:Mine", plan_arm="planar", goal="goals.py:Mine")
    found = read(replay_command("runs/a", "0123456789abcdef", spec.to_json()))
    named = {"planner": "./my planner.py:Mine", "arm": "./arm.py:Mine", "goal": "goals.py:Mine"}
    assert {part: found[part] for part in PARTS_OF_A_RUN} == {**dict.fromkeys(PARTS_OF_A_RUN), **named}


def test_a_run_that_cannot_be_read_has_no_command() -> None:
    assert solve_command("{}") == ""
