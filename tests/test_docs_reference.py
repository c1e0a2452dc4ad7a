"""What the documentation lists is complete and right: names, options, keys, codes, deviations, variables, kinds."""

from __future__ import annotations

import ast
import json
import re
import tomllib
from collections.abc import Mapping, Sequence
from functools import cache
from importlib import import_module
from itertools import product
from pathlib import Path
from typing import Any

import pytest
from packaging.requirements import Requirement
from pydantic import BaseModel

import phframe
from phframe import testing
from phframe.backends.articulated import JointEngine
from phframe.bench.export.columns import COLUMNS
from phframe.bench.export.formats import RESULT_FORMATS
from phframe.cli import exit_codes
from phframe.cli.listing_data import listing
from phframe.cli.option_list import OptionRow, describe
from phframe.cli.scene_table import overview_as_json
from phframe.core import Condition, Episode, Phase, Status
from phframe.motion.options import ArticulatedOptions
from phframe.pushing.deviation import Deviation
from phframe.recorders.scene_overview import scene_overview
from phframe.registry import Kind, builtin, create
from phframe.registry.load import INTERFACES
from phframe.runtime.scenes import find_scene
from phframe.runtime.summary import summarize
from phframe.urdf.description import ArmDescription, Section, Stand, TipFrame
from tests.markdown import (
    DOCS,
    PAGES,
    README,
    ROOT,
    blocks,
    column,
    each_page,
    extras,
    marks_of,
    named,
    quoted,
    table,
    text_of,
)

PLANNERS = [each.name for each in builtin.EXTENSIONS if each.kind is Kind.PLANNER]
GRTC = ("grtc-straight", "guided")
"""Planners that have options of their own, in one table."""
FURTHER = ("phia", "sure", "ooa", "phis", "phim")
"""Planners with the family's options and further ones, in a table of their own."""
KINODYNAMIC = ("grtc-kinodynamic", "kinodynamic-rrt")
"""Planners whose options are told where they are described."""
JSON_TYPES: Mapping[str, Any] = {
    "integer": int,
    "number": float,
    "text": str,
    "text or null": str | None,
    "boolean": bool,
    "list of text": list,
    "object": dict,
    "object or null": dict | None,
}


@cache
def classes() -> Mapping[str, frozenset[str]]:
    """Every class of phframe, with the names defined in it."""
    found: dict[str, frozenset[str]] = {}
    for path in (ROOT / "phframe").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.ClassDef):
                functions = {each.name for each in node.body if isinstance(each, ast.FunctionDef)}
                fields = {str(getattr(each.target, "id", "")) for each in node.body if isinstance(each, ast.AnnAssign)}
                found[node.name] = found.get(node.name, frozenset()) | functions | fields
    return found


@each_page(PAGES)
def test_names_in_the_text_exist(page: Path) -> None:
    if page.name == "migration.md":  # it names what was
        return
    for text in quoted(page):
        if re.fullmatch(r"[A-Z][a-z]+[A-Za-z]*(\.\w+)?", text):
            name, _, member = text.partition(".")
            assert name in classes(), f"{named(page)}: {text}"
            assert not member or member in classes()[name], f"{named(page)}: {text}"
        elif re.fullmatch(r"phframe(\.\w+)+", text):
            resolve(text)


def resolve(dotted: str) -> object:
    """The module, or the thing in a module, that a dotted name means."""
    try:
        return import_module(dotted)
    except ModuleNotFoundError:
        module, _, name = dotted.rpartition(".")
        return getattr(resolve(module), name)


def test_words_of_the_language_are_explained() -> None:
    explained = column("docs/concepts.md", "The words")
    assert all(hasattr(phframe.core, word) for word in explained if word[0].isupper())
    text = text_of(DOCS / "concepts.md")
    assert all(f"`{word}`" in text for word in [*Phase, *Condition])
    assert column("docs/concepts.md", "How it can end") == list(Status)


def test_parts_of_the_package_are_in_the_readme() -> None:
    parts = {path.parent.name for path in (ROOT / "phframe").glob("*/__init__.py")}
    assert set(column("README.md", "How it is made")) == parts
    for row in table("README.md", "How it is made"):
        kind = {"planners": Kind.PLANNER, "backends": Kind.BACKEND, "arms": Kind.ARM, "topology": Kind.TOPOLOGY}.get(
            row[0]
        )
        for extension in builtin.EXTENSIONS:
            assert extension.kind is not kind or f"`{extension.name}`" in f"`{row[1]}`", f"{row[0]}: {extension.name}"


def test_suites_are_in_the_readme_and_explained() -> None:
    suites = [each.name for each in builtin.EXTENSIONS if each.kind is Kind.SCENES]
    assert column("docs/scenes.md", "Suites") == suites
    assert all(f"`{suite}`" in text_of(README) for suite in suites)
    counts = {suite: str(len(create(Kind.SCENES, suite).names())) for suite in ("vieira", "papallas")}
    assert all(f"`{suite}` ({count} scenes" in text_of(README) for suite, count in counts.items())


def test_extras_are_in_the_readme() -> None:
    assert set(re.findall(r"\w+", " ".join(column("README.md", "Run it")))) == extras()


PLATFORMS = {
    "Linux x86-64": ("linux", "x86_64", "#1 SMP"),
    "Linux aarch64": ("linux", "aarch64", "#1 SMP"),
    "macOS arm64": ("darwin", "arm64", "Darwin Kernel Version 24.1.0"),
    "macOS Intel": ("darwin", "x86_64", "Darwin Kernel Version 24.1.0"),
    "Windows": ("win32", "AMD64", "10.0.26100"),
}
PYTHONS = ("3.11", "3.12", "3.13", "3.14")


def available(names: Sequence[str], platform: tuple[str, str, str], *, by_joints: bool) -> str:
    """With which Python everything needed in some extras is installed, in words; only joints need times for their paths."""
    optional = tomllib.loads(text_of(ROOT / "pyproject.toml"))["project"]["optional-dependencies"]
    requirements = [Requirement(line) for name in names for line in optional[name]]
    markers = [each.marker for each in requirements if by_joints or each.name != "toppra"]
    system, machine, version = platform
    environment = {"sys_platform": system, "platform_machine": machine, "platform_version": version}
    environment["implementation_name"] = "cpython"
    fits = [
        python
        for python in PYTHONS
        if all(marker is None or marker.evaluate({**environment, "python_version": python}) for marker in markers)
    ]
    return {0: "no", 1: "".join(fits), len(PYTHONS): "3.11+"}.get(len(fits)) or f"{fits[0]} to {fits[-1]}"


def test_what_runs_where_is_what_the_markers_say() -> None:
    rows = table("README.md", "What runs where")
    backends, arms = (
        {each.name for each in builtin.EXTENSIONS if each.kind is kind} for kind in (Kind.BACKEND, Kind.ARM)
    )
    assert {(row[0], row[1]) for row in rows} >= set(product(backends, arms))
    for backend, arm, needed, *cells in rows:
        names = re.findall(r"\w+", needed)
        own = [each.extra for each in builtin.EXTENSIONS if each.name in (backend, arm) and each.extra]
        assert set(own) <= set(names), (backend, arm)
        by_joints = backend not in ("pymunk", "fast")
        found = [available(names, platform, by_joints=by_joints) for platform in PLATFORMS.values()]
        assert cells == found, (backend, arm)


def test_every_deviation_is_explained() -> None:
    assert column("docs/planners.md", "Deviations of what the paper leaves open") == list(Deviation)


@pytest.mark.parametrize("planner", [pytest.param(each, marks=marks_of([each])) for each in PLANNERS])
def test_every_planner_and_its_options_are_explained(planner: str) -> None:
    assert f"\n## `{planner}`\n" in text_of(DOCS / "planners.md")
    check_options(option_rows(planner), Kind.PLANNER, planner)


def option_rows(planner: str) -> list[list[str]]:
    """The rows about a planner's options: those of its family, and its own, which say whose they are."""
    if planner in KINODYNAMIC:
        return table("docs/planners.md", f"`{planner}`")
    if planner not in GRTC:
        own = table("docs/planners.md", f"`{planner}`") if planner in FURTHER else []
        family = table("docs/planners.md", "Options")
        return list({row[0]: row for row in family + own}.values())  # what is its own default is told with its own
    rows = table("docs/planners.md", "Options of `grtc-straight` and `guided`")
    return [row for row in rows if not re.match(r"`?(grtc-straight|guided)`?:", row[3]) or planner in row[3]]


def test_options_of_the_generator_are_explained() -> None:
    check_options(table("docs/scenes.md", "The generator"), Kind.SCENES, "random")


@pytest.mark.parametrize(("suite", "heading"), [("dense", "Dense scenes"), ("near", "Near scenes")])
def test_options_of_the_other_generators_are_explained_where_they_differ(suite: str, heading: str) -> None:
    known = describe(Kind.SCENES, "random").options
    differing = tuple(option for option in describe(Kind.SCENES, suite).options if option not in known)
    check_rows(table("docs/scenes.md", heading), differing)


def test_every_key_of_a_scene_shown_is_explained() -> None:
    told = overview_as_json(scene_overview(find_scene("near/0")))
    rows = table("docs/scenes.md", "A scene to look at")
    assert [row[0] for row in rows] == list(told)
    assert all(f"`{key}`" in rows[-1][3] for key in told["corridor"])


def test_what_is_said_of_an_arm_is_explained() -> None:
    rows = table("docs/robots.md", "The description")
    fields = {field.alias or name: field for name, field in ArmDescription.model_fields.items()}
    assert [row[0] for row in rows] == list(fields)
    for key, default, text in rows:
        field = fields[key]
        assert default in ("", str(field.default)) or not (field.is_required() or field.default), key
        assert (default == "") is (field.is_required() or key == "urdf"), key
        parts: dict[str, type[BaseModel]] = {"tip": TipFrame, "shelf": Stand, "behind": Section}
        nested = parts.get(key)
        assert nested is None or all(f"`{name}`" in text for name in nested.model_fields), key


def test_options_of_motion_are_explained() -> None:
    rows = table("docs/robots.md", "How it moves")
    fields = ArticulatedOptions.model_fields
    assert [row[:2] for row in rows] == [[key, str(field.default)] for key, field in fields.items()]
    assert all(f"({unit})" in (ArticulatedOptions.__doc__ or "") for _, _, unit, _ in rows if unit)


def check_options(rows: list[list[str]], kind: Kind, name: str) -> None:
    """Key, default and unit of every option, in order."""
    check_rows(rows, describe(kind, name).options)


def check_rows(rows: list[list[str]], options: Sequence[OptionRow]) -> None:
    """Key, default and unit of some options, in order."""
    assert [row[:2] for row in rows] == [[option.key, str(option.default)] for option in options]
    for (key, _, unit, _), option in zip(rows, options, strict=True):
        assert f"({unit})" in option.description if unit else "(" not in option.description, key


def test_every_kind_of_extension_is_explained() -> None:
    rows = table("docs/plugins.md", "Kinds of extensions")
    assert [row[0] for row in rows] == list(Kind)
    for kind, interface, _, _, check in rows:
        assert Kind(kind) not in INTERFACES or INTERFACES[Kind(kind)] == interface
        assert (check in testing.__all__) is bool(check)


def test_every_conformance_check_is_explained() -> None:
    checks = {name for name in testing.__all__ if name.startswith("check_")}
    assert set(column("docs/plugins.md", "The conformance kit")) == checks
    assert all(f"`{name}`" in text_of(DOCS / "plugins.md") for name in testing.__all__ if name.endswith("_CHECKS"))


def test_every_environment_variable_is_explained() -> None:
    code = "".join(path.read_text("utf-8") for path in (ROOT / "phframe").rglob("*.py"))
    used = set(re.findall(r"\"(PHFRAME_[A-Z_]+)\"", code))
    assert set(column("docs/plugins.md", "Environment variables")) == used
    assert set(re.findall(r"PHFRAME_[A-Z_]+", "".join(map(text_of, PAGES)))) == used


def test_every_exit_code_is_explained() -> None:
    rows = [[str(code.value), meaning] for code, meaning in exit_codes.MEANING.items()]
    assert table("docs/json.md", "Exit codes") == rows
    assert len(rows) == len(exit_codes.ExitCode)


@pytest.fixture(scope="module")
def episode() -> Episode:
    return phframe.solve("vieira/basic")


RESULT = "The result: `phframe solve --json`"


def test_every_key_of_the_result_is_explained(episode: Episode) -> None:
    summary = summarize(episode)
    rows = table("docs/json.md", RESULT)
    assert [row[0] for row in rows] == list(summary)
    for key, kind, *_ in rows:
        assert isinstance(summary[key], JSON_TYPES[kind]), key
        assert (kind == "integer") is (type(summary[key]) is int), key


def test_the_example_of_the_result_is_one(episode: Episode) -> None:
    (block,) = blocks("json")
    example, summary = json.loads(block.text), summarize(episode)
    assert list(example) == list(summary)
    for key in set(summary) - {"planning_time", "recording", "versions"}:
        measured = key in ("execution_time", "tracking_error", "prediction_error")
        assert example[key] == (pytest.approx(summary[key], rel=0.02) if measured else summary[key]), key
    assert list(example["versions"]) == list(summary["versions"])


def test_every_key_of_the_listings_is_explained() -> None:
    suites = listing(Kind.SCENES, "scenes").as_json()
    assert list(suites) == ["format", "scenes", "broken"]
    assert column("docs/json.md", "The listings: `--json`") == list(suites["scenes"][0])
    described = describe(Kind.PLANNER, "phia").as_json()
    names = [*described, *described["options"][0]]
    assert all(f"`{name}`" in text_of(DOCS / "json.md") for name in names)


def test_the_table_of_readme_holds_the_counts_of_the_experiment() -> None:
    plane: dict[str, tuple[str, ...]] = {row[0]: (row[1], "121") for row in table("docs/experiment.md", "In the plane")}
    rows = table("docs/experiment.md", "In space")
    space = {(engine, arm, each): tuple(counts.split(" of ")) for engine, arm, each, counts, *_ in rows}
    clean = {(engine, arm): row[2] for engine, arm, each, *row in rows if each == "sure"}
    planners = ("phis", "phim", "phia", "ooa")
    assert "| " + " | ".join(f"`{each}`" for each in planners) + " |" in text_of(README)
    for backend, arm, problems, sure, of_sure, *counts in table("README.md", "What it does best"):
        if backend == "pymunk":
            told = {each: plane[each] for each in ("sure", *planners)}
        else:
            told = {each: space.get((backend, arm, each), ("", problems)) for each in ("sure", *planners)}
            assert of_sure == clean[backend, arm]
        assert {each: (count, problems) for each, count in zip(told, (sure, *counts), strict=True)} == told


def test_every_method_of_an_engine_of_joints_is_explained() -> None:
    told = [name for row in table("docs/backends.md", "Its methods") for name in re.findall(r"\w+", row[0])]
    assert told == [name for name, member in vars(JointEngine).items() if callable(member) and not name.startswith("_")]


def test_the_columns_of_a_benchs_results_are_documented() -> None:
    rows = [
        [each.name, f"{each.kind}{' or null' if each.optional else ''}", each.unit, each.meaning] for each in COLUMNS
    ]
    assert table("docs/json.md", "The results of a bench") == rows
    text = text_of(DOCS / "json.md")
    assert all(f"**`{name}`**" in text for name in RESULT_FORMATS)
