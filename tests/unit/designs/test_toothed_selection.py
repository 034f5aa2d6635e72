"""Selected toothed drives: standard teeth, belts and widths that carry the power with a tight slack span."""

from math import inf, pi
from typing import Any

import numpy as np
import pytest

from beltdyn.designs.proposal import Proposal, Task
from beltdyn.designs.selection import select
from beltdyn.designs.toothed_selection import TEETH, _pairs
from beltdyn.errors import ModelError
from beltdyn.model import install, prepare, read_catalogue
from beltdyn.model.advice import advise
from beltdyn.results.means import rate
from beltdyn.theory.rating import REST_SHARE
from beltdyn.theory.span import open_belt

RPM = 30.0 / pi
TASK: dict[str, Any] = {"power": "3 kW", "speed": "1450 rpm", "driven_speed": "725 rpm", "service_factor": 1.4}


@pytest.fixture(scope="module")
def found() -> tuple[Proposal, ...]:
    return select(**TASK, toothed=True, largest_driven="250 mm", count=8)


def test_numbers_of_teeth_ascend_and_large_ones_are_even() -> None:
    """As makers stock them, but for 45."""
    assert list(TEETH) == sorted(set(TEETH))
    assert [teeth for teeth in TEETH if teeth > 30 and teeth % 2] == [45]


def test_they_are_made_of_standard_parts_and_carry_the_power(found: tuple[Proposal, ...]) -> None:
    assert len(found) == 8
    for one in found:
        entry = read_catalogue()[one.profile]
        assert entry.tooth_rating is not None
        assert entry.toothing is not None
        assert one.teeth is not None
        belt, driver, driven = one.teeth
        assert belt in entry.tooth_counts
        assert {driver, driven} <= set(TEETH)
        assert one.face_width in entry.tooth_rating.widths
        assert one.driven_diameter <= 0.25
        assert one.driven_speed == pytest.approx(1450.0 / RPM * driver / driven)
        assert one.driven_speed == pytest.approx(725.0 / RPM, rel=0.03)
        assert one.utilization == pytest.approx(1.4 * 3e3 / one.rated_power)
        assert one.utilization <= 1.0
        radii = [0.5 * entry.toothing.pitch * z / pi for z in (driver, driven)]
        assert open_belt(one.distance, (radii[0], radii[1])).length == pytest.approx(belt * entry.toothing.pitch)
        assert one.nominal_length == pytest.approx(belt * entry.toothing.pitch)
        assert 0.7 <= one.distance / (2.0 * sum(radii)) <= 2.0


def test_the_center_distance_lies_in_its_range() -> None:
    for least, largest in ((0.3, 0.4), (0.5, 0.52)):
        proposals = select(**TASK, toothed=True, distance=f"{least}..{largest} m", count=3)
        assert all(least <= one.distance <= largest for one in proposals)


def test_no_pulley_is_smaller_than_the_smallest_of_the_profile() -> None:
    """All others with the ratio are tried."""
    entry, task = read_catalogue()["HTD 8M"], Task(1e3, 20.0, 10.0, 1.0, None, (inf, inf), 0.03, 1)

    def diameters(smallest: float | None) -> list[float]:
        pairs = _pairs(entry.replace(smallest_diameter=smallest), task)
        return [2.0 * pair.radii[0] - 2.0 * entry.pitch_offset for pair in pairs]

    free = diameters(None)
    assert min(free) < 0.03
    for smallest in (0.06, 0.12):
        assert diameters(smallest) == [one for one in free if one >= 0.999 * smallest]


def test_the_next_narrower_belt_would_not_do(found: tuple[Proposal, ...]) -> None:
    for one in found:
        rating = read_catalogue()[one.profile].tooth_rating
        assert rating is not None
        narrower = max((width for width in rating.widths if width < one.face_width), default=0.0)
        assert one.utilization * one.face_width > narrower


def test_the_drive_file_is_that_drive(found: tuple[Proposal, ...]) -> None:
    """It has the tension by a take-up of some millimeters, and check has nothing to say about its load."""
    for one in found[:3]:
        drive = one.drive
        rest = install(drive)
        assert rest.tension == pytest.approx(one.tension, rel=1e-2)
        assert abs(drive.centers[1, 0] - one.distance) < 0.02 * one.distance
        pull = 1.4 * 3e3 / one.belt_speed
        assert one.tension == pytest.approx(
            REST_SHARE * pull + drive.belt.mass_per_length * one.belt_speed**2, rel=1e-9
        )
        assert one.tension + 0.5 * pull <= (drive.belt.largest_tension or inf)
        rated = rate(prepare(drive), np.array([1450.0 / RPM, one.driven_speed]), np.array([3e3, -3e3]), drive.centers)
        assert rated is not None
        assert rated.power.min() >= one.rated_power * (1.0 - 0.01)  # the tension at rest is only asked of the proposal
        assert not [told for told in advise(drive, rest) if "pull" in told or "teeth" in told]


def test_a_driver_that_is_the_slower_pulley_has_more_teeth() -> None:
    one = select(power="1 kW", speed="500 rpm", driven_speed="1500 rpm", profiles="HTD 8M")[0]
    assert one.teeth is not None
    assert one.teeth[1] / one.teeth[2] == pytest.approx(3.0, rel=0.03)
    assert one.driver_diameter > one.driven_diameter


def test_named_profiles_decide_which_kind_it_is() -> None:
    both = select(**TASK, profiles="SPA, HTD 8M", count=4)
    assert {one.profile for one in both} == {"SPA", "HTD 8M"}
    assert all((one.teeth is None) == (one.profile == "SPA") for one in both)
    assert all(one.teeth is None for one in select(**TASK))


def test_a_power_beyond_the_widest_belt_is_refused() -> None:
    with pytest.raises(ModelError, match=r"no drive of MXL carries 4\.2 kW"):
        select(**TASK, profiles="MXL")
