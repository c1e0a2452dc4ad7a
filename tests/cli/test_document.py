from __future__ import annotations

import re

from phframe.cli.document import document
from tests.cli.conftest import ROOT


def test_the_reference_is_what_the_commands_say() -> None:
    written = (ROOT / "docs" / "cli.md").read_text(encoding="utf-8")
    assert written == document(), "renew it: python -m phframe.cli.document > docs/cli.md"


def test_no_row_of_a_table_has_more_cells_than_its_head() -> None:
    rows = [line for line in document().splitlines() if line.startswith("|")]
    assert {len(re.findall(r"(?<!\\)\|", row)) for row in rows} == {3, 4}  # exit codes, options
    assert any(r"SUITE\|SCENE" in row for row in rows)
