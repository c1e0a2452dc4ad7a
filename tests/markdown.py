"""Reading the project's Markdown: its pages, their blocks, tables and names."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
EXAMPLES = DOCS / "examples"
README = ROOT / "README.md"
PAGES = [README, *sorted(DOCS.glob("*.md"))]


def named(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def each_page(pages: list[Path]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize("page", pages, ids=named)


@dataclass(frozen=True)
class Block:
    """A fenced block, and the file that the comment before it says it is from."""

    page: Path
    number: int
    language: str
    text: str
    source: str | None

    def __str__(self) -> str:
        return f"{named(self.page)}-{self.language}-{self.number}"


@cache
def text_of(page: Path) -> str:
    return page.read_text("utf-8")


def prose_of(page: Path) -> str:
    """A page without its fenced blocks."""
    return re.sub(r"^```.*?^```$", "", text_of(page), flags=re.MULTILINE | re.DOTALL)


def blocks(language: str) -> list[Block]:
    """The blocks of a language in all pages."""
    fence = re.compile(r"(?:^<!-- from (\S+) -->\n)?^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
    found = [
        Block(page, number, match[2], match[3], match[1])
        for page in PAGES
        for number, match in enumerate(fence.finditer(text_of(page)), start=1)
    ]
    return [block for block in found if block.language == language]


def each_block(language: str) -> pytest.MarkDecorator:
    """Every block, marked with the extras that it needs; descriptions of arms are no scenes."""
    found = [block for block in blocks(language) if block.source is None or "/arms/" not in block.source]
    marked = [pytest.param(block, marks=marks_of(re.findall(r"\w+", block.text))) for block in found]
    return pytest.mark.parametrize("block", marked, ids=[str(block) for block in found])


EXTRAS_BY_PART = {
    "mujoco": "mujoco",
    "pybullet": "pybullet",
    "baxter": "baxter",
    "articulated": "baxter",
    "grtc-kinodynamic": "ompl",
}


def marks_of(words: Iterable[str]) -> list[pytest.MarkDecorator]:
    """The extras that words of a command line or of code stand for."""
    needed = sorted({EXTRAS_BY_PART[word] for word in words if word in EXTRAS_BY_PART})
    return [getattr(pytest.mark, f"needs_{extra}") for extra in needed]


def table(page: str, heading: str) -> list[list[str]]:
    """The rows of the first table under a heading, without its head; cells as written, but for backticks around them."""
    _, found, below = text_of(ROOT / page).partition(f"\n## {heading}\n")
    assert found, f"{page} has no heading {heading!r}"
    below = below.partition("\n## ")[0] + "\n"
    match = re.search(r"^\|.*\n\|[-:| ]+\n((?:\|.*\n)+)", below, flags=re.MULTILINE)
    assert match, f"{page}, {heading!r}: no table"
    return [[_bare(cell.strip()) for cell in row.strip("|").split(" |")] for row in match[1].splitlines()]


def _bare(cell: str) -> str:
    return cell[1:-1] if re.fullmatch(r"`[^`]+`", cell) else cell


def column(page: str, heading: str, index: int = 0) -> list[str]:
    return [row[index] for row in table(page, heading)]


def anchors(page: Path) -> set[str]:
    """What the headings of a page are linked by, as GitHub makes it."""
    headings = re.findall(r"^#+ (.+)$", prose_of(page), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def quoted(page: Path) -> list[str]:
    return re.findall(r"`([^`\n]+)`", prose_of(page))


def extras() -> set[str]:
    """The extras in pyproject.toml."""
    return set(tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]["optional-dependencies"])
