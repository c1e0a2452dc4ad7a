"""A class of a plugin that is asked for by its name: whatever it does when it is imported and made is one line."""

from __future__ import annotations

import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from tests.faults.plugins.conftest import Bench, made
from tests.faults.plugins.hostile import BAD_CLASS, BAD_TEXT, CLASS, Hostile
from tests.trials import TIMES

pytestmark = pytest.mark.slow

BY_IMPORT = {
    "exits": ("import sys; sys.exit(0)", "SystemExit: 0"),
    "base-exception": ("class Mine(BaseException): pass\nraise Mine('oh')", "Mine: oh"),
    "no-text": (BAD_TEXT, "it cannot say what is wrong"),
    "no-class": (BAD_CLASS, "it cannot say what is wrong"),
    "recursion": ("def f(): f()\nf()", "RecursionError"),
    "syntax": ("def f(:", "SyntaxError"),
    "absent": ("x = 3", "AttributeError"),
    "no-attribute": ("def __getattr__(name): raise SystemExit(name)", "SystemExit: Mine"),
    "long": ("raise ValueError('x' * 10**7)", "ValueError: xxx"),
    "function": ("def Mine(): pass", "is not a subclass of phframe.core.Planner"),
    "moves": ("import os; os.chdir('/'); raise ValueError('moved')", "ValueError: moved"),
    "chats": ("import os; print('noise'); os.write(1, b'noise'); raise ValueError('chat')", "ValueError: chat"),
    "no-output": ("import sys; sys.stdout.close(); sys.stdout = None; raise ValueError('shut')", "ValueError: shut"),
}
"""What the module of a class does, and what is said of it."""
BY_MAKING = {
    "abstract": ("from phframe.core import Planner, Options\nclass Mine(Planner[Options]):\n    options_type = Options", "search"),
    "odd-abstract": (f"{CLASS}\nMine.__abstractmethods__ = {{3: 4}}", "TypeError"),
    "made-exits": (f"{CLASS}    def __init__(self, options): raise SystemExit(0)", "cannot be made: SystemExit: 0"),
    "made-raises": (f"{CLASS}    def __init__(self, options): 1 / 0", "cannot be made: ZeroDivisionError"),
    "no-options": (f"{CLASS}    options_type = None", "cannot be made: AttributeError"),
}  # fmt: skip
"""The same of the class."""
SUITE = """
import os
from phframe.core import Options, SceneSuite
print("noise")
class Mine(SceneSuite[Options]):
    options_type = Options
    def names(self):
        BODY
    def load(self, name):
        return name
"""
SOLVE = ("solve", "vieira/simple-07", "--no-rerun", "--json", "--planner")


def installed(folder: Path, source: str) -> Bench:
    bench = made(folder, [Hostile("lab-class", None)])
    (bench.site / "lab_class_class.py").write_text(source)
    return bench


@pytest.mark.parametrize("command", [("planners", "lab-class", "--json"), (*SOLVE, "lab-class")][:TIMES])
@pytest.mark.parametrize("kind", BY_IMPORT)
def test_what_it_does_when_it_is_imported_is_one_line(tmp_path: Path, kind: str, command: tuple[str, ...]) -> None:
    source, said = BY_IMPORT[kind]
    check(installed(tmp_path, source).run(*command), "planner 'lab-class'", said)


@pytest.mark.parametrize("kind", BY_MAKING)
def test_what_it_does_when_it_is_made_is_one_line(tmp_path: Path, kind: str) -> None:
    source, said = BY_MAKING[kind]
    check(installed(tmp_path, source).run(*SOLVE, "lab-class"), "planner 'lab-class'", said)


@pytest.mark.parametrize("kind", ["exits", "base-exception", "no-class", "no-attribute", "chats", "no-output"])
def test_so_it_is_in_a_file(tmp_path: Path, kind: str) -> None:
    source, said = BY_IMPORT[kind]
    bench = made(tmp_path)
    (bench.work / "mine.py").write_text(source)
    check(
        bench.run("planners", "./mine.py:Mine", "--json"),
        "./mine.py cannot" if kind == "no-attribute" else "mine.py",
        said,
    )


def check(done: subprocess.CompletedProcess[str], who: str, said: str) -> None:
    """It is bad input, told in a line after whatever the plugin has printed."""
    assert (done.returncode, done.stdout) == (2, "")
    line = done.stderr.replace("noise", "").strip()
    assert line.startswith(f"error: {who}")
    assert said in line
    assert "\n" not in line
    assert len(line) < 900


@pytest.mark.parametrize("where", ["lab-class", "./mine.py:Mine"])
def test_moving_away_moves_no_result(tmp_path: Path, where: str) -> None:
    bench = installed(tmp_path, f"import os; os.chdir('/')\n{CLASS}")
    (bench.work / "mine.py").write_text(f"import os; os.chdir('/')\n{CLASS}")
    done = bench.run(*SOLVE, where, "--out", "here")
    assert (done.returncode, done.stderr) == (0, "")
    assert (bench.work / "here" / "episode.json").exists()


def test_suites_of_scenes_are_asked_for_their_names_elsewhere(tmp_path: Path) -> None:
    suites = {
        "lab-suite": "return ['one', 'two']",
        "lab-exits": "os._exit(0)",
        "lab-endless": "return (str(n) for n in iter(int, 1))",
        "lab-odd": "return ['a\\nb', 3]",
    }
    bench = made(tmp_path)
    for name, body in suites.items():
        kind = Hostile(name, None)
        replace(kind, source=kind.source.replace("PLANNER", "SCENES")).install(bench.site)
        (bench.site / f"{kind.module}_class.py").write_text(SUITE.replace("BODY", body))
    done = bench.run("scenes")
    assert (done.returncode, done.stderr) == (0, "")
    assert "lab-suite/one, lab-suite/two" in done.stdout
    assert "noise" not in done.stdout
    for line in (
        "lab-exits 1.0: scenes 'lab-exits': asked what it offers, it ended the process with exit code 0",
        "lab-endless 1.0: scenes 'lab-endless': it lists more than 10000 scenes",
        "lab-odd 1.0: scenes 'lab-odd': it has a scene whose name is no line",
    ):
        assert line in done.stdout
    done = bench.run("solve", "lab-suite/one", "--no-rerun", "--json")
    assert (done.returncode, done.stdout) == (2, "")
    assert "error: the suite of scenes 'lab-suite' has a str for 'one', not a Scene" in done.stderr
