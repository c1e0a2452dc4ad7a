"""A figure of matplotlib as PNG, as PDF, or as SVG whose colours and font are the page's, in light and in dark."""

from __future__ import annotations

import io
import re
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

from phframe.bench.report.styles import LIGHT, PlannerStyle

INK, MUTED, GRID, PAPER = "#1c2024", "#60666e", "#dde1e6", "#fefefe"
SHADES = ("#20303f", "#52697f", "#8aa0b4", "#c4d0db")
"""Of the parts of a whole, where colour is not a planner's."""
_VARIABLES = {
    INK: "ink", MUTED: "muted", GRID: "grid", PAPER: "paper",
    **{colour: f"p{i}" for i, colour in enumerate(LIGHT)}, **{shade: f"shade{i}" for i, shade in enumerate(SHADES)},
}  # fmt: skip
_SETTINGS: dict[str, Any] = {
    "font.family": ["DejaVu Sans"], "font.size": 8.5, "axes.titlesize": 9, "axes.titleweight": "bold",
    "axes.titlelocation": "left", "axes.titlepad": 7, "axes.labelsize": 8.5, "axes.labelcolor": MUTED,
    "axes.edgecolor": GRID, "axes.facecolor": "none", "axes.spines.top": False, "axes.spines.right": False,
    "axes.grid": True, "axes.axisbelow": True, "grid.color": GRID, "grid.linewidth": 0.6, "text.color": INK,
    "axes.titlecolor": INK, "xtick.color": GRID, "ytick.color": GRID, "xtick.labelcolor": MUTED,
    "ytick.labelcolor": INK, "xtick.labelsize": 8, "ytick.labelsize": 8.5, "ytick.major.size": 0,
    "ytick.major.pad": 5, "legend.frameon": False, "legend.fontsize": 8.5, "legend.handlelength": 2.6,
    "figure.facecolor": "white",
    "figure.constrained_layout.w_pad": 0.11, "figure.constrained_layout.use": True, "text.parse_math": False,
    "svg.fonttype": "none", "svg.hashsalt": "phframe", "pdf.fonttype": 42, "savefig.dpi": 160,
}  # fmt: skip
_FONT = re.compile(r"font: ((?:[a-z0-9.]+ )*?[0-9.]+px) '[^;\"]*")


@contextmanager
def drawing() -> Iterator[None]:
    """Figures are made and written within this, so that they look alike whatever the user's settings."""
    import matplotlib as mpl

    with mpl.rc_context():
        mpl.rcdefaults()
        parameters: Any = mpl.rcParams
        parameters.update(_SETTINGS)
        yield


def new_figure(width: float, height: float, columns: int, **more: Any) -> tuple[Any, list[Any]]:
    """A figure (inches) with panels beside one another."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height))
    return figure, list(figure.subplots(1, columns, squeeze=False, **more)[0])


def logarithmic(axis: Any, *, fixed: bool = False) -> None:
    """Give a logarithmic axis plain numbers: 0.1, 0.2, 0.5, 1; it is made as long as a decade, so that there are some."""
    from matplotlib.ticker import LogLocator, NullFormatter, NullLocator

    low, high = sorted(axis.get_view_interval())
    if high < 10 * low and not fixed:
        middle = (low * high) ** 0.5
        low, high = middle / 10**0.5, middle * 10**0.5
        axis.set_view_interval(low, high, ignore=True)
    steps = (1.0,) if high > 40 * low else (1.0, 2.0, 5.0)
    axis.set_major_locator(LogLocator(subs=steps))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_locator(NullLocator())
    axis.set_minor_formatter(NullFormatter())


def colour_of(style: PlannerStyle) -> str:
    """In a figure on white."""
    return LIGHT[style.colour]


def shortened(name: str, longest: int = 38) -> str:
    """A name that leaves room for the figure."""
    plain = "".join(letter if letter.isprintable() else "?" for letter in " ".join(name.split()))
    return plain if len(plain) <= longest else f"{plain[: longest - 1]}…"


def _save(figure: Any, stream: io.BytesIO | io.StringIO, **how: Any) -> None:
    """Letters that the font lacks are drawn as boxes, and not complained of. The layout is made once, not at each drawing."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph")
        if (layout := figure.get_layout_engine()) is not None:
            layout.execute(figure)
            figure.set_layout_engine("none")
        figure.savefig(stream, **how)


def as_bytes(figure: Any, form: str) -> bytes:
    """A figure as ``png`` or ``pdf``; the same figure, the same bytes."""
    stream = io.BytesIO()
    _save(figure, stream, format=form, metadata={"CreationDate": None} if form == "pdf" else {"Software": None})
    return stream.getvalue()


def as_svg(figure: Any, name: str, label: str) -> str:
    """A figure as an element of a page.

    Args:
        figure: The figure.
        name: Of the figure in the page, all others having other ones.
        label: What it shows, for those who do not see it.
    """
    stream = io.StringIO()
    _save(figure, stream, format="svg", transparent=True, metadata=dict.fromkeys(_METADATA))
    text = stream.getvalue()
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    text = re.sub(r'\bid="', f'id="{name}-', text)
    text = re.sub(r"url\(#", f"url(#{name}-", text)
    text = re.sub(r'xlink:href="#', f'href="#{name}-', text)
    for colour, variable in _VARIABLES.items():
        text = text.replace(colour, f"var(--{variable})")
    text = re.sub(r'( xmlns(:xlink)?="[^"]*"| version="[^"]*")', "", text)
    text = _FONT.sub(r"font: \1 var(--font)", text)
    return _opened(text, label)


_METADATA: Sequence[str] = ("Creator", "Date", "Format", "Type")


def _opened(text: str, label: str) -> str:
    """The opening tag without a size, so that the figure is as wide as its place."""
    from html import escape

    box = re.search(r'viewBox="[^"]*"', text)
    assert box is not None, "matplotlib writes one"
    return f'<svg {box[0]} role="img" aria-label="{escape(label)}">{text[text.index(">") + 1 :]}'
