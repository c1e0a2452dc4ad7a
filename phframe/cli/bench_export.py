"""``phframe bench export``: the results of a bench for other programs."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from phframe.cli import completion
from phframe.cli.flags import flag

if TYPE_CHECKING:
    from phframe.bench.export.formats import ResultFormat

Directory = Annotated[str, typer.Argument(metavar="DIR", help="The directory of a bench.")]
Format = Annotated[
    str | None,
    typer.Option(
        "--format",
        metavar="NAME",
        help="csv, parquet: a table with one row per trial; json: settings, environments and results; plannerarena: a "
        "database for OMPL's Planner Arena.",
        show_default="as the name after --out ends, else csv",
        autocompletion=completion.result_formats,
    ),
]
Out = Annotated[str, flag("FILE", "File to write; - is standard output, for csv and json.")]
Force = Annotated[bool, typer.Option("--force", help="Overwrite a file that is there.")]


def export_results(directory: Directory, format_name: Format = None, out: Out = "-", force: Force = False) -> None:
    """Write the results of a bench for other programs.

    The columns and their units are in docs/json.md. Results are read one by one, so a bench may be of any size.
    """
    from phframe.bench.export.content import ExportContent
    from phframe.bench.store import ResultStore
    from phframe.cli.output import Output
    from phframe.core.paths import user_path

    form = _chosen(format_name, out)
    with ResultStore.open(user_path(directory)) as store, closing(store.results()) as results:
        output, content = Output(out, force=force), ExportContent(results, store.settings, store.environments())
        if form.lines is not None:
            output.write_lines(form.lines(content))
        elif form.write is not None:
            write = form.write
            output.write_by(lambda part: write(content, part))


def _chosen(name: str | None, out: str) -> ResultFormat:
    """The format that is asked for, by its name or by that of the file.

    Raises:
        InputError: If there is no such format, or it is none for standard output.
        NotInstalledError: If the library that writes it is not installed.
    """
    from phframe.bench.export.formats import RESULT_FORMATS
    from phframe.cli.needs import require
    from phframe.cli.output import STANDARD_OUTPUT
    from phframe.core import InputError, UnknownNameError

    suffix = Path(out).suffix.lower()
    by_suffix = {form.suffix: known for known, form in RESULT_FORMATS.items()}
    wanted = by_suffix.get(suffix, "csv") if name is None else name
    if wanted not in RESULT_FORMATS:
        raise UnknownNameError("export format", wanted, RESULT_FORMATS)
    form = RESULT_FORMATS[wanted]
    if form.lines is None and out == STANDARD_OUTPUT:
        raise InputError(f"{form.name} is no text: name a file with --out, such as results{form.suffix}")
    if form.module:
        require(form.module, f"the format {form.name!r}", form.extra)
    return form
