"""How long a newcomer takes from an empty canvas to a report, with an empty kernel cache: `pytest -s tests/browser`.

He lays out a small accessory drive of his own with the mouse, reads its numbers at rest, gives it a load, computes
steady running, and opens the report. Pauses stand for reading and thinking.
"""

import os
import re
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api", reason="pip install playwright")
pytestmark = pytest.mark.browser

READING = 2_000
"""A pause to look and to think before each step, ms."""
LIMIT = 300.0
"""Time for the whole journey, s."""


@pytest.fixture
def cold_page(
    browser: Any, serve: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Any]:
    """The page in an empty folder, on a machine that has compiled nothing."""
    monkeypatch.setenv("BELTDYN_CACHE_DIR", str(tmp_path / "cache"))
    (tmp_path / "work").mkdir()
    server = serve(tmp_path / "work")
    context = browser.new_context(viewport={"width": 1600, "height": 900})
    context.set_default_timeout(1e3 * LIMIT)
    page = context.new_page()
    page.goto(server.address)
    page.wait_for_selector(".bd-start")
    yield page
    context.close()
    assert "Traceback" not in server.end()


class Journey:
    """Steps of a newcomer, with the time that each has taken."""

    def __init__(self, page: Any) -> None:
        self.page = page
        self.begun = time.monotonic()
        self.told = list[str]()

    def reached(self, what: str) -> None:
        """Note the time, and pause before the next step."""
        self.told.append(f"{time.monotonic() - self.begun:5.0f} s  {what}")
        self.page.wait_for_timeout(READING)

    def place(self, share_x: float, share_y: float) -> None:
        """Double-click on the canvas."""
        canvas, count = self.page.locator(".bd-canvas"), self.page.locator(".bd-pulley").count()
        box = canvas.bounding_box()
        canvas.dblclick(position={"x": share_x * box["width"], "y": share_y * box["height"]})
        self.page.wait_for_function(f"document.querySelectorAll('.bd-pulley').length === {count + 1}")

    def enter(self, label: str, text: str) -> None:
        """Type into a field of the form."""
        field = self.page.get_by_label(label, exact=True).first
        field.fill(text)
        field.press("Enter")
        self.page.wait_for_timeout(READING)

    def click(self, name: str) -> None:
        """Click on a button."""
        self.page.get_by_role("button", name=name, exact=True).first.click()


def test_a_newcomer_has_a_report_within_five_minutes(cold_page: Any, shoot: Callable[[Any, str], None]) -> None:
    expect, page = playwright.expect, cold_page
    journey = Journey(page)
    journey.reached("empty canvas")
    for place in ((0.3, 0.65), (0.7, 0.65), (0.5, 0.25)):
        journey.place(*place)
        journey.reached("a pulley")
    expect(page.locator(".bd-belt:not(.bd-sketch)")).to_have_count(1)
    page.get_by_text("largest hub load").wait_for()
    journey.reached("a belt, with its numbers at rest")
    journey.enter("name", "alternator")
    journey.enter("radius", "30")
    page.get_by_role("button", name="add load").click()
    page.get_by_text("resistance", exact=True).click()
    journey.enter("constant", "6")
    expect(page.locator(".bd-message:not(.bd-warning)")).to_have_count(0)
    journey.reached("a load, with no message of errors")
    shoot(page, "journey_layout")
    journey.click("Running")
    page.get_by_text("efficiency").first.wait_for()
    page.get_by_text(re.compile("^tight ")).wait_for()
    journey.reached("steady running: slip, safety, tight and slack side")
    shoot(page, "journey_running")
    journey.click("Analyses")
    page.get_by_label("analysis", exact=True).click()
    page.get_by_role("option", name=re.compile("^steady_state:")).click()
    journey.click("Run")
    page.get_by_text("steady_state: completed").wait_for()
    journey.click("Show report")
    page.frame_locator("iframe.bd-report").locator(".bk-Figure").first.wait_for()
    shoot(page, "journey_report")
    journey.click("Close")
    with page.expect_download() as kept:
        journey.click("Download report")
    assert kept.value.suggested_filename.endswith(".html")
    journey.reached("a report, downloaded to be mailed")
    sys.stdout.write("\n".join(["", *journey.told, ""]))
    if folder := os.environ.get("BELTDYN_PICTURES"):
        (Path(folder) / "journey.txt").write_text("\n".join(journey.told), encoding="utf-8")
    assert time.monotonic() - journey.begun < LIMIT
