"""Plugins and files that come, change, break and go in any order: what each name leads to is always what it should."""

from __future__ import annotations

import importlib
import os
import shutil
import sys
import tempfile
from collections import Counter
from contextlib import ExitStack, suppress
from importlib import metadata
from itertools import count, product
from pathlib import Path

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule, run_state_machine_as_test

from phframe.core import PhframeError, PluginError, UnknownNameError
from phframe.core.stored_name import StoredName
from phframe.registry import Broken, Catalogue, Entry, Extension, Kind, builtins, create, discover, load, look_up
from phframe.registry.catalogue import named
from tests.faults.files.spoiling import a_line
from tests.registry.conftest import HEADER, STRAIGHT, offering
from tests.trials import many, tried

DISTRIBUTIONS = st.sampled_from(("lab", "lab-two", "rival", "x-1"))
NAMES = ("mine", "yours", "phia", "ooa", "a-1")
ODD_NAMES = (
    *(
        "",
        " ",
        ":",
        "::",
        "lab:",
        ":mine",
        "lab:mine:mine",
        "LAB:mine",
        "lab_two:mine",
        "phframe:phia",
        "nobody:mine",
        "Phia",
    ),
    *(
        "phia[",
        "phia[]",
        "phia[=]",
        "phia[sweeps=paper]",
        "mine[tries=x]",
        "mine[tries=5]",
        "\u202e",
        "\ud800",
        "a" * 5000,
        "a\nb",
    ),
    *(
        "..",
        "/",
        "~",
        "\0",
        ".py",
        ".py:",
        "x.py:",
        ":x.py",
        "a.py:Straight:Straight",
        "a.py:__name__",
        "a.py:Choice",
        "nowhere.py:A",
    ),
)
FILES = st.sampled_from(("a.py", "b.py", "deep/a.py"))
SERIAL = count()


class RegistryInAnyOrder(RuleBasedStateMachine):
    """A site to which distributions are installed, and a folder of files, beside what is known of both."""

    def __init__(self) -> None:
        super().__init__()
        self.stack = ExitStack()
        self.site = Path(self.stack.enter_context(tempfile.TemporaryDirectory())).resolve()
        before, known = Path.cwd(), set(sys.modules)
        os.chdir(self.site)
        self.stack.callback(os.chdir, before)
        sys.path.insert(0, str(self.site))
        self.stack.callback(sys.path.remove, str(self.site))
        self.stack.callback(lambda: [sys.modules.pop(each) for each in set(sys.modules) - known if _is_ours(each)])
        self.offers: dict[str, tuple[str, dict[str, int]]] = {}
        self.sound: dict[str, bool] = {}
        self.loaded: set[str] = set()
        self.files: dict[str, int | None] = {}

    def teardown(self) -> None:
        self.stack.close()

    def found(self) -> Catalogue:
        """What is registered."""
        entries = [
            Entry(Extension(Kind.PLANNER, name, f"{module}:Straight", "A test", None, 2), distribution, "1.0", name)
            for distribution, (module, offered) in sorted(self.offers.items())
            for name in offered
        ]
        return Catalogue(named([*builtins().entries, *entries]), (Broken("gone", "1.0", "it is broken"),))

    # Distributions

    @rule(distribution=DISTRIBUTIONS, names=st.sets(st.sampled_from(NAMES), min_size=1), tries=st.integers(1, 99))
    def install(self, distribution: str, names: set[str], tries: int) -> None:
        module = f"any_order_{next(SERIAL)}"
        self.offers[distribution] = module, dict.fromkeys(sorted(names), tries)
        self._write(module, STRAIGHT.replace("= 3", f"= {tries}"), sound=True)

    @rule(distribution=DISTRIBUTIONS)
    def uninstall(self, distribution: str) -> None:
        self.offers.pop(distribution, None)

    @rule(
        distribution=DISTRIBUTIONS, how=st.sampled_from(("raise SystemExit(0)", "def f(:", "1/0", "Straight = 5", "\0"))
    )
    def break_it(self, distribution: str, how: str) -> None:
        if distribution in self.offers:
            self._write(self.offers[distribution][0], how, sound=False)

    @rule(distribution=DISTRIBUTIONS)
    def lose_its_files(self, distribution: str) -> None:
        if distribution in self.offers:
            module = self.offers[distribution][0]
            (self.site / f"{module}.py").unlink(missing_ok=True)
            self.sound[module] = False

    def _write(self, module: str, source: str, *, sound: bool) -> None:
        (self.site / f"{module}.py").write_text(source, encoding="utf-8")
        self.sound[module] = sound
        importlib.invalidate_caches()

    # Files

    @rule(file=FILES, tries=st.integers(1, 99))
    def write_a_file(self, file: str, tries: int) -> None:
        self.lose_a_file(file)
        path = self.site / file
        path.parent.mkdir(exist_ok=True)
        path.write_text(STRAIGHT.replace("= 3", f"= {tries}"), encoding="utf-8")
        self.files[file] = tries

    @rule(file=FILES, how=st.sampled_from(("raise KeyError", "Straight = 5", "", "x = (", "\0", "import no_such")))
    def break_a_file(self, file: str, how: str) -> None:
        if self.files.pop(file, None) is not None:
            (self.site / file).write_text(how, encoding="utf-8")

    @rule(file=FILES)
    def lose_a_file(self, file: str) -> None:
        self.files.pop(file, None)
        path = self.site / file
        with suppress(FileNotFoundError):
            path.rmdir() if path.is_dir() else path.unlink()

    @rule(file=FILES)
    def make_it_a_folder(self, file: str) -> None:
        self.lose_a_file(file)
        (self.site / file).mkdir(parents=True)

    # Questions

    @rule()
    def ask_for_all_there_is(self) -> None:
        for name, by in product(NAMES, (None, "phframe", *self.offers)):
            if self._expected(name, by) != "unknown":
                self._ask(name, by)

    @rule(name=st.sampled_from(NAMES), by=st.none() | DISTRIBUTIONS)
    def ask(self, name: str, by: str | None) -> None:
        self._ask(name, by)

    def _ask(self, name: str, by: str | None) -> None:
        tried("inputs: names asked for while plugins come and go")
        wanted, expected = name if by is None else f"{by}:{name}", self._expected(name, by)
        for _ in range(2):  # the same question, the same answer
            assert self._answer(wanted) == expected
        if expected.startswith("any_order_"):
            self.loaded.add(expected.partition(":")[0])

    def _expected(self, name: str, by: str | None) -> str:
        own = [each for each in builtins().extensions(Kind.PLANNER) if each.name == name]
        if own and by in (None, "phframe"):
            return own[0].extension.target
        offering = [each for each, (_, offered) in self.offers.items() if name in offered and by in (None, each)]
        if len(offering) != 1:
            return "unknown"
        module, offered = self.offers[offering[0]]
        if not self.sound[module] and module not in self.loaded:
            return "broken"
        return f"{module}:Straight {offered[name]}"

    def _answer(self, wanted: str) -> str:
        try:
            made = create(Kind.PLANNER, wanted, registered=self.found())
        except UnknownNameError as error:
            a_line(error)
            return "unknown"
        except PluginError as error:
            a_line(error)
            return "broken"
        told = f"{type(made).__module__}:{type(made).__name__}"
        return f"{told} {made.options.tries}" if hasattr(made.options, "tries") and _is_ours(told) else told

    @rule(file=FILES)
    def ask_for_a_file(self, file: str) -> None:
        tried("inputs: names asked for while plugins come and go")
        for _ in range(2):
            try:
                made = create(Kind.PLANNER, f"./{file}:Straight", {"tries": "7"} if self.files.get(file) == 7 else None)
            except PhframeError as error:
                a_line(error)
                assert file not in self.files
            else:
                assert made.options.tries == self.files[file]
        with pytest.raises(PhframeError, match="code is not run because a file names it"):
            load(Kind.PLANNER, StoredName(f"./{file}:Straight"))

    @rule(name=st.sampled_from(ODD_NAMES), kind=st.sampled_from(list(Kind)))
    def ask_for_something_odd(self, name: str, kind: Kind) -> None:
        tried("inputs: names asked for while plugins come and go")
        with suppress(PhframeError):
            try:
                create(kind, name, registered=self.found())
            except PhframeError as error:
                a_line(error, 6000)
                raise

    # What always holds

    @invariant()
    def what_is_built_in_is_found(self) -> None:
        found = self.found()
        for entry in builtins().entries:
            assert found.entry(entry.extension.kind, entry.name) == entry
            assert look_up(entry.extension.kind, entry.name) is not None

    @invariant()
    def what_is_listed_is_listed_once_and_leads_there(self) -> None:
        entries = self.found().extensions(Kind.PLANNER)
        assert max(Counter(each.name for each in entries).values()) == 1
        for each in entries:
            assert self.found().entry(Kind.PLANNER, each.name) == each
            assert self.found().entry(Kind.PLANNER, each.qualified_name) == each


class DiscoveryInAnyOrder(RegistryInAnyOrder):
    """The same with distributions that are really there, and are asked in processes of their own."""

    def __init__(self) -> None:
        super().__init__()
        self.broken: set[str] = set()

    def found(self) -> Catalogue:
        return discover(metadata.distributions(path=[str(self.site)]))

    @rule(distribution=DISTRIBUTIONS, names=st.sets(st.sampled_from(NAMES), min_size=1), tries=st.integers(1, 99))
    def install(self, distribution: str, names: set[str], tries: int) -> None:
        self.uninstall(distribution)
        module = f"any_order_{next(SERIAL)}"
        self.offers[distribution] = module, dict.fromkeys(sorted(names), tries)
        source = HEADER + offering(*sorted(names)).replace("MODULE", module).replace("= 3", f"= {tries}")
        self._write(module, source, sound=True)
        info = self._info(distribution)
        info.mkdir()
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {distribution}\nVersion: 1.0\n")
        (info / "entry_points.txt").write_text(f"[phframe]\nplugin = {module}\n")

    @rule(distribution=DISTRIBUTIONS)
    def uninstall(self, distribution: str) -> None:
        shutil.rmtree(self._info(distribution), ignore_errors=True)
        self.broken.discard(distribution)
        super().uninstall(distribution)

    @rule(distribution=DISTRIBUTIONS, how=st.sampled_from(("raise SystemExit(0)", "def f(:", "1/0", "\0")))
    def break_it(self, distribution: str, how: str) -> None:
        super().break_it(distribution, how)
        self._no_longer(distribution)

    @rule(distribution=DISTRIBUTIONS)
    def lose_its_files(self, distribution: str) -> None:
        super().lose_its_files(distribution)
        self._no_longer(distribution)

    def _no_longer(self, distribution: str) -> None:
        """What is broken offers nothing, and is told."""
        if self.offers.pop(distribution, None):
            self.broken.add(distribution)

    def _info(self, distribution: str) -> Path:
        return self.site / f"{distribution.replace('-', '_')}-1.0.dist-info"

    @invariant()
    def what_is_broken_is_told(self) -> None:
        found = self.found()
        assert {each.distribution for each in found.broken} == self.broken
        assert all(a_line(PluginError(str(each))) for each in found.broken)


def _is_ours(module: str) -> bool:
    return module.startswith(("any_order_", "phframe_file_"))


def test_the_registry_in_any_order() -> None:
    run_state_machine_as_test(
        RegistryInAnyOrder, settings=settings(max_examples=many(5), stateful_step_count=25, deadline=None)
    )


@pytest.mark.slow
def test_discovery_in_any_order() -> None:
    run_state_machine_as_test(
        DiscoveryInAnyOrder, settings=settings(max_examples=many(2), stateful_step_count=12, deadline=None)
    )
