"""How quickly the page of `beltdyn app` starts, and how quickly the path of the belt follows a drag in a real browser.

Needs Playwright and a Chromium, as `make browser` does (or BELTDYN_BROWSER names one); without them it fails.
"""

import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from importlib.resources import files
from pathlib import Path
from typing import Any

_NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
_STARTS, _DRAGS = 5, 30
_SETTLED = 20_000
"""Time in which numbers at rest are computed after the page was opened, ms."""
_PROGRAM = "from beltdyn.cli import main; main(['app', '--no-show', 'drive.toml'])"
_WATCH = """() => {
  const waits = window.waits = [];
  let moved = null;
  const watch = (selector, names, then) =>
    new MutationObserver(then).observe(document.querySelector(selector), { attributes: true, attributeFilter: names });
  watch('[data-pulley="tensioner"] .bd-rim', ["cx", "cy"], () => { moved ??= performance.now(); });
  watch(".bd-belt", ["d"], () => { if (moved !== null) { waits.push(performance.now() - moved); moved = null; } });
}"""
"""Notes the time from a move of the pulley, which the browser draws at once, to the change of the belt's path."""


def started(folder: Path) -> tuple[Any, str, float]:
    """Start a server: its process, its address, and how long it took until it answers, s."""
    begun = time.perf_counter()
    process = subprocess.Popen([sys.executable, "-c", _PROGRAM], cwd=folder, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    found = re.search(r"http\S+", process.stdout.readline())
    assert found is not None
    return process, found[0], time.perf_counter() - begun


def drags(page: Any) -> list[float]:
    """Drag a pulley, and give how long the path of the belt takes to follow, ms."""
    page.evaluate(_WATCH)
    box = page.locator('[data-pulley="tensioner"] .bd-rim').bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(_DRAGS):
        page.mouse.move(x + 2.0 * step, y)
        page.wait_for_timeout(250)
    page.mouse.up()
    return list(page.evaluate("window.waits"))


def main() -> None:
    """Measure both."""
    browser = os.environ.get("BELTDYN_BROWSER") or next(filter(None, map(shutil.which, _NAMES)), None)
    try:
        from playwright.sync_api import sync_playwright
    except ModuleNotFoundError:
        browser = None
    if browser is None:
        raise SystemExit("page.py measures nothing: Playwright or Chromium is not installed. See `make browser`.")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        text = files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8")
        (folder / "drive.toml").write_text(text, encoding="utf-8")
        starts = []
        for _ in range(_STARTS):
            process, address, seconds = started(folder)
            starts.append(seconds)
            process.terminate()
            process.wait()
        process, address, _ = started(folder)
        try:
            with sync_playwright() as playing:
                tab = playing.chromium.launch(executable_path=browser, args=["--no-sandbox"]).new_page()
                tab.goto(address)
                tab.wait_for_selector(".bd-belt")
                tab.wait_for_timeout(_SETTLED)
                waits = drags(tab)
        finally:
            process.terminate()
    ninth = statistics.quantiles(waits, n=10)[-1]
    start = f"{statistics.median(starts):.2f} s ({min(starts):.2f} to {max(starts):.2f})"
    follow = f"{statistics.median(waits):.0f} ms, nine of ten in {ninth:.0f} ms"
    sys.stdout.write(f"page: answers after {start}; the path follows a drag in {follow}\n")


if __name__ == "__main__":
    main()
