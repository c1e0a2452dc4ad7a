from __future__ import annotations

import pickle
from importlib import metadata
from pathlib import Path

import pytest

import phframe
from phframe.core.errors import PluginError, UnknownNameError
from phframe.registry import API_VERSION, Catalogue, Kind, catalogue, discover, load
from phframe.registry.builtin import EXTENSIONS
from tests.registry.conftest import Discover, Install, offering

BUILT_IN = [extension.name for extension in EXTENSIONS if extension.kind is Kind.PLANNER]
NOT_AN_ANSWER = "@hookimpl\ndef phframe_extensions():\n    return {}\n"


def names(found: Catalogue, kind: Kind = Kind.PLANNER) -> list[str]:
    return [entry.name for entry in found.extensions(kind)]


def test_the_builtins_come_through_the_hook() -> None:
    found = discover([])
    assert [entry.extension for entry in found.entries] == EXTENSIONS
    assert {entry.distribution for entry in found.entries} == {"phframe"}
    assert found.find(Kind.PLANNER, "phia") == found.find(Kind.PLANNER, "phframe:phia")


def test_the_version_of_the_interfaces_is_the_same_everywhere() -> None:
    assert phframe.api_version == API_VERSION


def test_a_plugin_is_found_with_its_distribution_and_version(install: Install, found: Discover) -> None:
    install("Phframe_Straight", offering("straight"), version="2.3")
    entry = found().find(Kind.PLANNER, "straight")
    assert (entry.distribution, entry.version) == ("phframe-straight", "2.3")
    assert found().find(Kind.PLANNER, "PHFRAME.straight:straight") == entry


def test_the_same_name_may_be_used_by_different_kinds(install: Install, found: Discover) -> None:
    install("one", offering("pymunk"))
    assert found().find(Kind.PLANNER, "pymunk").distribution == "one"
    assert found().find(Kind.BACKEND, "pymunk").distribution == "phframe"


def test_a_builtin_wins_a_clash_and_the_plugin_has_its_full_name(install: Install, found: Discover) -> None:
    install("one", offering("phia"))
    assert names(found()) == [*BUILT_IN, "one:phia"]
    assert found().find(Kind.PLANNER, "phia").distribution == "phframe"
    assert found().find(Kind.PLANNER, "one:phia").distribution == "one"


def test_of_two_plugins_with_one_name_neither_has_it(install: Install, found: Discover) -> None:
    install("two", offering("straight"))
    install("one", offering("straight", "other"))
    assert names(found())[len(BUILT_IN) :] == ["one:straight", "other", "two:straight"]
    with pytest.raises(UnknownNameError, match="say which, one:straight or two:straight"):
        found().find(Kind.PLANNER, "straight")


@pytest.mark.parametrize(
    ("source", "error"),
    [
        ("raise ValueError('bad\\nday')", "ValueError: bad day"),
        ("import sys; sys.exit(3)", "SystemExit: 3"),
        ("raise KeyboardInterrupt", "KeyboardInterrupt"),
        ("import no_such_module", "ModuleNotFoundError: No module named 'no_such_module'"),
        ("def f(:", "SyntaxError: "),
        ("@hookimpl\ndef phframe_extensions():\n    return 1 / 0", "ZeroDivisionError: division by zero"),
        ("@hookimpl\ndef phframe_extensions():\n    raise SystemExit", "SystemExit"),
        ("@hookimpl\ndef phframe_extensions():\n    pass", "returned a NoneType, not a list of Extension"),
        (NOT_AN_ANSWER, "returned a dict, not a list of Extension"),
        ("@hookimpl\ndef phframe_extensions():\n    return ['phia']", "returned 'phia' among its extensions"),
        ("def phframe_extensions():\n    return []", "no function phframe_extensions() marked with @hookimpl"),
        ("@hookimpl\ndef phframe_extension():\n    return []", "PluginValidationError: unknown hook"),
        (offering("straight", "straight"), "two of the same name: planner 'straight'"),
        (offering("straight", api_version=3), "version 3 of phframe's interfaces; this phframe has version 2"),
        (offering("straight", api_version=1), "version 2: docs/migration.md says what to change"),
        (offering("Straight Line"), "a name is lower-case words and digits joined by '-'"),
        (offering("straight").replace("MODULE:", "MODULE."), "is not 'module:Class'"),
        (offering("straight").replace("Kind('planner')", "'plan'"), "no kind of extension is called 'plan'"),
    ],
)
def test_a_broken_plugin_is_reported_and_the_rest_works(
    install: Install, found: Discover, source: str, error: str
) -> None:
    install("bad", source, version="0.9")
    install("good", offering("good"))
    result = found()
    assert names(result) == [*BUILT_IN, "good"]
    assert [(broken.distribution, broken.version) for broken in result.broken] == [("bad", "0.9")]
    assert error in result.broken[0].error
    assert "\n" not in str(result.broken[0])


def test_a_broken_plugin_is_mentioned_where_its_name_is_missed(install: Install, found: Discover) -> None:
    install("bad", NOT_AN_ANSWER)
    with pytest.raises(UnknownNameError, match=r"plugin bad 1\.0 is not loaded: .* returned a dict"):
        found().find(Kind.PLANNER, "straight")


def test_strict_makes_a_broken_plugin_an_error(install: Install, monkeypatch: pytest.MonkeyPatch) -> None:
    install("bad", NOT_AN_ANSWER)
    assert "bad" in [broken.distribution for broken in catalogue.__wrapped__().broken]
    monkeypatch.setenv("PHFRAME_PLUGINS_STRICT", "1")
    with pytest.raises(PluginError, match=r"plugin bad 1\.0 is not loaded"):
        catalogue.__wrapped__()


@pytest.mark.parametrize(
    ("listed", "expected"), [("", []), ("one", ["one"]), (" Two , one", ["one", "two"]), ("two,", ["two"])]
)
def test_only_the_listed_plugins_are_loaded(
    install: Install, monkeypatch: pytest.MonkeyPatch, listed: str, expected: list[str]
) -> None:
    for name in ("one", "two"):
        install(name, offering(name))
    monkeypatch.setenv("PHFRAME_PLUGINS", listed)
    assert names(catalogue.__wrapped__()) == [*BUILT_IN, *expected]


def test_a_plugin_that_is_not_listed_is_not_even_imported(install: Install, found: Discover) -> None:
    install("bad", "raise ValueError")
    assert found(only=[]).broken == ()


def test_a_listed_plugin_that_is_not_installed_is_reported(install: Install, found: Discover) -> None:
    install("one", offering("one"))
    assert [str(broken) for broken in found(only=["one", "tow"]).broken] == [
        "plugin tow is not loaded: no such plugin is installed"
    ]


def test_a_name_nearly_right_is_answered_with_the_right_one() -> None:
    there_is = ", ".join(sorted(BUILT_IN))
    with pytest.raises(
        UnknownNameError, match=rf"no planner named 'phya'\. Did you mean 'phia'\? There is: {there_is}"
    ):
        discover([]).find(Kind.PLANNER, "phya")
    with pytest.raises(UnknownNameError, match="There is no command at all"):
        discover([]).find(Kind.COMMAND, "tidy")


def test_a_catalogue_can_be_sent_to_another_process(install: Install, found: Discover) -> None:
    install("bad", NOT_AN_ANSWER)
    install("one", offering("straight"))
    assert pickle.loads(pickle.dumps(found())) == found()


def test_discovery_does_not_depend_on_the_order_of_the_distributions(install: Install, site: Path) -> None:
    for name in ("one", "two", "three"):
        install(name, offering("straight", name))
    found = list(metadata.distributions(path=[str(site)]))
    assert discover(found) == discover(found[::-1])


def test_a_name_is_looked_up_where_asked(install: Install, found: Discover) -> None:
    install("one", offering("straight"))
    assert load(Kind.PLANNER, "straight", found()).__name__ == "Straight"
    with pytest.raises(UnknownNameError):
        load(Kind.PLANNER, "straight", discover([]))
