from __future__ import annotations

import re
from pathlib import Path

import pytest

from docs.make_pictures import HERE, PICTURES, main

ROOT = Path(__file__).parents[1]


def test_every_picture_shown_can_be_made_and_no_other() -> None:
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    shown = {name for page in pages for name in re.findall(r"\]\((?:docs/)?images/([^)]+)\)", page.read_text("utf-8"))}
    assert shown == set(PICTURES) == {picture.name for picture in HERE.iterdir()}


def test_without_chromium_the_rest_is_made(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    before = (HERE / "basic-in-rerun.png").read_bytes()
    assert main(["basic-in-rerun.png"]) == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert "Chromium is not installed" in line
    assert (HERE / "basic-in-rerun.png").read_bytes() == before


def test_a_picture_that_does_not_exist_is_told_with_those_that_do(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["none.png"]) == 2
    assert "no picture none.png; there is: basic-in-rerun.png" in capsys.readouterr().err
