"""Selected drives: standard parts within the space, that carry the power, in order of their width."""

import tomllib
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.designs import selection
from beltdyn.designs.proposal import Task
from beltdyn.designs.selection import DIAMETERS, Proposal, _pairs, select
from beltdyn.errors import ModelError
from beltdyn.model import install, loads, prepare, read_catalogue
from beltdyn.model.rating import RatedBelt
from beltdyn.results.means import rate
from beltdyn.theory.rating import RUN_IN
from beltdyn.theory.span import open_belt

RPM = 30.0 / pi
TASK: dict[str, Any] = {"power": "7.5 kW", "speed": "1450 rpm", "driven_speed": "700 rpm", "service_factor": 1.2}


@pytest.fixture(scope="module")
def found() -> tuple[Proposal, ...]:
    return select(**TASK, distance="400..700 mm", largest_driven="400 mm", count=8)


def test_they_carry_the_power_within_the_space(found: tuple[Proposal, ...]) -> None:
    assert len(found) == 8
    for one in found:
        assert 0.4 <= one.distance <= 0.7
        assert one.driven_diameter <= 0.4
        assert one.driven_speed == pytest.approx(700.0 / RPM, rel=0.03)
        assert one.utilization == pytest.approx(9e3 / one.rated_power)
        assert one.utilization <= 1.0
        entry = read_catalogue()[one.profile]
        assert one.nominal_length in entry.lengths
        assert {one.driver_diameter, one.driven_diameter} <= set(DIAMETERS)
        assert entry.smallest_diameter is None or one.driver_diameter >= entry.smallest_diameter


def test_the_narrowest_is_best_and_a_profile_comes_twice_at_most(found: tuple[Proposal, ...]) -> None:
    widths = [one.face_width for one in found]
    assert widths == sorted(widths)
    assert widths[0] == pytest.approx(found[0].belts * read_catalogue()[found[0].profile].width)
    assert max([one.profile for one in found].count(name) for name in read_catalogue()) <= 2


def test_one_belt_less_would_not_do(found: tuple[Proposal, ...]) -> None:
    for one in found:
        belt = one.drive.rated_belt
        assert isinstance(belt, RatedBelt)
        assert one.belts == 1 or one.utilization * belt.factor(one.belts, 2) > belt.factor(one.belts - 1, 2)


def test_diameters_are_preferred_numbers() -> None:
    """Those of the series R40 of ISO 3."""
    series = (
        *(100, 106, 112, 118, 125, 132, 140, 150, 160, 170, 180, 190, 200, 212, 224, 236, 250, 265, 280, 300, 315),
        *(335, 355, 375, 400, 425, 450, 475, 500, 530, 560, 600, 630, 670, 710, 750, 800, 850, 900, 950),
    )
    preferred = np.outer([1e-4, 1e-3, 1e-2], series)
    assert all(np.isclose(preferred, diameter, rtol=1e-9).any() for diameter in DIAMETERS)
    assert list(DIAMETERS) == sorted(set(DIAMETERS))


def test_there_are_five_proposals_by_default() -> None:
    assert len(select(**TASK)) == 5


def test_a_profile_comes_twice_where_there_is_room() -> None:
    assert len(select(**TASK, profiles="SPA", count=5)) == 2


@pytest.mark.parametrize("offset", [0.0, 2e-3, 8e-3])
def test_pulleys_have_the_nearest_ratio_of_their_tension_lines(offset: float) -> None:
    """Which lie outside the diameters of ribbed pulleys by the pitch offset."""
    entry = read_catalogue()["PK"].replace(pitch_offset=offset)
    for speed in np.linspace(11.0, 60.0, 20):
        task = Task(1e3, speed, 10.0, 1.0, None, (np.inf, np.inf), 0.5, 1)
        pairs = list(_pairs(entry, task))
        assert pairs
        for pair in pairs:
            small, large = (2.0 * radius for radius in pair.radii)
            assert (small, large) == pytest.approx((pair.small + 2.0 * offset, pair.large + 2.0 * offset))
            errors = np.abs((np.array(DIAMETERS) + 2.0 * offset) / small - 0.1 * speed)
            assert abs(large / small - 0.1 * speed) == pytest.approx(errors.min())


def test_the_inertia_of_a_pulley_is_less_than_that_of_a_solid_one() -> None:
    for one in select(**TASK, count=3):
        solid = 0.5 * pi * 7850.0 * max(one.face_width, 0.02) * (0.5 * one.driven_diameter) ** 4
        assert 0.05 * solid < one.drive.pulleys[1].inertia < solid


@pytest.mark.parametrize(("key", "missing"), [("lengths", "standard lengths"), ("rating", "rating")])
def test_a_profile_that_lacks_its_lengths_or_its_rating_says_which(
    monkeypatch: pytest.MonkeyPatch, key: str, missing: str
) -> None:
    known = read_catalogue()
    changed = known | {"SPA": known["SPA"].replace(**{key: () if key == "lengths" else None})}
    monkeypatch.setattr(selection, "read_catalogue", lambda _: changed)
    with pytest.raises(ModelError, match=f'profile "SPA" has no {missing}'):
        select(**TASK, profiles="SPA")


@pytest.mark.parametrize("profiles", ["SPA", "SPB", "PK", "PL", "B"])
def test_the_drive_file_is_that_drive(profiles: str) -> None:
    """The belt of standard length has the tension on the center distance, but for a take-up of some millimeters."""
    one = select(**TASK, profiles=profiles)[0]
    drive = loads(one.text)
    path = open_belt(one.distance, (0.5 * one.driver_diameter, 0.5 * one.driven_diameter))
    assert path.length == pytest.approx(one.nominal_length, rel=1e-9)
    rest = install(drive)
    assert rest.tension == pytest.approx(one.tension, rel=1e-3)
    assert np.hypot(*rest.hub_loads[0]) == pytest.approx(one.hub_load, rel=0.01)
    assert rest.span_frequencies[0] == pytest.approx(one.frequency, rel=0.03)
    assert abs(drive.centers[1, 0] - one.distance) < 0.02 * one.distance
    speeds = np.array([1450.0 / RPM, one.driven_speed])
    rated = rate(prepare(drive), speeds, np.array([7.5e3, -7.5e3]), drive.centers)
    assert rated is not None
    assert rated.power.min() == pytest.approx(one.rated_power, rel=0.01)
    torque = drive.pulleys[1].torque
    assert torque is not None
    assert -float(torque.at([0.0])[0]) * one.driven_speed == pytest.approx(7.5e3, rel=1e-3)


def test_the_tension_holds_the_pull_without_slip() -> None:
    """The least tension has T1 / T2 = 5 for half a turn; the proposal's is that of a run-in belt."""
    one = select(power=9e3, speed="1450 rpm", driven_speed="1450 rpm", profiles="SPA")[0]
    mass = one.belts * read_catalogue()["SPA"].mass_per_length
    least = 0.75 * 9e3 / one.belt_speed + mass * one.belt_speed**2
    assert one.tension == pytest.approx(RUN_IN * least, rel=1e-6)
    assert one.hub_load == pytest.approx(2.0 * one.tension, rel=1e-6)


def test_a_drive_that_speeds_up_has_its_small_pulley_driven() -> None:
    one = select(power="3 kW", speed="1000 rpm", driven_speed="2000 rpm", profiles=["SPZ"], largest_driver=0.2)[0]
    assert one.driven_diameter < one.driver_diameter <= 0.2
    assert one.driven_speed == pytest.approx(2000.0 / RPM, rel=0.03)


def test_more_power_needs_more_belts() -> None:
    limits: dict[str, Any] = {"largest_driven": "315 mm", "profiles": "SPA", "most_belts": 20}
    few, many = (
        select(power=power, speed="1450 rpm", driven_speed="700 rpm", **limits)[0] for power in ("5 kW", "40 kW")
    )
    assert many.belts > 4 * few.belts


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"power": "7.5 N"}, r"power = '7.5 N' must be in units of W"),
        ({"speed": 0.0}, r"speed = 0.0 must be above zero"),
        ({"profiles": "SPX"}, r'profile = "SPX" is not in the catalogue'),
        ({"profiles": "PK-elastic"}, r'profile "PK-elastic" has no rating'),
        ({"distance": "500 mm"}, r"distance = '500 mm' must be a range"),
        ({"distance": "10..20 mm"}, r"no drive of .* carries 9 kW at 1450 to 700 rpm within these limits\. Widen"),
        ({"power": "9 MW"}, r"no drive of .* carries 1.08e\+04 kW"),
    ],
)
def test_what_is_not_possible_is_refused(changes: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        select(**TASK | changes)


def test_names_are_quoted_in_the_drive_file(tmp_path: Path) -> None:
    own = tmp_path / 'my "best" belts.toml'
    own.write_text("", encoding="utf-8")
    proposal = select(power="7.5 kW", speed="1450 rpm", driven_speed="700 rpm", profiles="SPA", catalogue=own)[0]
    belt = tomllib.loads(proposal.text)["belt"]
    assert (belt["catalogue"], belt["profile"]) == (own.as_posix(), "SPA")
