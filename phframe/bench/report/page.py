"""A report as one page of HTML that needs nothing else: no network, no file beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib.resources import files

from phframe.bench.report.document import ReportSection
from phframe.bench.report.drawing import SHADES
from phframe.bench.report.styles import DARK, LIGHT, PlannerStyle

_DARK_SHADES = ("#e3e9ef", "#a9b8c6", "#71879b", "#43566a")
"""Of the parts of a whole, on a dark page."""


def as_html(title: str, lead: str, sections: Sequence[ReportSection], looks: Mapping[str, PlannerStyle]) -> str:
    """The page. Whatever stands in names and reasons is text in it, never markup.

    Args:
        title: Its heading.
        lead: What is below that.
        sections: Its sections.
        looks: Of the planners.
    """
    from jinja2 import Environment, StrictUndefined

    text = files(__package__).joinpath("page.html").read_text("utf-8")
    environment = Environment(autoescape=True, undefined=StrictUndefined)
    return environment.from_string(text).render(
        title=title, lead=lead, sections=sections, looks=looks, light=LIGHT, dark=DARK, shades=SHADES,
        dark_shades=_DARK_SHADES,
    )  # fmt: skip
