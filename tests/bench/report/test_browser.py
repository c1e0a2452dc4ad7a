"""A browser shows the page, light and dark, wide and narrow, and asks nobody for anything."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

import pytest

from docs.chromium import ChromiumPage, find_chromium
from phframe.bench.report.data import BenchSource
from phframe.bench.report.report import BenchReport
from phframe.bench.report.styles import DARK, LIGHT
from tests.bench.report.synthetic import synthetic

BROWSER = find_chromium()
pytestmark = [
    pytest.mark.slow,
    pytest.mark.long,
    pytest.mark.skipif(BROWSER is None, reason="no Chromium is installed"),
]
WIDE, NARROW = 1280, 400


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("report") / "report.html"
    rows = tuple(synthetic(suites={"paper": 6, "near": 4}))
    path.write_text(BenchReport.of([BenchSource("runs/0", rows)]).html, "utf-8")
    return path


def opened(browser: ChromiumPage, page: Path, theme: str = "light", width: int = WIDE) -> None:
    for domain in ("Page", "Runtime", "Log", "Network"):
        browser.do(f"{domain}.enable")
    browser.do("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": theme}])
    browser.do("Emulation.setDeviceMetricsOverride", width=width, height=900, deviceScaleFactor=1, mobile=False)
    browser.do("Page.navigate", url=page.as_uri())
    browser.await_event("Page.loadEventFired")


def evaluated(browser: ChromiumPage, script: str) -> Any:
    found = browser.do("Runtime.evaluate", expression=f"JSON.stringify({script})", returnByValue=True)
    assert "exceptionDetails" not in found, found
    return json.loads(found["result"]["value"])


@pytest.mark.parametrize(("theme", "palette"), [("light", LIGHT), ("dark", DARK)])
def test_a_theme_is_shown_without_error_and_without_network(page: Path, theme: str, palette: tuple[str, ...]) -> None:
    assert BROWSER is not None
    with ChromiumPage(BROWSER, WIDE, 900) as browser:
        opened(browser, page, theme)
        colours = "getComputedStyle(document.querySelector('.swatch')).borderTopColor"
        red, green, blue = (int(palette[0][i : i + 2], 16) for i in (1, 3, 5))
        assert evaluated(browser, colours) == f"rgb({red}, {green}, {blue})"
        paper = evaluated(browser, "getComputedStyle(document.body).backgroundColor")
        assert (sum(map(int, paper[4:-1].split(","))) > 380) == (theme == "light")
        picture = browser.do("Page.captureScreenshot", format="png")
        assert base64.b64decode(picture["data"]).startswith(b"\x89PNG")
        told = ("Log.entryAdded", "Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Network.loadingFailed")
        assert [event for event in browser.events if event.get("method") in told] == []
        asked = [
            e["params"]["request"]["url"] for e in browser.events if e.get("method") == "Network.requestWillBeSent"
        ]
        assert {address for address in asked if not address.startswith("data:")} == {page.as_uri()}


@pytest.mark.parametrize("width", [WIDE, NARROW])
def test_nothing_sticks_out_of_the_page(page: Path, width: int) -> None:
    assert BROWSER is not None
    with ChromiumPage(BROWSER, width, 900) as browser:
        opened(browser, page, width=width)
        assert evaluated(browser, "document.documentElement.scrollWidth") <= width


def test_choosing_planners_leaves_their_rows(page: Path) -> None:
    assert BROWSER is not None
    with ChromiumPage(BROWSER, WIDE, 900) as browser:
        opened(browser, page)
        rows = "[...document.querySelector('#pairs table').tBodies[0].rows].filter(row => !row.hidden).length"
        assert evaluated(browser, rows) == 36
        choose = "(([a, b]) => { a.value = %s; b.value = %s; a.dispatchEvent(new Event('change')); return 0; })"
        selects = "(document.querySelectorAll('#pairs .pick select'))"
        for one, other, left in [("'phia'", "''", 8), ("'phia'", "'ooa'", 1), ("'ooa'", "'phia'", 1), ("''", "''", 36)]:
            evaluated(browser, choose % (one, other) + selects)
            assert evaluated(browser, rows) == left


def test_printing_opens_what_is_folded(page: Path) -> None:
    assert BROWSER is not None
    with ChromiumPage(BROWSER, WIDE, 900) as browser:
        opened(browser, page)
        closed = "document.querySelectorAll('details:not([open])').length"
        assert evaluated(browser, closed) > 0
        printed = base64.b64decode(browser.do("Page.printToPDF")["data"])
        assert printed.startswith(b"%PDF")
        assert evaluated(browser, closed) == 0
