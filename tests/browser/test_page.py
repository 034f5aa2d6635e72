"""The page in a real browser, drag by drag; run by `make browser`."""

import random
import re
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api", reason="pip install playwright")
pytestmark = pytest.mark.browser

Open = Callable[..., Any]
Shoot = Callable[[Any, str], None]


def middle(page: Any, selector: str) -> tuple[float, float]:
    box = page.locator(selector).first.bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def drag(page: Any, selector: str, right: float, down: float) -> None:
    x, y = middle(page, selector)
    page.mouse.move(x, y)
    page.mouse.down()
    for part in range(1, 9):
        page.mouse.move(x + right * part / 8, y + down * part / 8)
        page.wait_for_timeout(25)
    page.mouse.up()
    page.wait_for_timeout(400)


def pulley(name: str) -> str:
    return f'[data-pulley="{name}"] .bd-rim'


def place(page: Any, share_x: float, share_y: float) -> None:
    """Double-click on the canvas, once nothing lies over it."""
    canvas = page.locator(".bd-canvas")
    box, before = canvas.bounding_box(), page.locator(".bd-pulley").count()
    canvas.dblclick(position={"x": share_x * box["width"], "y": share_y * box["height"]})
    page.wait_for_function(f"document.querySelectorAll('.bd-pulley').length === {before + 1}")


def begin_empty(page: Any) -> None:
    page.get_by_role("button", name="New", exact=True).click()
    page.get_by_text("empty canvas").click()
    page.wait_for_function("document.querySelectorAll('.bd-pulley').length === 0")


def enter(page: Any, label: str, text: str) -> None:
    field = page.get_by_label(label, exact=True).first
    field.fill(text)
    field.press("Enter")
    page.wait_for_timeout(300)


def choose(page: Any, label: str, option: str) -> None:
    """Choose out of a list."""
    page.get_by_label(label).first.click()
    page.get_by_role("option", name=option, exact=True).click()


def choose_analysis(page: Any, name: str) -> None:
    page.get_by_role("button", name="Analyses", exact=True).click()
    page.get_by_label("analysis", exact=True).click()
    page.get_by_role("option", name=re.compile(f"^{name}:")).click()


def analyse(page: Any, name: str, **options: str) -> None:
    """Start an analysis, and wait for its end."""
    choose_analysis(page, name)
    for option, text in options.items():
        page.get_by_role("textbox", name=option, exact=True).fill(text)
    page.get_by_role("button", name="Run", exact=True).click()
    page.get_by_text(f"{name}: completed").wait_for()


def test_a_newcomer_goes_from_an_empty_canvas_to_a_report(shoot: Shoot, open_page: Open, folder: Path) -> None:
    expect, page = playwright.expect, open_page()
    begin_empty(page)
    place(page, 0.3, 0.6)
    place(page, 0.7, 0.6)
    belt = page.locator(".bd-belt:not(.bd-sketch)")
    expect(belt).to_have_count(1)
    before = belt.get_attribute("d")
    drag(page, pulley("driven"), 40, 15)
    expect(belt).not_to_have_attribute("d", before)
    radius = page.get_by_label("radius", exact=True)
    before = radius.input_value()
    drag(page, ".bd-size", 12, 12)
    expect(radius).not_to_have_value(before)
    page.get_by_role("tab", name="belt").click()
    choose(page, "profile", "PJ")
    enter(page, "ribs", "8")
    place(page, 0.5, 0.5)
    side = page.locator('[data-pulley="pulley 3"]')
    side.focus()
    if "bd-back" not in (side.get_attribute("class") or ""):
        page.keyboard.press("b")
    expect(side).to_have_class(re.compile("bd-back"))
    expect(belt).to_have_count(1)
    page.get_by_role("tab", name="tensioner").click()
    page.get_by_role("button", name="add tensioner").click()
    page.get_by_text("rotary", exact=True).click()
    page.get_by_role("button", name="rotary: pulley 3").wait_for()
    page.locator('[data-pulley="driven"]').click()
    page.get_by_role("button", name="add load").click()
    page.get_by_text("resistance", exact=True).click()
    constant = page.get_by_label("constant", exact=True).first
    expect(constant).to_have_value("2")  # a new load is valid
    expect(page.locator(".bd-message:not(.bd-warning)")).to_have_count(0)
    enter(page, "constant", "5 N m")
    expect(page.locator(".bd-message:not(.bd-warning)")).to_have_count(0)
    shoot(page, "newcomer_layout")
    page.get_by_role("button", name="Running").click()
    page.get_by_text("efficiency").first.wait_for()
    page.get_by_text(re.compile("running, computed in")).wait_for()
    shoot(page, "newcomer_running")
    track = page.locator('[aria-label^="load in percent"]').first.bounding_box()
    page.mouse.click(track["x"] + 0.25 * track["width"], track["y"] + 0.5 * track["height"])
    expect(page.get_by_text("load 50 %")).to_have_count(1)
    page.keyboard.press("ArrowRight")
    expect(page.get_by_text("load 55 %")).to_have_count(1)
    page.get_by_text(re.compile("running, computed in")).wait_for()
    page.get_by_role("button", name="Modes").click()
    page.get_by_text(re.compile("modes, computed in")).wait_for()
    shoot(page, "newcomer_modes")
    analyse(page, "traction", points="4")
    analyse(page, "campbell", speed="600..1500 rpm", points="3")
    shoot(page, "newcomer_campbell")
    choose_analysis(page, "simulate")
    page.get_by_role("tab", name="simulation").click()
    enter(page, "duration", "50")
    page.get_by_role("button", name="Run", exact=True).click()
    page.locator(".bd-live").wait_for()
    expect(page.get_by_role("status").filter(has_text="integrating")).to_have_count(1)
    page.get_by_text(re.compile(r"^at 0\.\d+ s; belt tension")).wait_for()  # the picture moves
    shoot(page, "newcomer_watching")
    page.reload()
    page.locator(".bd-live").wait_for()  # the run goes on
    page.get_by_role("button", name="Cancel").click()
    page.get_by_text("simulate: interrupted").wait_for()
    expect(page.locator(".bd-live")).to_have_count(0)
    page.get_by_role("tab", name="simulation").click()
    enter(page, "duration", "30 ms")
    analyse(page, "simulate")
    page.get_by_role("button", name="Show report").first.click()
    report = page.frame_locator("iframe.bd-report")
    report.locator("canvas").first.wait_for()
    report.locator(".bk-Figure").first.wait_for()
    shoot(page, "newcomer_report")
    page.get_by_role("button", name="Close", exact=True).click()
    for button, ending in (("Result file", ".nc"), ("Download report", ".html")):
        with page.expect_download() as kept:
            page.get_by_role("button", name=button, exact=True).first.click()
        assert kept.value.suggested_filename.endswith(ending)
    page.get_by_role("button", name="Save", exact=True).click()
    page.get_by_label("file name").fill("mine")
    page.get_by_role("dialog").get_by_role("button", name="Save").click()
    page.get_by_text("mine.toml", exact=True).wait_for()
    text = (folder / "mine.toml").read_text(encoding="utf-8")
    data = tomllib.loads(text)
    driven = next(one for one in data["pulley"] if one["name"] == "driven")
    assert driven["load"] == [{"kind": "resistance", "constant": "5 N m", "linear": 0.01}]
    assert (data["belt"]["profile"], data["belt"]["ribs"]) == ("PJ", 8)
    assert data["tensioner"][0]["pulley"] == "pulley 3"
    assert "# Speeds, torques and angles are positive counter-clockwise." in text
    assert 'installed_tension = "300 N"  # at rest; the length follows' in text
    begin_empty(page)
    page.get_by_role("button", name="Open", exact=True).click()
    page.get_by_role("dialog").get_by_text("mine.toml").click()
    expect(page.locator(".bd-pulley")).to_have_count(3)
    expect(belt).to_have_count(1)


FAN = """
belt = { profile = "PJ", ribs = 6, installed_tension = "300 N" }
contact = { friction = 0.4 }
simulation = { duration = 0.4, output_interval = "1 ms", frame = "staying" }

[[pulley]]
name = "motor"
center = [0.0, 0.0]
radius = "40 mm"
speed = { kind = "cosine_ramp", start = 0.02, end = 0.2, value = "1500 rpm" }

[[pulley]]
name = "fan"
center = [0.3, 0.0]
radius = "40 mm"
inertia = 0.002
load = [{ kind = "resistance", constant = "5 N m" }]
"""
STUDY = """
number = [{ path = "belt.installed_tension", least = "150 N", largest = "500 N" }]
goal = { result = "hub_load" }
requirement = [{ result = "slip_safety", at_least = 3.0 }]
"""


def test_a_table_of_pulleys_is_read_from_a_file(shoot: Shoot, open_page: Open, folder: Path) -> None:
    (folder / "pulleys.csv").write_text(
        "name;x [mm];y [mm];diameter [mm];side\ncrank;0;0;160;inside\nidler;70;140;70;outside\n"
        "alternator;0;270;56;inside\n",
        encoding="utf-8",
    )
    (folder / "picture.csv").write_bytes(b"\x89PNG\x81\x00\xff")
    expect, page = playwright.expect, open_page()
    page.get_by_role("button", name="New", exact=True).click()
    page.get_by_text("table of pulleys", exact=True).click()
    pasted = page.get_by_label("table of pulleys", exact=True)
    for name in ("picture.csv", "pulleys.csv"):
        with page.expect_file_chooser() as chooser:
            page.get_by_role("button", name="CSV file").click(timeout=60_000)
        chooser.value.set_files(folder / name)
        if name == "picture.csv":
            page.get_by_text("picture.csv is not a text file").wait_for()
    expect(pasted).to_have_value(re.compile("alternator;0;270;56"))
    expect(page.get_by_text("picture.csv is not a text file")).to_be_hidden()
    shoot(page, "table_of_pulleys")
    page.get_by_role("button", name="Use", exact=True).click()
    expect(page.locator('[data-pulley="alternator"]')).to_have_count(1)
    expect(page.locator(".bd-belt:not(.bd-sketch)")).to_have_count(1)
    expect(page.locator('[data-pulley="idler"]')).to_have_class(re.compile("bd-back"))
    expect(page.locator(".bd-message:not(.bd-warning)")).to_have_count(0)


def test_an_optimisation_finds_a_drive_file(shoot: Shoot, open_page: Open, folder: Path) -> None:
    """The least hub load is that at which slip is just as safe as it has to be."""
    (folder / "drive.toml").write_text(FAN, encoding="utf-8")
    (folder / "study.toml").write_text(STUDY, encoding="utf-8")
    page = open_page()
    choose_analysis(page, "optimize")
    page.get_by_role("button", name="Run", exact=True).click()
    page.get_by_text("optimize needs study.").wait_for()
    choose(page, "study", "study.toml")
    page.get_by_role("button", name="Run", exact=True).click()
    page.get_by_text("optimize: completed").wait_for()
    shoot(page, "optimisation")
    safety = page.locator("tr", has_text="slip_safety at least 3").locator("td")
    assert [float(one) for one in safety.all_inner_texts()[1:3]] == pytest.approx([5.49, 3.0], rel=0.01)
    with page.expect_download() as kept:
        page.get_by_role("button", name="Resulting drive file").click()
    best = tomllib.loads(Path(kept.value.path()).read_text(encoding="utf-8"))
    assert 150.0 < float(best["belt"]["installed_tension"].removesuffix(" N")) < 300.0
    page.get_by_role("button", name="Show report").first.click()
    page.frame_locator("iframe.bd-report").get_by_role("heading", name="Provenance").wait_for()


def test_a_drive_sheet_has_its_tables_and_tells_what_is_wrong(shoot: Shoot, open_page: Open) -> None:
    page = open_page()
    choose_analysis(page, "sheet")
    for text, told in (("3000 kg", "must be in units of rad/s"), ("3000 rpm/s", "sheet: completed")):
        page.get_by_role("textbox", name="acceleration", exact=True).fill(text)
        page.get_by_role("button", name="Run", exact=True).click()
        page.get_by_text(told).first.wait_for()
    page.get_by_text("All numbers").locator("visible=true").first.click()
    spans = page.locator("table", has_text="offset")
    playwright.expect(spans.locator("tr", has_text="crank-tensioner").first).to_be_visible()
    for title in ("Tensioner of tensioner", "Operating points", "Belts of standard length"):
        page.get_by_text(title, exact=True).locator("visible=true").first.wait_for()
    shoot(page, "drive_sheet")


PRINTS = "window.print = () => { top.printed = (top.printed || []).concat([document.title]); }"


def test_a_result_is_printed_mailed_and_marked_after_an_edit(shoot: Shoot, open_page: Open) -> None:
    expect, page = playwright.expect, open_page()
    page.context.add_init_script(PRINTS)
    page.reload()
    analyse(page, "steady_state")
    expect(page.get_by_text(re.compile(r"^crank 1500 rpm, 2\.88 kW input"))).to_have_count(1)
    page.get_by_role("button", name="Print or PDF").click()
    page.wait_for_function("(window.printed || []).length === 1")
    with page.expect_download() as kept:
        page.get_by_role("button", name="Mail").click()
    assert kept.value.suggested_filename.endswith(".html")
    shoot(page, "result")
    page.get_by_role("tab", name="belt").click()
    enter(page, "ribs", "8")
    page.get_by_text("steady_state: completed, before the last edits").wait_for()
    shoot(page, "old_result")
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_text("before the last edits")).to_have_count(0)


def test_another_profile_makes_another_valid_drive(shoot: Shoot, open_page: Open) -> None:
    expect, page = playwright.expect, open_page()
    page.get_by_role("tab", name="belt").click()
    for profile, key in (("HTD 8M", "teeth"), ("SPZ", "belts"), ("flat-aramid", "width"), ("PK", "ribs")):
        page.get_by_label("profile").first.fill(profile)
        page.get_by_role("option", name=profile, exact=True).click()
        expect(page.get_by_label(key, exact=True)).not_to_have_value("")
        expect(page.locator(".bd-belt:not(.bd-sketch)")).to_have_count(1)
        expect(page.locator(".bd-message:not(.bd-warning)")).to_have_count(0)
        page.wait_for_timeout(500)
        shoot(page, f"profile_{key}")
    length = page.get_by_label("length", exact=True)
    expect(length).to_have_value("")
    assert 850.0 < float(length.get_attribute("placeholder")) < 950.0


def test_wrong_values_and_layouts_are_told_and_undone(shoot: Shoot, open_page: Open) -> None:
    page = open_page()
    page.locator('[data-pulley="alternator"]').click()
    enter(page, "radius", "28 kg")
    page.get_by_text('pulley[alternator].radius = "28 kg" must be in units of m').first.wait_for()
    assert page.locator(".bd-belt").count() == 0
    shoot(page, "wrong_value")
    enter(page, "radius", "28 mm")
    page.locator(".bd-belt:not(.bd-sketch)").wait_for()
    drag(page, pulley("tensioner"), 250, 0)
    page.get_by_text("the belt would cross itself").wait_for()
    assert page.locator(".bd-sketch").count() == 1
    shoot(page, "wrong_layout")
    page.keyboard.press("Control+z")
    page.locator(".bd-belt:not(.bd-sketch)").wait_for()
    drag(page, pulley("alternator"), 0, 150)
    page.get_by_text("overlap").wait_for()
    page.get_by_role("button", name="Undo").click()
    page.locator(".bd-belt:not(.bd-sketch)").wait_for()


def test_the_keyboard_is_enough(open_page: Open) -> None:
    page = open_page()
    page.locator('[data-pulley="alternator"]').focus()
    for key in ("ArrowRight", "ArrowRight", "+", "ArrowUp"):
        page.keyboard.press(key)  # without a pause: steps add up
    expect = playwright.expect
    expect(page.get_by_label("center", exact=True)).to_have_value("2, 271")
    expect(page.get_by_label("radius", exact=True)).to_have_value("29")
    page.keyboard.press("b")
    page.get_by_text("the belt").first.wait_for()
    page.keyboard.press("b")
    page.locator(".bd-belt:not(.bd-sketch)").wait_for()
    page.keyboard.press("Delete")
    page.wait_for_function("document.querySelectorAll('.bd-pulley').length === 2")
    page.keyboard.press("Control+z")
    page.wait_for_function("document.querySelectorAll('.bd-pulley').length === 3")
    page.get_by_role("button", name="Running").focus()
    page.keyboard.press("Enter")
    page.get_by_label("speed in percent of the drive file").wait_for()
    page.get_by_role("button", name="Analyses", exact=True).focus()
    page.keyboard.press("Tab")  # to the slider of speed, and then to that of load
    page.keyboard.press("ArrowLeft")
    expect(page.get_by_text("speed 95 %")).to_have_count(1)
    page.keyboard.press("Tab")
    for _ in range(3):
        page.keyboard.press("ArrowDown")
    expect(page.get_by_text("load 85 %")).to_have_count(1)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1600, 1000, 480])
def test_it_fits_at_three_widths(shoot: Shoot, open_page: Open, width: int, scheme: str) -> None:
    page = open_page(width, 900, scheme)
    page.locator('[data-pulley="tensioner"]').click()
    choose_analysis(page, "duty")  # the one with the longest line
    page.wait_for_timeout(500)
    shoot(page, f"width_{width}_{scheme}")
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    box = page.locator(".bd-canvas").bounding_box()
    assert box["width"] > 0.5 * min(width, 900)


HANDLE = """() => {
    const box = document.querySelector(".bd-size")?.getBoundingClientRect();
    return box && [box.x + box.width / 2, box.y + box.height / 2];
}"""


def test_a_hundred_random_edits_leave_a_page_that_works(open_page: Open) -> None:
    page = open_page()
    generator = random.Random(11)
    for _ in range(100):
        count = page.locator(".bd-pulley").count()
        act = generator.choice(("drag", "drag", "size", "flip", "add", "remove", "undo", "redo", "keys"))
        if count and act == "drag":
            number = generator.randrange(count)
            x, y = middle(page, f".bd-pulley >> nth={number} >> .bd-rim")
            page.mouse.move(x, y)
            page.mouse.down()
            page.mouse.move(x + generator.uniform(-80, 80), y + generator.uniform(-80, 80), steps=4)
            page.mouse.up()
        elif act == "size" and (handle := page.evaluate(HANDLE)):  # at once: an answer of the server may remove it
            x, y = handle
            page.mouse.move(x, y)
            page.mouse.down()
            page.mouse.move(x + generator.uniform(-20, 20), y + generator.uniform(-20, 20), steps=3)
            page.mouse.up()
        elif count and act in ("flip", "keys", "remove"):
            page.locator(".bd-pulley").nth(generator.randrange(count)).focus()
            page.keyboard.press({"flip": "b", "keys": "ArrowLeft", "remove": "Delete"}[act])
        elif act == "add":
            box = page.locator(".bd-canvas").bounding_box()
            x, y = (generator.uniform(0.1, 0.9) for _ in "xy")
            page.mouse.dblclick(box["x"] + x * box["width"], box["y"] + y * box["height"])
        elif act in ("undo", "redo"):
            page.keyboard.press("Control+z" if act == "undo" else "Control+y")
        page.wait_for_timeout(120)
    page.wait_for_timeout(1000)
    undo = page.get_by_role("button", name="Undo")
    while undo.is_enabled():
        undo.evaluate("button => button.click()")  # where it is disabled meanwhile nothing happens
        page.wait_for_timeout(60)
    assert page.locator(".bd-pulley").count() == 3
    assert page.locator(".bd-belt:not(.bd-sketch)").count() == 1


def test_two_tabs_do_not_mix_and_a_page_loaded_again_has_its_drive(open_page: Open) -> None:
    one, other = open_page(), open_page()
    one.locator('[data-pulley="tensioner"]').focus()
    one.keyboard.press("Delete")
    one.wait_for_function("document.querySelectorAll('.bd-pulley').length === 2")
    assert other.locator(".bd-pulley").count() == 3
    one.reload()
    one.wait_for_function("document.querySelectorAll('.bd-pulley').length === 2")


def test_a_server_that_is_killed_is_told_of_and_the_drive_can_be_kept(
    shoot: Shoot, open_page: Open, server: Any
) -> None:
    page = open_page()
    page.locator('[data-pulley="tensioner"]').focus()
    page.keyboard.press("Delete")
    page.wait_for_function("document.querySelectorAll('.bd-pulley').length === 2")
    server.process.kill()
    page.get_by_text("The server has stopped").wait_for()
    shoot(page, "killed")
    with page.expect_download() as kept:
        page.get_by_role("link", name="Keep the drive file").click()
    text = Path(kept.value.path()).read_text(encoding="utf-8")
    assert [one["name"] for one in tomllib.loads(text)["pulley"]] == ["crank", "alternator"]
