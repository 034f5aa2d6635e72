"""Reports in a real browser: on screens of three widths, and printed; run by `make browser`."""

import os
import re
from collections.abc import Callable, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest

import beltdyn as bd
from beltdyn.results import Result

playwright = pytest.importorskip("playwright.sync_api", reason="pip install playwright")
pytestmark = pytest.mark.browser

FETCHING = """() => new Promise(resolve => {
    document.addEventListener("securitypolicyviolation", event => resolve(event.violatedDirective));
    const script = document.createElement("script");
    script.src = "https://cdn.jsdelivr.net/npm/mathjax@3/es5/tex-svg.js";
    document.head.appendChild(script);
})"""
"""What the policy of a page itself says of a script from elsewhere."""
PAPER_WIDTH, PAPER_HEIGHT = 688, 1002
"""What the margins of a report leave of A4, 182 by 265 mm, at 96 to the inch as browsers lay out paper."""
WIDER = """() => [...document.querySelectorAll("main *, body *")].filter(one => {
    for (let outer = one.parentElement; outer; outer = outer.parentElement)
        if (getComputedStyle(outer).overflowX === "auto" && matchMedia("screen").matches) return false;
    const box = one.getBoundingClientRect();
    return box.width > 0 && getComputedStyle(one).position !== "absolute" && box.right > innerWidth + 1;
}).map(one => one.tagName + "." + one.className).slice(0, 5)"""
"""Elements that go past the right edge; on a screen tables may be moved sideways, on paper they may not."""


@pytest.fixture(scope="module")
def reports(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Of steady running, of its modes, of two loads beside each other, and a drive sheet of seven pulleys."""
    folder = tmp_path_factory.mktemp("report")
    drive = bd.loads(files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8"))
    steady = bd.steady_state(drive)
    more = bd.steady_state(drive.with_({"pulley[alternator].load[1].constant": 14.0}))
    shown: dict[str, Result | Sequence[Result]] = {
        "steady": steady,
        "modes": bd.modes(drive, about=steady),
        "several": [steady, more],
    }
    text = files("beltdyn").joinpath("examples", "accessory_drive.toml").read_text(encoding="utf-8")
    text = text.replace('name = "compressor"', 'name = "compressor"\naxial_offset = "0.5 ± 0.9 mm"')
    rows = [f"[[duty]]\nshare = 0.05\nspeed = {80 + 20 * row}\npower = {{ alternator = 500 }}" for row in range(20)]
    drive_sheet = bd.sheet(bd.loads("\n".join([text, *rows])), acceleration="2000 rpm/s")
    assert any("with tolerances, but the belt allows" in one for one in drive_sheet.warnings)
    shown["sheet"] = drive_sheet
    return {name: bd.write_report(one, folder / f"{name}.html") for name, one in shown.items()}


def opened(browser: Any, report: Path, width: int) -> Any:
    page = browser.new_context(viewport={"width": width, "height": 900}).new_page()
    page.set_default_timeout(300_000)
    page.goto(report.as_uri())
    page.locator(".bk-Figure, .motion canvas").first.wait_for()
    return page


@pytest.mark.parametrize("name", ["steady", "modes", "several", "sheet"])
@pytest.mark.parametrize("width", [1600, 1000, 420])
def test_a_report_fits_screens(
    browser: Any, reports: dict[str, Path], width: int, name: str, shoot: Callable[[Any, str], None]
) -> None:
    page = opened(browser, reports[name], width)
    shoot(page, f"report_{name}_{width}")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    page.context.close()


def test_formulas_in_titles_and_names_are_fetched_from_nowhere(browser: Any, tmp_path: Path) -> None:
    """Bokeh would set what stands between such marks with MathJax, which it may fetch; the browser is cut off."""
    text = files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8")
    found = bd.steady_state(bd.loads(text).replace(name=r"$$E = mc^2$$ <img src=https://example.com/a.png>"))
    names = ["$$a$$", r"\(b\)", r"\[c\]"]
    results = [bd.open_result(found.save(tmp_path / f"{name}.nc")) for name in names]
    several: list[Result | Sequence[Result]] = [found, results]
    for number, shown in enumerate(several):
        report = bd.write_report(shown, tmp_path / f"$${number}$$.html")
        context = browser.new_context(offline=True)
        page, asked, faults = context.new_page(), list[str](), list[str]()
        page.on("request", lambda request, asked=asked: asked.append(request.url))
        page.on("pageerror", lambda error, faults=faults: faults.append(str(error)))
        page.on("console", lambda line, faults=faults: faults.append(line.text) if line.type == "error" else None)
        page.set_default_timeout(300_000)
        page.goto(report.as_uri())
        page.locator(".bk-Figure, .motion canvas").first.wait_for()
        page.mouse.wheel(0, 20_000)
        page.wait_for_timeout(2000)
        assert [url for url in asked if not url.startswith(("data:", "blob:"))] == [page.url]
        assert faults == []
        assert page.evaluate(FETCHING) == "script-src-elem"
        context.close()


@pytest.mark.parametrize("name", ["steady", "modes", "several"])
def test_a_report_is_printed_whole(browser: Any, reports: dict[str, Path], name: str, tmp_path: Path) -> None:
    """The first page has the answer with the drive, nothing goes past the edge, and no page is empty."""
    page = opened(browser, reports[name], PAPER_WIDTH)
    page.emulate_media(media="print")
    assert page.evaluate(WIDER) == []
    if name != "several":
        box = page.locator(".top").bounding_box()
        assert box["y"] + box["height"] < PAPER_HEIGHT
    height = page.evaluate("document.documentElement.scrollHeight")
    printed = page.pdf(path=str(Path(os.environ.get("BELTDYN_PICTURES", tmp_path)) / f"{name}.pdf"), format="A4")
    count = len(re.findall(rb"/Type\s*/Page\b", printed))
    assert height / PAPER_HEIGHT <= count <= 2.0 * height / PAPER_HEIGHT + 1.0
    page.context.close()


def test_a_drive_sheet_is_printed_with_its_drive_file(browser: Any, reports: dict[str, Path]) -> None:
    """Of seven pulleys and twenty operating points: tables within the paper, in letters of 5 pt and more."""
    page = opened(browser, reports["sheet"], PAPER_WIDTH)
    page.emulate_media(media="print")
    assert page.evaluate(WIDER) == []
    sizes = page.locator("#tables td").evaluate_all("found => found.map(one => getComputedStyle(one).fontSize)")
    assert min(float(size.removesuffix("px")) for size in sizes) >= 5.0 * 96 / 72
    assert page.locator("#file").is_visible()
    assert page.locator("#signatures").is_visible()
    assert len(re.findall(rb"/Type\s*/Page\b", page.pdf(format="A4", prefer_css_page_size=True))) <= 7
    page.context.close()
