"""Tensioner sheets against closed forms of the balance of slides and arms."""

from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

import beltdyn as bd
import beltdyn.points.tensioner_sheet as sheet_module
from beltdyn.errors import ModelError
from beltdyn.model import Drive, load, loads, prepare
from beltdyn.model.carrier import moved
from beltdyn.points.tensioner_sheet import tensioner_sheet
from beltdyn.solvers.run_progress import Progress

RADIUS, CENTERS, PRELOAD, RATE = 0.05, 0.3, 800.0, 2e4

SLIDE = f"""
[belt]
length = 0.914
width = "20 mm"
density = 1200
youngs_modulus = "5 GPa"
poissons_ratio = 0.3
stretch_law = "linear"
bending_factor = 0.1
thickness = "1 mm"
[contact]
friction = 0.3
[[pulley]]
name = "driver"
center = [0, 0]
radius = {RADIUS}
speed = {{ kind = "constant", value = 10 }}
[[pulley]]
name = "tail"
center = [{CENTERS}, 0]
radius = {RADIUS}
inertia = 0.001
mass = 0.3
[[tensioner]]
kind = "sliding"
pulley = "tail"
direction = [1, 0]
preload = {PRELOAD}
rate = {RATE}
tensioning_friction = 20.0
yielding_friction = 60.0
stops = ["-8 mm", "10 mm"]
stop_stiffness = "1e6 N/m"
[simulation]
duration = 0.1
output_interval = "1 ms"
"""


@pytest.fixture(scope="module")
def slide() -> Drive:
    return loads(SLIDE)


@pytest.mark.slow
def test_a_slide_of_two_equal_pulleys(slide: Drive) -> None:
    """Two spans pull: T = (F - k q) / 2; each meter of travel takes two of belt, and the friction half of itself."""
    sheet = tensioner_sheet(slide, tolerance="3 mm", wear="6 mm").dataset
    there = sheet.sel(state=["upper stop", "worn belt", "longest belt", "nominal belt", "shortest belt", "lower stop"])
    spring = PRELOAD - RATE * there.position
    np.testing.assert_allclose(there.spring_load, spring, rtol=1e-9)
    np.testing.assert_allclose(there.tension, 0.5 * spring, rtol=2e-4)
    np.testing.assert_allclose(there.hub_load, spring, rtol=2e-4)
    np.testing.assert_allclose(np.cos(there.hub_direction), -1.0, rtol=1e-6)
    np.testing.assert_allclose(there.leverage, 2.0, rtol=1e-9)
    np.testing.assert_allclose(there.wrap_angle, np.pi, rtol=1e-9)
    np.testing.assert_allclose(there.position.sel(state=["upper stop", "lower stop"]), [0.01, -0.008], atol=1e-9)
    np.testing.assert_allclose(there.from_free, PRELOAD / RATE - there.position - 0.03, atol=1e-9)
    longer = there.belt_length.sel(state=["worn belt", "longest belt", "shortest belt"])
    np.testing.assert_allclose(longer, 0.914 + np.array([0.009, 0.003, -0.003]), rtol=1e-12)
    shortest = 2.0 * (np.pi * slide.radii[0] + CENTERS - 0.008)
    np.testing.assert_allclose(there.slack, there.belt_length - shortest, atol=1e-9)


def test_dry_friction_leaves_a_band(slide: Drive) -> None:
    """The belt gives way too: by k_b L per tension against the spring's k / 4."""
    sheet = tensioner_sheet(slide, tolerance="3 mm", wear="0 mm").dataset
    row, stops = sheet.sel(state="nominal belt"), sheet.sel(state=["upper stop", "lower stop"])
    np.testing.assert_allclose(stops.position, [0.01, -0.008], atol=1e-9)
    np.testing.assert_allclose(stops.tension, 0.5 * (PRELOAD - RATE * stops.position), rtol=2e-4)
    axial = slide.belt.axial_stiffness / float(row.belt_length)
    held = axial / (axial + 0.25 * RATE)
    assert float(row.tension - row.tension_after_tensioning) == pytest.approx(0.5 * 20.0 * held, rel=0.02)
    assert float(row.tension_after_yielding - row.tension) == pytest.approx(0.5 * 60.0 * held, rel=0.02)


def test_an_arm_balances_the_belt_by_virtual_work() -> None:
    """Moment of the spring over the change of the path's length, from the path alone, for belts of all lengths."""
    drive = load(Path(str(files("beltdyn"))) / "examples" / "alternator_drive.toml")
    result = tensioner_sheet(drive)
    sheet, path, carrier = result.dataset, drive.path, prepare(drive).carriers[0]
    bending = drive.belt.bending_stiffness / float(drive.radii.min()) ** 2  # what the closed form leaves out, N
    assert result.warnings == []
    assert list(sheet.state.values) == ["free arm", "worn belt", "longest belt", "nominal belt", "shortest belt"]
    assert float(sheet.position.sel(state="free arm")) == pytest.approx(np.radians(14.2 / 0.4))
    assert float(sheet.tension.sel(state="nominal belt")) == pytest.approx(300.0, rel=1e-3)
    for state in sheet.state.values[1:]:
        one, step = sheet.sel(state=state), 1e-5
        longer, shorter = (moved(path, [carrier], np.array([float(one.position) + way])) for way in (step, -step))
        by_hand = (14.2 - 0.4 * np.degrees(float(one.position))) / ((longer.length - shorter.length) / (2.0 * step))
        assert float(one.tension) == pytest.approx(by_hand, abs=bending)
        assert float(one.hub_load) == pytest.approx(
            2.0 * float(one.tension) * np.sin(0.5 * float(one.wrap_angle)), rel=0.02
        )
        way = (longer.centers - shorter.centers)[carrier.pulley] / (2.0 * step)
        pull = float(one.hub_load) * np.array([np.cos(one.hub_direction), np.sin(one.hub_direction)])
        assert pull @ way == pytest.approx(-float(one.spring_load), rel=0.02)  # what turns the arm back


@pytest.mark.slow  # kernels of teeth at rest
def test_a_toothed_belt_stretches_and_does_not_wear_long() -> None:
    """Its tensioner stays between its stops by default, and the warnings speak of what is there."""
    drive = load(Path(str(files("beltdyn"))) / "examples" / "timing_drive.toml")
    sheet = tensioner_sheet(drive).dataset
    assert list(sheet.state.values) == ["free arm", "stretched belt", "longest belt", "nominal belt", "shortest belt"]
    over = sheet.belt_length / sheet.belt_length.sel(state="nominal belt") - 1.0
    assert over.values[1:].tolist() == pytest.approx([2e-3, 1e-3, 0.0, -1e-3], abs=1e-12)
    assert (np.diff(sheet.tension.values[1:]) > 0.0).all()


def test_what_a_designer_is_warned_of(slide: Drive, tmp_path: Path) -> None:
    progress = list[Progress]()
    result = tensioner_sheet(slide, tolerance="24 mm", wear="10 %", progress=progress.append)
    assert progress == [Progress(0.0, 0.1, 0.0, 0, "equilibrium")]
    text = "\n".join(result.warnings)
    assert "worn belt: belt.length" in text
    assert "the shortest belt moves the tensioner of tail to its stop at -0.0" in text
    assert "mm too short to be fitted with the tensioner of tail at its lower stop" in text
    assert result.dataset.failure.sel(state="worn belt") != ""
    assert result.dataset.failure.sel(state="nominal belt") == ""
    found = bd.open_result(result.save(tmp_path / "sheet.nc"))
    assert (found.kind, found.dataset.attrs["pulley"]) == ("tensioner_sheet", "tail")


def test_what_has_no_sheet(slide: Drive, drive: Drive) -> None:
    with pytest.raises(ModelError, match="the drive has no moving tensioner"):
        tensioner_sheet(drive)
    with pytest.raises(ModelError, match=r"pulley = 'driver' has no moving tensioner\. Choose from: tail"):
        tensioner_sheet(slide, pulley="driver")
    with pytest.raises(ModelError, match="tolerance = '3' "):
        tensioner_sheet(slide, tolerance="3")
    with pytest.raises(ModelError, match="wear = '-1 %' must be non-negative"):
        tensioner_sheet(slide, wear="-1 %")


def test_once_the_search_takes_too_long_states_are_closed_forms(slide: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    computed = tensioner_sheet(slide).dataset
    monkeypatch.setattr(sheet_module, "_LONGEST_SEARCH", 0.0)
    closed = tensioner_sheet(slide)
    assert "was ended after 0 s of processor time" in closed.warnings[0]
    assert closed.dataset.state.values.tolist() == computed.state.values.tolist()
    np.testing.assert_allclose(closed.dataset.tension, computed.tension, rtol=0.01, atol=1e-9)
