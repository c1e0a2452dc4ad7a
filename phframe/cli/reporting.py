"""What ``phframe report`` does: read the benches, check where the files are to be, make them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from phframe.cli.console import emit
from phframe.cli.needs import require
from phframe.cli.output import STANDARD_OUTPUT, Output
from phframe.core import InputError, OptionError

PAGE = "report.html"
"""What the page is called in the directory of the first bench."""


@dataclass(frozen=True, slots=True)
class ReportRequest:
    """What ``phframe report`` was asked for.

    Attributes:
        benches: Their directories.
        out: Path of the page, or ``-``; None: beside the results.
        figures: Directory for figures; None: none.
        markdown: Path of the tables as Markdown, or ``-``; None: none.
        force: Whether files may be overwritten.
        as_json: Whether the tables are printed as JSON.
    """

    benches: tuple[Path, ...]
    out: str | None
    figures: str | None
    markdown: str | None
    force: bool
    as_json: bool


def run(wanted: ReportRequest) -> None:
    """Make what is wanted.

    Raises:
        PhframeError: If a directory holds no bench or no results, a file cannot be written, or a library is missing.
            Nothing was written then.
    """
    _check(wanted)
    for library in ("jinja2", "matplotlib"):
        require(library, "the report", "report")
    from phframe.bench.report.report import BenchReport, read_bench

    sources = [read_bench(directory) for directory in wanted.benches]
    asked = str(wanted.benches[0] / PAGE) if wanted.out is None else wanted.out
    page = Output(asked, force=wanted.force or wanted.out is None)
    figures = None if wanted.figures is None else Output(wanted.figures, force=wanted.force, folder=True)
    markdown = None if wanted.markdown is None else Output(wanted.markdown, force=wanted.force)
    made = BenchReport.of(sources)
    page.write(made.html)
    if figures is not None:
        figures.write_folder(made.figures())
    if markdown is not None:
        markdown.write(made.markdown)
    if wanted.as_json:
        emit(made.json)


def _check(wanted: ReportRequest) -> None:
    if len(set(wanted.benches)) < len(wanted.benches):
        raise InputError("the same directory is named twice: name each bench once")
    printed = [wanted.out == STANDARD_OUTPUT, wanted.markdown == STANDARD_OUTPUT, wanted.as_json]
    if sum(printed) > 1:
        raise OptionError("only one of --out -, --markdown - and --json can have the standard output")
    if wanted.figures == STANDARD_OUTPUT:
        raise OptionError("figures are several files: name a directory with --figures DIR")
