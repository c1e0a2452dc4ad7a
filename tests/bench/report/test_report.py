"""What a report says is what the results say."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import pytest

from phframe.bench.report.data import BenchSource
from phframe.bench.report.document import Column, ReportSection, Table
from phframe.bench.report.outcomes import failures_section, pattern
from phframe.bench.report.report import BenchReport
from phframe.bench.report.styles import DARK, LIGHT, styles
from phframe.bench.statistics import Estimate, wilson
from phframe.bench.statistics_paired import compare
from phframe.bench.trial_result import TrialEnd, TrialResult
from tests.bench.report.synthetic import SKILL, synthetic
from tests.bench.synthetic import hostile_result

pytestmark = pytest.mark.long

HOSTILE = '<script>alert("1")</script> | `x` <img src=http://example.invalid/a.png> & {{ 7*7 }}'
VOID = {"meta", "link", "br", "img", "input", "use", "path", "rect"}


def some(**more: object) -> tuple[TrialResult, ...]:
    wanted = {"planners": ("phia", "ooa", "random-push"), "suites": {"paper": 12}, **more}
    return tuple(synthetic(**wanted))  # type: ignore[arg-type]


def report_of(*sources: tuple[TrialResult, ...]) -> BenchReport:
    return BenchReport.of([BenchSource(f"runs/{i}", rows) for i, rows in enumerate(sources)])


@pytest.fixture(scope="module")
def report() -> BenchReport:
    return report_of(some())


def section(report: BenchReport, name: str) -> ReportSection:
    (found,) = [each for each in report.sections if each.name == name]
    return found


def column(table: Table, name: str) -> list[object]:
    (i,) = [i for i, each in enumerate(table.columns) if each.name == name]
    return [row[i] for row in table.rows]


class Outline(HTMLParser):
    """The tags of a page, which must be nested as they are closed, and its scripts."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in VOID:
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def test_the_summary_is_what_the_results_are(report: BenchReport) -> None:
    (table,) = section(report, "summary").tables
    rows = some()
    assert column(table, "planner") == ["ooa", "phia", "random-push"]
    for name, rate, trials in zip(*(column(table, c) for c in ("planner", "retrieved", "trials")), strict=True):
        of = [row for row in rows if row.planner == name]
        won = sum(row.retrieved for row in of)
        assert trials == len(of)
        assert isinstance(rate, Estimate)
        assert rate.value == pytest.approx(won / len(of))
        assert (rate.low, rate.high) == pytest.approx(wilson(won, len(of)))


def test_pairs_are_compared_as_the_statistics_say(report: BenchReport) -> None:
    (table,) = section(report, "pairs").tables
    by_planner = {n: {(r.suite, r.problem, r.seed): r for r in some() if r.planner == n} for n in ("ooa", "phia")}
    told = compare("ooa", "phia", by_planner["ooa"], by_planner["phia"])
    assert table.rows[0][:3] == ("ooa", "phia", told.pairs)
    assert column(table, "only the first")[0] == told.only_a
    assert len(table.rows) == 3


def test_every_failure_is_listed_once_with_the_command_that_repeats_it(report: BenchReport) -> None:
    keys = re.findall(r"phframe bench replay runs/0 ([0-9a-f]{12})", report.html)
    assert sorted(keys) == sorted(row.key[:12] for row in some() if not row.retrieved)
    assert keys


def test_claims_that_did_not_come_true_are_marked(report: BenchReport) -> None:
    table = section(report, "claims").tables[1]
    false = [row for row in some() if row.claimed == "retrieved" and not row.retrieved]
    marked = [table.rows[i][j] for i, j in table.marked]
    assert sum(int(str(each)) for each in marked) == len(false) > 0
    assert all(table.rows[i][1] == "retrieved" for i, _ in table.marked)


def test_deviations_are_counted(report: BenchReport) -> None:
    (table,) = section(report, "limitations").tables
    told = dict(zip(column(table, "planner"), column(table, "arm tilted"), strict=True))
    assert told["phia"] == sum(row.deviations.get("arm tilted", 0) for row in some() if row.planner == "phia")
    assert told["ooa"] == 0


def test_what_is_in_names_and_reasons_is_text() -> None:
    rows = some(suites={"paper": 6})
    wild = [replace(r, reason=HOSTILE, retrieved=False, claimed="failed", status="failed") for r in rows]
    wild = [replace(r, planner=HOSTILE[:40] if r.planner == "ooa" else r.planner, suite=HOSTILE[:30]) for r in wild]
    report = report_of(tuple(wild))
    outline = Outline(report.html)
    assert outline.open == []
    assert [tag for tag, _ in outline.tags].count("script") == 1
    assert not any(tag in ("img", "iframe", "object") for tag, _ in outline.tags)
    assert HOSTILE in outline.text
    assert "<script>alert" not in report.html
    lines = [line for line in report.markdown.splitlines() if line.startswith("|")]
    assert not any(re.search(r"(?<!\\)[<`]", re.sub(r"`[^`]*`", "", line)) for line in lines)
    assert json.loads(report.json)["sections"]["summary"]


@pytest.mark.slow
def test_texts_that_no_file_can_hold_and_figures_that_are_not_finite_are_told() -> None:
    wild = hostile_result()
    report = report_of((*some(), wild, replace(wild, key="other", planner="x\0\udc80")))
    for text in (report.html, report.markdown, report.json):
        text.encode()
        assert "\0" not in text
    assert Outline(report.html).open == []
    assert json.loads(report.json)["sections"]["bystanders"]
    assert report.figures()


def test_the_page_asks_for_nothing_else(report: BenchReport) -> None:
    outline = Outline(report.html)
    for _, attributes in outline.tags:
        for name in ("src", "href", "xlink:href", "data", "action"):
            assert (attributes.get(name) or "#").startswith(("#", "data:,"))
    assert not re.search(r"https?://|@import", report.html)
    links = {a["href"] for tag, a in outline.tags if tag == "a" and a.get("href")}
    ids = [a["id"] for _, a in outline.tags if "id" in a]
    assert {f"#{each.name}" for each in report.sections} == links
    assert len(ids) == len(set(ids))
    assert {use["href"] for tag, use in outline.tags if tag == "use"} <= {f"#{each}" for each in ids}


def test_no_colour_is_left_that_does_not_follow_the_theme(report: BenchReport) -> None:
    pictures = re.findall(r"<svg.*?</svg>", report.html, flags=re.DOTALL)
    assert len(pictures) >= 5
    assert (
        set(re.findall(r"#[0-9a-f]{6}\b", "".join(re.sub(r'(id|href)="[^"]*"|url\([^)]*\)', "", p) for p in pictures)))
        == set()
    )
    assert "mathdefault" not in report.html


@pytest.mark.slow
def test_the_same_results_make_the_same_files() -> None:
    again = report_of(some())
    first = report_of(some())
    assert first.html == again.html
    assert first.markdown == again.markdown
    assert first.figures() == again.figures()


@pytest.mark.slow
def test_the_figures_are_png_and_pdf_of_each_setting() -> None:
    figures = report_of(some(), some(backend="mujoco", arm="baxter")).figures()
    stems = [
        f"{name}-{setting}"
        for setting in ("mujoco-with-baxter-planned-in-pymunk", "pymunk-with-planar")
        for name in ("bars", "profile", "solved-over-time")
    ]
    assert sorted(figures) == sorted(f"{stem}.{form}" for stem in stems for form in ("png", "pdf"))
    for name, content in figures.items():
        assert content.startswith(b"\x89PNG" if name.endswith("png") else b"%PDF")
        assert b"/CreationDate" not in content


@pytest.mark.slow
@pytest.mark.parametrize(
    "rows",
    [
        some(planners=("phia",)),
        some(suites={"paper": 1}),
        tuple(replace(r, retrieved=False, status="failed", claimed="failed") for r in some()),
        tuple(replace(r, retrieved=True, status="retrieved", reason="") for r in some()),
        tuple(replace(r, end=TrialEnd.CRASHED, retrieved=False, status="", claimed="", reason="") for r in some()),
        tuple(replace(r, planning_time=0.0, pushes=0, execution_time=0.0) for r in some()),
        tuple(r for i, r in enumerate(some()) if (r.planner == "phia") == (i % 2 == 0)),
    ],
    ids=[
        "one planner",
        "one problem",
        "all failed",
        "all retrieved",
        "all crashed",
        "no time",
        "hardly anything in common",
    ],
)
def test_any_results_make_a_report(rows: tuple[TrialResult, ...]) -> None:
    report = report_of(rows)
    assert Outline(report.html).open == []
    assert not re.search(r"\bnan\b|\binf\b", report.html)
    assert json.loads(report.json)["format"] == 1
    assert report.figures()


def test_one_planner_is_not_compared() -> None:
    report = report_of(some(planners=("phia",)))
    assert section(report, "pairs").tables == ()
    assert "nothing to compare" in report.html


def test_many_failures_are_counted_and_some_are_listed() -> None:
    rows = tuple(
        replace(r, retrieved=False, status="failed", reason=f"reason {'abcd'[i % 4]}") for i, r in enumerate(some())
    )
    found = failures_section(report_of(rows).data, listed=8)
    reasons, *lists = found.tables
    assert sum(map(int, map(str, column(reasons, "all")))) == len(rows)
    assert sum(len(each.rows) for each in lists) <= 8
    assert f"{len(rows) - sum(len(each.rows) for each in lists)} further failures" in repr(found.parts[-1])


@pytest.mark.parametrize(
    ("reason", "expected"),
    [
        ("grasp blocked by o7", "grasp blocked by o#"),
        ("no way past o3, o12 and o1: 0.25 m", "no way past o#: # m"),
        ("", "no reason given"),
    ],
)
def test_reasons_that_differ_in_numbers_are_one(reason: str, expected: str) -> None:
    assert pattern(reason) == expected


def test_each_planner_has_a_look_of_its_own() -> None:
    for names in (["a"], list(SKILL), [f"phia[x={i}]" for i in range(12)], [f"p{i}" for i in range(24)]):
        looks = styles(names)
        assert len({(look.colour, look.variant) for look in looks.values()}) == len(names)
    assert len(LIGHT) == len(DARK) == len(set(LIGHT)) == len(set(DARK))
    nine = styles(list(SKILL))
    assert nine["phia"].colour == nine["phia[sweeps=paper]"].colour


def test_the_json_has_every_row_of_every_table(report: BenchReport) -> None:
    content = json.loads(report.json)
    assert [len(t["rows"]) for t in content["sections"]["summary"]] == [
        len(t.rows) for t in section(report, "summary").tables
    ]
    row = content["sections"]["summary"][0]["rows"][0]
    assert set(row["retrieved_percent"]) == {"value", "low", "high", "trials", "scenes"}
    assert 0 <= row["retrieved_percent"]["low"] <= row["retrieved_percent"]["value"] <= 100


@pytest.mark.parametrize(
    ("column", "cell", "text"),
    [
        (Column("a", "%", "number", 1, 100.0), 0.123, "12.3"),
        (Column("a", kind="number", digits=None), 1567.8, "1568"),
        (Column("a", kind="number", digits=None), 0.004567, "0.00457"),
        (Column("p", kind="p"), 0.0004, "< 0.001"),
        (Column("a", kind="number"), 12, "12"),
        (Column("a", kind="number", digits=2), None, "-"),
    ],
)
def test_figures_are_written_in_the_unit_of_their_column(column: Column, cell: float | None, text: str) -> None:
    assert column.text(cell) == text
