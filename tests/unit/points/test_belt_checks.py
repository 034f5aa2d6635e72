"""A quotation is judged: a published drive passes, and with fewer belts or less tension fails for what it lacks."""

from math import pi, sin

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.model import Drive, loads, prepare
from beltdyn.model.demand import required_tension
from beltdyn.points.belt_checks import BeltCheck, verdict_of
from beltdyn.results import Result
from beltdyn.theory.span import open_belt

QUOTATION = """
belt = {{ profile = "SPB", ribs = {belts}{length} }}
limits = {{ service_factor = 1.3 }}
pulley = [
  {{ name = "motor", center = [0, 0], diameter = "280 mm", speed = "1485 rpm" }},
  {{ name = "fan", center = ["1383.5 mm", 0], diameter = "500 mm", inertia = "40 kg m^2", torque = "-1516 N m" }},
]
"""
"""A fan of 132 kW by Optibelt's Technical Manual, its worked example: 7.70, so 8 belts SPB 4000."""


def quoted(belts: int, length: str = ', nominal_length = "4 m"') -> Drive:
    return loads(QUOTATION.format(belts=belts, length=length))


@pytest.fixture(scope="module")
def accepted() -> Result:
    return bd.rating(quoted(8, ""))


def test_a_published_drive_passes_with_its_number_of_belts(accepted: Result) -> None:
    dataset = accepted.dataset
    assert str(dataset.attrs["verdict"]).startswith("passes")
    used = 8.0 * dataset.largest_utilization.item() * dataset.belts_factor.item()
    assert used == pytest.approx(
        7.70, rel=0.11
    )  # ours has a factor for belts side by side, and its table another maker
    assert dataset.most_belts_needed == 8
    met = dict(zip(dataset["check"].values.tolist(), dataset.check_met.values.tolist(), strict=True))
    assert met.pop("distance from a standard length") == 0  # the length follows from the tension
    assert set(met.values()) == {1}


def test_without_a_length_the_loads_give_the_tension(accepted: Result) -> None:
    """Optibelt's formula: 593 N a belt at least, of a design power of 171.6 kW; GB/T 13575.1 needs more."""
    drive = quoted(8, "")
    least = required_tension(drive, bd.model.install(drive))
    assert least is not None
    assert least.by_formula["Optibelt"] / 8 == pytest.approx(593.0, rel=0.05)
    assert drive.belt_loads(0).run_in_tension(drive.path) == pytest.approx(
        1.3 * least.by_formula["GB/T 13575.1"], rel=1e-12
    )
    assert accepted.dataset.tension_at_rest.item() == pytest.approx(1.3 * least.tension, rel=0.01)
    choice = next(one for one in prepare(drive).choices if one.key == "belt.length")
    assert "as the loads require" in choice.words
    wrap = open_belt(1.3835, (0.14, 0.25)).wrap[0]
    hub = 2.0 * accepted.dataset.tension_at_rest.item() * sin(0.5 * wrap)
    np.testing.assert_allclose(accepted.dataset.rest_hub_load.values, hub, rtol=1e-3)


def test_a_belt_without_loads_or_rating_needs_a_length() -> None:
    text = QUOTATION.format(belts=8, length="")
    unloaded = text.replace(', torque = "-1516 N m"', "")
    unrated = text.replace('profile = "SPB", ribs = 8', 'profile = "flat-aramid", width = 0.1')
    assert text not in (unloaded, unrated)
    for changed in (unloaded, unrated):
        with pytest.raises(bd.ModelError, match=r"belt\.length is missing"):
            loads(changed)


def test_too_few_belts_and_a_slipping_drive_fail() -> None:
    few = bd.rating(quoted(6, "")).dataset
    assert str(few.attrs["verdict"]).startswith("fails: utilization of the rated power")
    loose = bd.rating(quoted(3))
    verdict = str(loose.dataset.attrs["verdict"])
    assert verdict.startswith("fails: utilization of the rated power, tension at rest, Optibelt, slip safety")
    assert "tension at rest, GB/T 13575.1" in verdict.partition("; not met: ")[2]
    assert any("slips on `motor`" in one for one in loose.warnings)
    power = 1516.0 * 1485.0 * pi / 30.0 * 280.0 / 500.0
    np.testing.assert_allclose(loose.dataset.power.values, [power, -power], rtol=1e-9)


def test_limits_of_the_drive_replace_those_of_the_rating(accepted: Result) -> None:
    """What the verdict judges and the table of limits are one and the same."""
    used, safety = float(accepted.dataset.utilization.max()), float(accepted.dataset.slip_safety.min())
    drive = quoted(8, "")
    for key, limit, met in (
        ("largest_utilization", 1.01 * used, True),
        ("largest_utilization", 0.99 * used, False),
        ("least_slip_safety", 0.99 * safety, True),
        ("least_slip_safety", 1.01 * safety, False),
    ):
        found = bd.rating(drive.replace(limits=drive.limits.replace(**{key: limit})))
        assert str(found.dataset.attrs["verdict"]).startswith("passes" if met else "fails")
        (number,) = [one for one in bd.results.key_numbers(found) if one.key == key]
        assert number.passes is met


@pytest.mark.parametrize(
    ("value", "limit", "at_most", "met"),
    [(1.0, 1.0, True, True), (1.01, 1.0, True, False), (1.0, 1.0, False, True), (0.99, 1.0, False, False)],
)
def test_limits_count_as_met(value: float, limit: float, at_most: bool, met: bool) -> None:
    check = BeltCheck("speed", value, limit, "m/s", at_most)
    assert check.is_met is met
    assert verdict_of([check]) == ("passes" if met else "fails: speed")
    assert not check._replace(value=np.nan).is_met
    assert verdict_of([check._replace(decides=False)]) == ("passes" if met else "passes; not met: speed")


def test_the_sheet_has_the_life_of_finite_elements_and_room_for_the_belts(accepted: Result) -> None:
    drive = accepted.drive
    sheet = bd.sheet(drive, points=2).dataset
    assert sheet.cord_life.item() == pytest.approx(accepted.dataset.cord_life.item(), rel=0.1)  # tensions within 1 %
    assert sheet.center_distance.item() == pytest.approx(1.3835)
    nominal = sheet.nominal_length.item()
    assert sheet.fitting_allowance.item() == pytest.approx(0.015 * nominal)
    assert sheet.tensioning_allowance.item() == pytest.approx(0.03 * nominal)
    np.testing.assert_allclose(sheet.rest_hub_load, accepted.dataset.rest_hub_load, rtol=2e-3)


def test_lengths_that_do_not_fit_have_no_tension_but_a_center_distance() -> None:
    """Its closed form: the path of that distance is as long as the stretched belt."""
    drive = quoted(8)
    sheet = bd.sheet(drive, points=2).dataset
    fits = np.isfinite(sheet.standard_tension.values)
    np.testing.assert_array_equal(sheet.standard.values[fits], [4.0])
    stretched = sheet.standard.values * (1.0 + sheet.tension_at_rest.item() / drive.belt.axial_stiffness)
    stretched /= drive.belt.measured_stretch
    found = [open_belt(one, (0.14, 0.25)).length for one in sheet.standard_center_distance.values.tolist()]
    np.testing.assert_allclose(found, stretched, rtol=1e-4)
    assert sheet.standard_center_distance.values[fits].item() == pytest.approx(1.3835, abs=2e-4)


def test_stock_lengths_are_known() -> None:
    assert {2.12, 2.36, 2.24, 4.0} < set(bd.read_catalogue()["SPB"].lengths)
