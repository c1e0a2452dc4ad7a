from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Spawn


@pytest.mark.slow
@pytest.mark.parametrize("arguments", [("scenes",), ("planners", "--json"), ("--help",)], ids=" ".join)
def test_a_reader_who_leaves_gets_no_traceback(spawn: Spawn, arguments: tuple[str, ...]) -> None:
    process = spawn(*arguments)
    assert process.stdout is not None
    process.stdout.close()
    assert process.stderr is not None
    assert process.stderr.read() == ""
    process.wait(timeout=30)
    assert process.returncode in (0, 1)


@pytest.mark.slow
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no device that is always full")
def test_output_that_cannot_be_written_is_one_line(spawn: Spawn) -> None:
    with Path("/dev/full").open("w") as full:
        process = spawn("topology", "--json", stdout=full)
        _, err = process.communicate(timeout=30)
    assert process.returncode == 2
    assert err == "error: cannot write the output: no space left on device\n"
