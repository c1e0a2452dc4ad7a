"""A report from results: its sections, its page, its tables, its figures."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from phframe.bench.report.bars import draw_bars
from phframe.bench.report.charts import draw_profiles, draw_solved_over_time
from phframe.bench.report.data import ALL, BenchSource, Group, ReportData, gather
from phframe.bench.report.document import ReportSection
from phframe.bench.report.drawing import as_bytes, drawing
from phframe.bench.report.outcomes import bystanders_section, claims_section, failures_section, prediction_section
from phframe.bench.report.overview import limitations_section, run_section, summary_section
from phframe.bench.report.page import as_html
from phframe.bench.report.plots import (
    bars_section,
    cost_section,
    curves_of,
    distributions_section,
    pairs_section,
    profile_section,
    profiles_of,
    time_section,
)
from phframe.bench.report.styles import PlannerStyle, styles
from phframe.bench.report.summary import GroupSummary, summarise
from phframe.bench.report.texts import as_json, as_markdown
from phframe.bench.store import ResultStore
from phframe.core import Value

FORMS = ("png", "pdf")
"""Of the figures."""


def read_bench(directory: Path) -> BenchSource:
    """The bench in a directory.

    Raises:
        InputError: If there is none, or it cannot be read.
    """
    with ResultStore.open(directory) as store:
        return BenchSource(str(directory), tuple(store.results()), store.settings, store.environments())


@dataclass(frozen=True, slots=True, eq=False)
class BenchReport(Value):
    """A report.

    Attributes:
        data: What is reported.
        summaries: Of its groups.
        looks: Of its planners.
        sections: What it says.
    """

    data: ReportData
    summaries: tuple[GroupSummary, ...]
    looks: Mapping[str, PlannerStyle]
    sections: tuple[ReportSection, ...]

    @classmethod
    def of(cls, sources: Sequence[BenchSource]) -> BenchReport:
        """The report of one or several benches.

        Raises:
            InputError: If there is nothing to report.
        """
        data = gather(sources)
        summaries, looks = summarise(data), styles(data.planners)
        with drawing():
            sections = (
                run_section(data), summary_section(summaries), bars_section(summaries, looks),
                distributions_section(data, looks), profile_section(data, looks), time_section(data, looks),
                pairs_section(data), cost_section(data), claims_section(data), bystanders_section(data),
                failures_section(data), prediction_section(data), limitations_section(data),
            )  # fmt: skip
        return cls(data, summaries, looks, sections)

    @property
    def title(self) -> str:
        """Its heading."""
        suites = dict.fromkeys(group.suite for _, groups in self.data.settings for group in groups)
        return f"Bench of {', '.join(suites)}"

    @property
    def html(self) -> str:
        """The page."""
        results = self.data.results
        retrieved = sum(result.retrieved for result in results)
        lead = (
            f"{len(results)} trials of {len(self.data.planners)} planners, {retrieved} retrieved their target. "
            "Every figure says what it is of; intervals are of 95 %."
        )
        return _encodable(as_html(self.title, lead, self.sections, self.looks))

    @property
    def markdown(self) -> str:
        """Its tables for a document."""
        return _encodable(as_markdown(self.title, self.sections))

    @property
    def json(self) -> str:
        """Its tables for programs."""
        return as_json(self.title, self.sections)

    def figures(self) -> dict[str, bytes]:
        """The bar charts, performance profile and solved-over-time of each setting as PNG and PDF, by file name."""
        found: dict[str, bytes] = {}
        with drawing():
            for setting, groups in self.data.settings:
                whole = self._whole(setting)
                for name, draw in self._drawn(groups, whole).items():
                    figure = draw()
                    stem = f"{name}-{_slug(setting)}"
                    found.update({f"{stem}.{form}": as_bytes(figure, form) for form in FORMS if figure is not None})
        return found

    def _whole(self, setting: str) -> Group:
        """All suites of a setting, or its only one."""
        groups = [group for group in self.data.groups if group.setting == setting]
        return next((group for group in groups if group.suite == ALL), groups[0])

    def _drawn(self, groups: Sequence[Group], whole: Group) -> dict[str, Callable[[], Any]]:
        shown = [each for each in self.summaries if each.group in groups]
        _, profiles = profiles_of(whole)
        end, curves = curves_of(whole, self.data.limits)
        return {
            "bars": lambda: draw_bars(shown, self.looks, headed=len(shown) > 1),
            "profile": lambda: draw_profiles(profiles, self.looks) if profiles else None,
            "solved-over-time": lambda: draw_solved_over_time(curves, end, self.looks),
        }


def _encodable(text: str) -> str:
    """Text as files can hold it: halves of surrogate pairs and what pages may not hold are replaced."""
    return _UNREADABLE.sub("\N{REPLACEMENT CHARACTER}", text)


_UNREADABLE = re.compile("[\ud800-\udfff\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]")


def _slug(name: str) -> str:
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")
