from __future__ import annotations

import platform
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from phframe.core import NotInstalledError, OptionError, PluginError, TopologyEngine, UnknownNameError
from phframe.registry import Kind, create, discover, load
from phframe.registry.builtin import EXTENSIONS
from phframe.registry.extension import Extension
from tests.registry.conftest import STRAIGHT, Discover, Install, offering

ROOT = Path(__file__).parents[2]
HEAVY = [
    "matplotlib",
    "mujoco",
    "numba",
    "persim",
    "pybullet",
    "pymunk",
    "pyRipser",
    "rerun",
    "ripser",
    "scipy",
    "sklearn",
]


def marks_of(extension: Extension) -> list[pytest.MarkDecorator]:
    return [getattr(pytest.mark, f"needs_{extension.extra}")] if extension.extra else []


@pytest.mark.parametrize(
    "extension", [pytest.param(each, marks=marks_of(each), id=f"{each.kind}-{each.name}") for each in EXTENSIONS]
)
def test_every_builtin_loads(extension: Extension) -> None:
    try:
        loaded = load(extension.kind, extension.name, discover([]))
    except NotInstalledError as error:
        assert extension.extra, extension.name
        pytest.skip(str(error))
    assert loaded.__name__ == extension.target.partition(":")[2]


def test_an_object_is_made_from_options() -> None:
    assert isinstance(create(Kind.TOPOLOGY, "ripser"), TopologyEngine)
    with pytest.raises(OptionError, match="topology ripser has no option 'speed'"):
        create(Kind.TOPOLOGY, "ripser", {"speed": 3})


def test_options_may_be_text(install: Install, found: Discover) -> None:
    install("one", offering("straight"))
    assert create(Kind.PLANNER, "straight", {"tries": "7"}, found()).options.tries == 7
    with pytest.raises(OptionError, match="planner straight: option 'tries'"):
        create(Kind.PLANNER, "straight", {"tries": "many"}, found())


@pytest.mark.parametrize(
    ("source", "error"),
    [
        (offering("straight").replace(":Straight", ":Strait"), "AttributeError: module .* has no attribute 'Strait'"),
        (offering("straight").replace("MODULE:", "no_such:"), "No module named 'no_such'"),
        (offering("straight").replace("(Planner[Choice])", ""), "is not a subclass of phframe.core.Planner"),
        (offering("straight").replace("MODULE:Straight", "MODULE:STRAIGHT") + "STRAIGHT = 3", "is not a subclass"),
        (offering("straight", kind="arm"), "is not a subclass of phframe.core.ArmModel"),
        (offering("straight").replace("def search", "def seek"), "does not implement: search"),
    ],
)
def test_a_class_that_does_not_fit_is_refused(install: Install, found: Discover, source: str, error: str) -> None:
    install("one", source)
    kind = Kind.ARM if "'arm'" in source else Kind.PLANNER
    with pytest.raises(PluginError, match=error):
        load(kind, "straight", found())


def test_recorders_and_commands_need_no_base_class(install: Install, found: Discover) -> None:
    install("one", offering("straight", kind="recorder"))
    assert load(Kind.RECORDER, "straight", found()).__name__ == "Straight"


def plugin_that_imports(install: Install, site: Path, line: str, *requires: str, extra: str | None = "engine") -> None:
    module = f"{install('one', offering('straight', extra=extra), requires=requires)}.py"
    engine = f"plugin_engine_{module}"
    (site / engine).write_text(f"{line}\n{STRAIGHT}", encoding="utf-8")
    source = (site / module).read_text(encoding="utf-8")
    (site / module).write_text(source.replace(f"'{module[:-3]}:", f"'{engine[:-3]}:"), encoding="utf-8")


def test_a_library_of_an_extra_that_is_missing_is_named_with_the_install_line(
    install: Install, site: Path, found: Discover
) -> None:
    plugin_that_imports(install, site, "import no_engine", 'no-engine>=2; extra == "engine"', 'other; extra == "dev"')
    with pytest.raises(NotInstalledError) as caught:
        load(Kind.PLANNER, "straight", found())
    assert (caught.value.what, caught.value.library) == ("planner 'straight'", "no-engine")
    assert caught.value.remedy == 'pip install "one[engine]"'


def test_an_unknown_name_is_answered_with_the_install_line_of_those_that_need_one(
    install: Install, site: Path, found: Discover
) -> None:
    plugin_that_imports(install, site, "import no_engine", 'no-engine>=2; extra == "engine"')
    with pytest.raises(UnknownNameError, match=r"'straight' cannot be used yet: pip install \"one\[engine\]\""):
        load(Kind.PLANNER, "strait", found())


def test_where_no_wheel_exists_the_error_says_so(install: Install, site: Path, found: Discover) -> None:
    plugin_that_imports(install, site, "import no_engine", 'no-engine; python_version < "3.4" and extra == "engine"')
    with pytest.raises(NotInstalledError, match=f"no wheel of it for .* on {platform.system()}"):
        load(Kind.PLANNER, "straight", found())


def test_a_library_that_the_distribution_itself_needs_may_be_missing_too(
    install: Install, site: Path, found: Discover
) -> None:
    plugin_that_imports(install, site, "import no_engine", "no-engine", extra=None)
    with pytest.raises(NotInstalledError, match='pip install "one"'):
        load(Kind.PLANNER, "straight", found())


def test_phframe_itself_is_never_missing(install: Install, found: Discover) -> None:
    install("one", offering("straight"), requires=("phframe>=0.1", "pluggy"))
    with pytest.raises(UnknownNameError) as caught:
        load(Kind.PLANNER, "strait", found())
    assert "'straight' cannot be used yet" not in caught.value.hint


@pytest.mark.parametrize(
    ("line", "requirement"),
    [
        ("import no_engine", 'pluggy; extra == "engine"'),  # all the extra asks for is here
        ("import no_engine", 'no-engine; extra == "another"'),
        ("from pluggy import no_such", 'no-engine; extra == "engine"'),
        ("from phframe.core import no_such", 'no-engine; extra == "engine"'),
        ("import phframe_no_such.part", 'pluggy; extra == "engine"'),
        ("raise RuntimeError('no display')", 'no-engine; extra == "engine"'),
    ],
)
def test_a_mistake_in_a_plugin_is_not_taken_for_a_missing_library(
    install: Install, site: Path, found: Discover, line: str, requirement: str
) -> None:
    plugin_that_imports(install, site, line, requirement)
    with pytest.raises(PluginError, match=r"planner 'straight' of one 1\.0 does not load: \w+Error: "):
        load(Kind.PLANNER, "straight", found())


def test_a_missing_module_of_the_plugin_itself_is_not_taken_for_a_missing_library(
    install: Install, found: Discover
) -> None:
    source = offering("straight", extra="engine").replace("MODULE:", "MODULE.part:")
    install("one", source, requires=('no-engine; extra == "engine"',))
    with pytest.raises(PluginError, match="does not load: ModuleNotFoundError"):
        load(Kind.PLANNER, "straight", found())


def test_listing_imports_nothing_heavy() -> None:
    program = (
        "import sys; from phframe.registry import Kind, catalogue; found = catalogue();"
        "assert all(found.extensions(kind) for kind in Kind if kind is not Kind.COMMAND);"
        f"print([name for name in {HEAVY} if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_every_extra_of_a_builtin_exists() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert {extension.extra for extension in EXTENSIONS} - {None} <= set(project["optional-dependencies"])
