from __future__ import annotations

from phframe.cli.document import document
from tests.cli.conftest import ROOT


def test_the_reference_is_what_the_commands_say() -> None:
    written = (ROOT / "docs" / "cli.md").read_text(encoding="utf-8")
    assert written == document(), "renew it: python -m phframe.cli.document > docs/cli.md"
