"""Mutation testing: mutants of a room's code, by cosmic-ray, and those that its tests do not notice.

Everything happens in a copy of the tree. The same seed picks the same mutants of the same code. What a survivor changes is
printed: it is a gap in the tests, code that does nothing, or a change that makes no difference.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import chdir
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from cosmic_ray.commands import init
from cosmic_ray.modules import find_modules
from cosmic_ray.mutating import mutate_and_test
from cosmic_ray.work_db import use_db
from cosmic_ray.work_item import MutationSpec, TestOutcome

ROOT = Path(__file__).resolve().parents[2]
COPIED = ("phframe", "tests", "plugins", "pyproject.toml")
TIMES_AS_LONG = 3.0
"""As the tests take of the code as it is: tests that take longer than that will never end."""
NEAREST = 3
"""Files of tests that are tried before the rest is even collected."""
Position = tuple[int, int]
Span = tuple[Position, Position]


@dataclass(frozen=True, slots=True)
class Room:
    """What mutants are made of, and what is to notice them.

    Attributes:
        code: Modules, or folders of them.
        tests: Files of tests, or folders of them.
        command: Runs such tests.
        excluded: What the names of operators that are of no use begin with, a regular expression.
    """

    code: tuple[Path, ...]
    tests: tuple[Path, ...]
    command: tuple[str, ...]
    excluded: re.Pattern[str]

    @classmethod
    def named(cls, name: str) -> Room:
        """The room of ``rooms.toml`` with a name; ends the program where there is none."""
        settings = tomllib.loads((ROOT / "tests/mutation/rooms.toml").read_text("utf-8"))
        rooms = settings["rooms"]
        if name not in rooms:
            sys.exit(f"there is no room {name!r}: choose one of {', '.join(rooms)}")
        code, tests = (tuple(map(Path, rooms[name][what])) for what in ("code", "tests"))
        return cls(code, tests, tuple(settings["command"]), re.compile("|".join(settings["excluded-operators"])))

    def mutants(self) -> list[MutationSpec]:
        """All that could make a difference, in the order of the code."""
        with use_db("session.sqlite") as session:
            init(find_modules(self.code), session, {})
            found = [mutation for item in session.work_items for mutation in item.mutations]
        idle = {path: [*idle_spans(path.read_text("utf-8"))] for path in {each.module_path for each in found}}
        kept = [each for each in found if not self.excluded.match(each.operator_name)]
        return sorted((each for each in kept if not _is_within(each, idle[each.module_path])), key=place_of)

    def test_files(self) -> list[Path]:
        """The files of its tests."""
        return sorted(file for path in self.tests for file in ([path] if path.is_file() else path.rglob("test_*.py")))

    def command_for(self, *parts: Sequence[Path]) -> str:
        """The command that runs files of tests, in parts, each where those before it pass."""
        commands = [shlex.join([sys.executable, *self.command, *map(str, files)]) for files in parts if files]
        none_chosen = "test $? -eq 5"  # pytest's exit code where a part has only tests that are left out
        return shlex.join(["sh", "-c", " && ".join(f"{{ {command} || {none_chosen}; }}" for command in commands)])


def main() -> None:
    """Try the mutants that the command line asks for."""
    parser = argparse.ArgumentParser(description="Mutation testing of one room.")
    parser.add_argument("room", help="as in rooms.toml")
    parser.add_argument("--sample", type=int, default=0, help="how many mutants, picked at random; 0: all")
    parser.add_argument("--seed", type=int, default=0, help="of the picking")
    parser.add_argument("--only", action="append", help="those at FILE:LINE, as printed; again for more")
    asked = parser.parse_args()
    room = Room.named(asked.room)
    with tempfile.TemporaryDirectory(prefix="phframe-mutants-") as folder, chdir(folder):
        copy_tree(Path(folder))
        every = room.mutants()
        among = [each for each in every if not asked.only or line_of(each) in asked.only]
        picked = random.Random(asked.seed).sample(among, min(asked.sample or len(among), len(among)))
        print(f"{len(picked)} of {len(every)} mutants of {asked.room}", flush=True)
        try_all(room, picked)


def copy_tree(folder: Path) -> None:
    """Copy the project into a folder, and have tests that start there take the code from there."""
    for name in COPIED:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy2(ROOT / name, folder)
    os.environ |= {"PYTHONPATH": str(folder), "PHFRAME_TEST_PROFILE": "mutants"}


def idle_spans(source: str) -> Iterator[Span]:
    """Where no change could matter: annotations and literal types, whether a class has slots, the bare star among parameters."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.arg | ast.AnnAssign) and node.annotation is not None:
            yield _span(node.annotation)
        elif isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and node.value.id == "Literal":
            yield _span(node)
        elif isinstance(node, ast.FunctionDef) and node.returns is not None:
            yield _span(node.returns)
        elif isinstance(node, ast.keyword) and node.arg == "slots":
            yield _span(node)
    for number, line in enumerate(source.splitlines(), start=1):
        for star in re.finditer(r"\*(?=,)", line):
            yield (number, star.start()), (number, star.end())


def _span(node: ast.expr | ast.keyword) -> Span:
    assert node.end_lineno is not None
    assert node.end_col_offset is not None
    return (node.lineno, node.col_offset), (node.end_lineno, node.end_col_offset)


def _is_within(mutant: MutationSpec, spans: Sequence[Span]) -> bool:
    return any(begin <= mutant.start_pos and mutant.end_pos <= end for begin, end in spans)


def place_of(mutant: MutationSpec) -> tuple[str, Position, str, int]:
    """File, line and column, operator, and which of its mutants it is."""
    return str(mutant.module_path), mutant.start_pos, mutant.operator_name, mutant.occurrence


def line_of(mutant: MutationSpec) -> str:
    """File and line."""
    return f"{mutant.module_path}:{mutant.start_pos[0]}"


def try_all(room: Room, mutants: Sequence[MutationSpec]) -> None:
    """Run the tests on the code as it is, then on each mutant, and print what became of it."""
    files, began = room.test_files(), perf_counter()
    if subprocess.run(shlex.split(room.command_for(files)), check=False).returncode:
        sys.exit("the tests fail on the code as it is")
    limit = TIMES_AS_LONG * (perf_counter() - began)
    counts: Counter[str] = Counter()
    for mutant in mutants:
        ordered = nearest_first(mutant.module_path, files)
        result = mutate_and_test([mutant], room.command_for(ordered[:NEAREST], ordered[NEAREST:]), limit)
        became = "timeout" if result.output == "timeout" else result.test_outcome.value
        counts[became] += 1
        print(f"{became}: {line_of(mutant)} {mutant.operator_name}", flush=True)
        if result.test_outcome is TestOutcome.SURVIVED:
            print(result.diff, flush=True)
    print(", ".join(f"{number} {became}" for became, number in sorted(counts.items())))


def nearest_first(module: Path, files: Sequence[Path]) -> list[Path]:
    """Files of tests: first the one of the module's name, then those that name most often what the module defines."""
    defined = [
        node.name
        for node in ast.parse(module.read_text("utf-8")).body
        if isinstance(node, ast.ClassDef | ast.FunctionDef)
    ]
    names = re.compile("|".join(rf"\b{name}\b" for name in (module.stem, *defined)))
    counts = {file: len(names.findall(file.read_text("utf-8"))) for file in files}
    return sorted(files, key=lambda file: (file.stem != f"test_{module.stem}", -counts[file]))


if __name__ == "__main__":
    main()
