from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Invoke

OVERLAPPING = """
phframe: 1
name: crowd
shelf: {depth: 0.5, width: 0.5, height: 0.4}
target: a
objects:
  - {id: a, shape: cylinder, radius: 0.03, height: 0.12, position: [0.3, 0.25]}
  - {id: b, shape: cylinder, radius: 0.03, height: 0.12, position: [0.3, 0.26]}
"""


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["solv"], "Did you mean 'solve'?"),
        (["planners", "phya"], "Did you mean 'phia'?"),
        (["scenes", "viera"], "Did you mean 'vieira'?"),
        (["planners", "--jsn"], "Did you mean '--json'?"),
        (["solve", "--planer", "phia"], "Did you mean '--planner'?"),
        (["solve", "--planner", "phya"], "Did you mean 'phia'?"),
        (["solve", "--backend", "pymonk"], "Did you mean 'pymunk'?"),
        (["solve", "--arm", "plannar"], "Did you mean 'planar'?"),
        (["solve", "--topology", "riper"], "Did you mean 'ripser'?"),
        (["solve", "vieira/basik"], "Did you mean 'vieira/basic'?"),
        (["solve", "viera/basic"], "vieira"),
        (["solve", "absent.yaml"], "absent.yaml: no such file"),
        (["solve", "a", "b"], "unexpected extra argument"),
        (["solve", "--seed", "1.5"], "'--seed'"),
        (["solve", "--seed", "-1"], "greater than or equal to 0"),
        (["solve", "--time-limit", "0"], "'--time-limit'"),
        (["solve", "--time-limit", "nan"], "'--time-limit'"),
        (["solve", "--time-limit", "inf"], "not a finite number"),
        (["solve", "--max-replans", "-1"], "'--max-replans'"),
        (["solve", "--tolerance", "inf"], "not a finite number"),
        (["solve", "--noise", "position=-1"], "greater than or equal to 0"),
        (["solve", "--noise", "nonsense=3"], "There is: friction, position"),
        (["solve", "--noise", "friction"], "not of the form"),
        (["solve", "--option", "margin"], "not of the form key=value"),
        (["solve", "--option", "backnd.step=1"], "Did you mean 'backend'?"),
        (["solve", "--option", "margin=1", "--option", "planner.margin=2"], "given twice"),
        (["solve", "--option", "margn=0.02"], "Did you mean 'margin'?"),
        (["solve", "--option", "margin=wide"], "'margin' is 'wide'"),
        (["solve", "--option", "margin=nan"], "finite"),
        (["solve", "--option", "margin=-1"], "greater than or equal to 0"),
        (["solve", "--option", "arm.link_width=0"], "link_width"),
        (["solve", "--option", "topology.depth=2"], "no option 'depth'"),
        (["solve", "random/1", "--option", "scenes.count=0"], "count"),
        (["solve", "--view", "--no-rerun"], "nothing to view"),
        (["solve", "--planner", "./absent.py:Mine"], "absent.py"),
    ],
    ids=" ".join,
)
def test_bad_input_is_one_clear_line_and_leaves_nothing(
    invoke: Invoke, workplace: Path, arguments: list[str], said: str
) -> None:
    result = invoke(*arguments)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert said in result.stderr
    assert list(workplace.iterdir()) == []


def test_a_scene_that_cannot_be_is_refused_before_anything_is_written(invoke: Invoke, workplace: Path) -> None:
    Path("crowd.yaml").write_text(OVERLAPPING)
    result = invoke("solve", "crowd.yaml", "--json")
    assert result.exit_code == 2
    assert result.stdout == ""
    assert "'a'" in result.stderr.replace('"', "'") or " a " in result.stderr
    assert [each.name for each in workplace.iterdir()] == ["crowd.yaml"]


def test_a_directory_in_use_is_refused(invoke: Invoke) -> None:
    Path("mine").mkdir()
    Path("mine/thesis.tex").write_text("years of work")
    result = invoke("solve", "--out", "mine")
    assert result.exit_code == 2
    assert "--out mine is not empty" in result.stderr
    assert [each.name for each in Path("mine").iterdir()] == ["thesis.tex"]


@pytest.mark.parametrize("out", ["file", "file/below", "a" * 300, "zero\0byte"])
def test_a_path_that_cannot_be_written_is_one_line(invoke: Invoke, workplace: Path, out: str) -> None:
    Path("file").write_text("")
    result = invoke("solve", "--out", out, "--no-rerun")
    assert result.exit_code == 2
    assert result.stderr.startswith("error: ")
    assert result.stderr.count("\n") == 1
    assert [each.name for each in workplace.iterdir()] == ["file"]
