from __future__ import annotations

import json

import pytest

from phframe.cli.exit_codes import ExitCode
from phframe.registry import Kind, catalogue, create
from tests.cli.conftest import Install, Invoke

TITLES = {
    "planners": Kind.PLANNER,
    "backends": Kind.BACKEND,
    "arms": Kind.ARM,
    "topology": Kind.TOPOLOGY,
    "scenes": Kind.SCENES,
}
OFFERING = """
@hookimpl
def phframe_extensions():
    return [Extension(Kind({kind!r}), {name!r}, {target!r}, "A lab's", {extra!r}, api_version=2)]
"""


@pytest.mark.parametrize("title", TITLES)
def test_the_listings_list_what_is_registered(invoke: Invoke, title: str) -> None:
    table, result = invoke(title), invoke(title, "--json")
    listed = json.loads(result.stdout)
    assert (table.exit_code, result.exit_code) == (0, 0)
    assert result.stdout.count("\n") == 1
    assert result.stderr == ""
    assert listed["format"] == 1
    entries = catalogue().extensions(TITLES[title])
    names = [[e.name, *(f"{e.name}[{options}]" for options, _ in e.extension.variants)] for e in entries]
    assert [item["name"] for item in listed[title]] == [name for each in names for name in each]
    for item in listed[title]:
        assert item["name"] in table.stdout
        assert item["summary"] in table.stdout


def test_a_planner_with_the_paper_s_sweep_is_listed_as_one_of_its_own(invoke: Invoke) -> None:
    assert {"phia[sweeps=paper]", "ooa[sweeps=paper]", "phis[sweeps=paper]"} <= set(invoke("planners").stdout.split())


def test_every_listed_scene_is_one_that_loads(invoke: Invoke) -> None:
    suites = json.loads(invoke("scenes", "--json").stdout)["scenes"]
    names = [name for suite in suites for name in suite["scenes"]]
    assert {"vieira/basic", "papallas/s10", "random/0"} <= set(names)
    for name in names:
        suite, _, scene = name.partition("/")
        assert create(Kind.SCENES, suite).load(scene).name == name


@pytest.mark.parametrize("title", TITLES)
def test_every_registered_thing_can_be_described(invoke: Invoke, title: str) -> None:
    for entry in catalogue().extensions(TITLES[title]):
        result = invoke(title, entry.name, "--json")
        if result.exit_code == ExitCode.NOT_INSTALLED:
            assert entry.extension.extra
            continue
        described = json.loads(result.stdout)
        assert described["name"] == entry.name
        assert described["text"]
        assert invoke(title, entry.name).exit_code == 0


def test_options_are_described_with_range_default_and_unit(invoke: Invoke) -> None:
    options = {each["key"]: each for each in json.loads(invoke("planners", "phia", "--json").stdout)["options"]}
    assert options["margin"]["default"] == 0.015
    assert options["margin"]["values"] == "number >= 0, <= 1"
    assert "(m)" in options["margin"]["description"]
    assert options["half_width"]["values"].endswith("or auto")
    assert "scenes.count" in invoke("scenes", "random").stdout


def test_a_broken_plugin_is_shown_with_the_reason_and_the_rest_works(invoke: Invoke, install: Install) -> None:
    install("lab-broken", "raise RuntimeError('out of order')", version="2.1")
    listed = json.loads(invoke("planners", "--json").stdout)
    assert listed["broken"] == [{"distribution": "lab-broken", "version": "2.1", "error": "RuntimeError: out of order"}]
    assert "phia" in [item["name"] for item in listed["planners"]]
    assert "not loaded: lab-broken 2.1: RuntimeError: out of order" in invoke("planners").stdout


def test_a_suite_that_does_not_load_is_shown_with_the_reason(invoke: Invoke, install: Install) -> None:
    install("lab-suite", OFFERING.format(kind="scenes", name="lab", target="lab_absent:Suite", extra=None))
    table = invoke("scenes")
    assert table.exit_code == 0
    assert "vieira/basic" in table.stdout
    assert "not loaded: lab-suite 1.0" in table.stdout


def test_what_is_not_installed_says_what_installs_it(invoke: Invoke, install: Install) -> None:
    source = OFFERING.format(kind="backend", name="lab", target="lab_absent_engine:Engine", extra="engine")
    install("lab-engine", source, requires=("no-such-engine; extra == 'engine'",))
    [item] = [each for each in json.loads(invoke("backends", "--json").stdout)["backends"] if each["name"] == "lab"]
    assert item["needs"] == "no-such-engine"
    assert item["remedy"] == 'pip install "lab-engine[engine]"'
    assert 'pip install "lab-engine[engine]"' in invoke("backends").stdout


def test_using_what_is_not_installed_is_exit_code_3(invoke: Invoke, install: Install) -> None:
    source = OFFERING.format(kind="backend", name="lab", target="lab_engine:Engine", extra="engine")
    lazily = "\ndef __getattr__(name):\n    import no_such_engine\n"
    install("lab-engine", source + lazily, requires=("no-such-engine; extra == 'engine'",))
    result = invoke("solve", "--backend", "lab", "--no-rerun", "--json")
    assert result.exit_code == 3
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1
    assert 'pip install "lab-engine[engine]"' in result.stderr
