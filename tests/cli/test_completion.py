from __future__ import annotations

from pathlib import Path

import pytest

from phframe.cli import completion
from tests.cli.conftest import Run


def test_names_come_from_the_registry() -> None:
    assert [name for name, _ in completion.names("planner")("phia")] == ["phia", "phia[sweeps=paper]"]
    assert [name for name, _ in completion.names("topology")("")] == ["ripser", "single-linkage"]
    assert completion.names("backend")("nothing") == []


def test_scenes_and_scene_files() -> None:
    assert [name for name, _ in completion.scenes("vieira/b")] == ["vieira/basic"]
    Path("shelves").mkdir()
    for name in ("one.yaml", "two.yml", "three.txt"):
        Path("shelves", name).write_text("")
    assert [name for name, _ in completion.scenes("./s")] == ["./shelves/"]
    assert [name for name, _ in completion.scenes("./shelves/")] == ["./shelves/one.yaml", "./shelves/two.yml"]
    assert completion.scenes("./nowhere/") == []


@pytest.mark.slow
def test_the_shell_is_offered_names_and_options(run: Run) -> None:
    words = "phframe solve random/0 --planner ooa --option "
    done = run(_PHFRAME_COMPLETE="complete_bash", COMP_WORDS=words, COMP_CWORD="6")
    assert {"margin=", "arm.link_width=", "scenes.count="} <= set(done.stdout.split())
    assert done.stderr == ""


@pytest.mark.slow
def test_tab_runs_no_file(run: Run) -> None:
    Path("mine.py").write_text("from pathlib import Path\nPath('ran').touch()\n")
    words = "phframe solve random/0 --planner ./mine.py:Mine --arm ./mine.py:Mine --option "
    done = run(_PHFRAME_COMPLETE="complete_bash", COMP_WORDS=words, COMP_CWORD="8")
    assert "scenes.count=" in done.stdout
    assert done.stderr == ""
    assert not Path("ran").exists()
