"""Standard output belongs to the result, from the first line of the program on."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.faults.plugins.conftest import Bench, made
from tests.faults.plugins.hostile import OFFER, Hostile

pytestmark = pytest.mark.slow

CHATTY = """
import os, subprocess, sys
print("at import")
os.write(1, b"by the system")
from phframe.planners.ooa import OOA

class Mine(OOA):
    def search(self, task):
        print("while planning")
        sys.stdout.write("by the stream")
        if sys.__stdout__ is not None:
            sys.__stdout__.write("by the first stream")
            sys.__stdout__.flush()
        os.write(1, b"by the system")
        subprocess.run([sys.executable, "-c", "print('by a child')"], check=True)
        return super().search(task)
"""
SAYS = """
import os
print("at import")

def say():
    print("one", flush=True)
    os.write(1, b"two\\n")
    os.system("echo three")
"""
NOISE = ("at import", "while planning", "by the system", "by the stream", "by the first stream", "by a child")
SOLVE = ("solve", "vieira/simple-07", "--no-rerun", "--planner", "./mine.py:Mine")


@pytest.fixture
def chatty(bench: Bench) -> Bench:
    (bench.work / "mine.py").write_text(CHATTY)
    return bench


def test_only_the_json_object_is_there(chatty: Bench) -> None:
    done = chatty.run(*SOLVE, "--json")
    assert done.returncode == 0
    assert json.loads(done.stdout)["status"] == "retrieved"
    assert done.stdout.count("\n") == 1
    assert all(noise in done.stderr for noise in NOISE)


def test_only_the_table_is_there(chatty: Bench) -> None:
    done = chatty.run(*SOLVE)
    assert done.returncode == 0
    assert "retrieved" in done.stdout
    assert not any(noise in done.stdout for noise in NOISE)


@pytest.mark.parametrize("closed", ["<&-", ">&-", "2>&-", "<&- >&- 2>&-"])
def test_with_streams_closed_no_noise_comes_into_a_file(chatty: Bench, closed: str) -> None:
    done = chatty.shell(f"{' '.join(SOLVE)} --json --out out {closed}")
    assert done.returncode == 0
    assert json.loads((chatty.work / "out" / "episode.json").read_text())["kind"] == "episode"
    if ">&-" not in closed.replace("2>&-", ""):
        assert done.stdout.count("\n") == 1
        assert json.loads(done.stdout)["status"] == "retrieved"


def test_a_plugin_s_command_has_it_for_itself(tmp_path: Path) -> None:
    command = Hostile("lab-says", None, OFFER.replace("PLANNER", "COMMAND").replace(":Mine", ":say"))
    bench = made(tmp_path, [command])
    (bench.site / "lab_says_class.py").write_text(SAYS)
    done = bench.run("lab-says")
    assert (done.returncode, done.stdout, done.stderr) == (0, "one\ntwo\nthree\n", "at import\n")


def test_tab_offers_names_and_nothing_else(tmp_path: Path) -> None:
    kinds = [
        Hostile("lab-says", None, OFFER.replace("PLANNER", "COMMAND")),
        Hostile("lab-chats", None, f"print('noise'){OFFER}"),
        Hostile("lab-exits", "", "os._exit(0)"),
    ]
    bench = made(tmp_path, kinds)
    for kind in kinds:
        (bench.site / f"{kind.module}_class.py").write_text("open('ran-class', 'w')\nprint('noise')\n")
    (bench.work / "mine.py").write_text("open('ran-file', 'w')\nprint('noise')\n")
    for words, expected in (
        ("phframe lab-", {"lab-says"}),
        ("phframe lab-says --", {"--help"}),
        ("phframe solve --planner ", {"phia", "lab-chats"}),
        ("phframe solve --planner lab-chats --option ", {"arm.link_width="}),
        ("phframe solve --planner ./mine.py:Mine --option ", {"arm.link_width="}),
    ):
        count = len(words.split()) - (not words.endswith(" "))
        done = bench.run(_PHFRAME_COMPLETE="complete_bash", COMP_WORDS=words, COMP_CWORD=str(count))
        assert expected <= set(done.stdout.split())
        assert "noise" not in done.stdout + done.stderr
    assert [path.name for path in bench.work.iterdir()] == ["mine.py"]
