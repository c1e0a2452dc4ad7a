"""A planner that asks, asked and answered through a real terminal, and by a file of hints."""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.cli.conftest import ROOT, Invoke, Run

if sys.platform == "win32":
    pytest.skip("Windows has no pseudo-terminals", allow_module_level=True)
import pty

SCENE = "vieira/simple-03"
PROMPT = "gives up): "
END_OF_INPUT = "\x04"

pytestmark = pytest.mark.slow


class Terminal:
    """A command in a pseudo-terminal.

    Args:
        arguments: Of ``phframe``.

    Attributes:
        shown: All that it has written.
    """

    def __init__(self, *arguments: str) -> None:
        self._ours, theirs = pty.openpty()
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "TERM": "xterm", "COLUMNS": "100", "LINES": "40"}
        command = [sys.executable, "-m", "phframe", *arguments]
        self.process = subprocess.Popen(command, stdin=theirs, stdout=theirs, stderr=theirs, env=environment)
        os.close(theirs)
        self.shown = ""

    def until(self, text: str | None) -> str:
        """Read until a text has come, or to the end; what came since the last time."""
        begin = len(self.shown)
        while text is None or text not in self.shown[begin:]:
            assert select.select([self._ours], [], [], 60.0)[0], f"nothing more came: {self.shown[-500:]}"
            try:
                read = os.read(self._ours, 65536)
            except OSError:  # Linux says so where nobody has the other end any more
                read = b""
            if not read:
                assert text is None, self.shown[-2000:]
                break
            self.shown += read.decode()
        return self.shown[begin:]

    def type(self, text: str) -> None:
        """Type."""
        os.write(self._ours, text.encode())

    def end(self) -> int:
        """Read to the end; the exit code."""
        self.until(None)
        return self.process.wait(60)

    def close(self) -> None:
        """Leave nothing running."""
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        os.close(self._ours)


@pytest.fixture
def terminal() -> Iterator[Callable[..., Terminal]]:
    """Starts commands in terminals."""
    started: list[Terminal] = []

    def start(*arguments: str) -> Terminal:
        started.append(Terminal(*arguments))
        return started[-1]

    yield start
    for each in started:
        each.close()


def asked(terminal: Callable[..., Terminal], *arguments: str) -> Terminal:
    found = terminal("solve", SCENE, "--planner", "guided", "--no-rerun", "--out", "run", *arguments)
    found.until(PROMPT)
    return found


def test_a_person_is_shown_the_shelf_asked_refused_and_obeyed(terminal: Callable[..., Terminal], run: Run) -> None:
    screen = asked(terminal)
    assert "object_3 (x) blocks the way to target (*). What is to go where?" in screen.shown
    assert "+ x = 0.55 m" in screen.shown
    assert "x = 0: the mouth" in screen.shown
    screen.type("over there\n")
    assert "Expected OBJECT X Y, such as: object_3 0.25 0.41" in screen.until(PROMPT)
    screen.type("object_9 0.2 0.2\n")
    again = screen.until(PROMPT)
    assert "That cannot be: no object named 'object_9'." in again
    assert "+ x = 0.55 m" in again  # the picture is drawn anew
    screen.type("3 0.2 0.9\n")
    assert "(0.2, 0.9) is not inside the shelf for object_3" in screen.until(PROMPT)
    screen.type("3, 0.2, 0.2\n")
    assert screen.end() == 0
    assert "retrieved" in screen.shown
    assert not [path for path in Path().iterdir() if path.name != "run"]
    repeated = run("replay", "run")
    assert (repeated.returncode, repeated.stdout) == (0, "the same, bit by bit: retrieved, pushes 1, replans 0\n")


def test_the_end_of_the_input_is_a_result(terminal: Callable[..., Terminal], run: Run) -> None:
    screen = asked(terminal, "--json")
    screen.type(END_OF_INPUT)
    assert screen.end() == 1
    assert "no hint what to do about object_3" in json.loads(Path("run/summary.json").read_text())["reason"]
    assert run("replay", "run").returncode == 0


def test_ctrl_c_ends_the_question_as_it_ends_everything(terminal: Callable[..., Terminal]) -> None:
    screen = asked(terminal)
    screen.process.send_signal(signal.SIGINT)
    assert screen.end() == 130
    assert "interrupted" in screen.shown
    assert "Traceback" not in screen.shown


def test_where_there_is_no_terminal_nobody_is_asked(run: Run) -> None:
    result = run("solve", SCENE, "--planner", "guided", "--no-rerun", "--json")
    assert result.returncode == 1
    assert "--option hints=FILE" in json.loads(result.stdout)["reason"]
    assert PROMPT not in result.stderr


def test_a_file_of_hints_takes_the_place_of_a_person(invoke: Invoke) -> None:
    Path("hints.yaml").write_text("- object: object_3\n  to: [0.2, 0.2]\n")
    result = invoke(
        "solve", SCENE, "--planner", "guided", "--option", "hints=hints.yaml", "--no-rerun", "--json", "--out", "run"
    )
    assert (result.exit_code, json.loads(result.stdout)["status"]) == (0, "retrieved")
    Path("hints.yaml").unlink()
    assert invoke("replay", "run").exit_code == 0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("- object: object_33\n  to: [0.2, 0.2]\n", "hints.yaml: line 1: no object named 'object_33'. Did you mean"),
        ("\n- object: object_3\n  to: [0.2, 7]\n", "hints.yaml: line 2: (0.2, 7) is not inside the shelf for object_3"),
        ("- object: object_3\n  too: [0.2, 0.2]\n", "hints.yaml: line 2: unknown key 'too'"),
    ],
)
def test_a_bad_file_of_hints_is_one_line_and_bad_input(invoke: Invoke, text: str, said: str) -> None:
    Path("hints.yaml").write_text(text)
    result = invoke("solve", SCENE, "--planner", "guided", "--option", "hints=hints.yaml", "--no-rerun")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"error: {said}")
    assert len(result.stderr.splitlines()) == 1
    assert [path.name for path in Path().iterdir()] == ["hints.yaml"]
