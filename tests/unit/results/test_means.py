"""Utilization from powers put in by hand, on two pulleys and with an idler on the back."""

from math import pi

import numpy as np
import pytest

from beltdyn.model import Drive, loads, prepare
from beltdyn.model.rating import PowerRating
from beltdyn.results.means import rate, utilization

RPM = 30.0 / pi
TEXT = """
[belt]
profile = "PK"
ribs = 6
installed_tension = "300 N"
[[pulley]]
name = "crank"
center = [0.0, 0.0]
diameter = "150 mm"
speed = "1500 rpm"
[[pulley]]
name = "alternator"
center = [0.3, 0.0]
diameter = "56 mm"
inertia = 0.001
[[pulley]]
name = "idler"
center = [0.13, 0.075]
diameter = "60 mm"
side = "outside"
inertia = 0.001
[simulation]
duration = 1.0
"""
SPEEDS = np.array([1500.0, 3868.0, -3500.0]) / RPM
POWERS = np.array([3000.0, -2950.0, -0.01])


@pytest.fixture(scope="module")
def accessory() -> Drive:
    return loads(TEXT)


def test_the_small_pulley_is_rated_by_its_diameter_ratio_and_wrap(accessory: Drive) -> None:
    found = rate(prepare(accessory), SPEEDS, POWERS, accessory.centers)
    entry = accessory.belt.entry
    assert isinstance(found, PowerRating)
    assert entry is not None
    assert entry.rating is not None
    speed = (0.075 + 0.0015) * 1500.0 / RPM
    each = float(entry.rating.power(0.059, speed, 0.153 / 0.059))
    wrap = float(accessory.path.wrap_angles[1])
    factor = 1.25 * (1.0 - 5.0 ** (-wrap / pi))
    assert found.wrap[1] == pytest.approx(wrap)
    assert found.power[1] == pytest.approx(6 * 0.91 * factor * each)  # 0.91 for three pulleys
    assert found.basic[1] + found.ratio[1] == pytest.approx(each)


def test_the_back_of_the_belt_has_no_rating_and_an_idler_no_ratio(accessory: Drive) -> None:
    found = rate(prepare(accessory), SPEEDS, POWERS, accessory.centers)
    assert found is not None
    assert np.isnan(found.power[2])
    grown = accessory.with_({"pulley[idler].diameter": 0.07})
    other = rate(prepare(grown), SPEEDS, POWERS, grown.centers)
    assert other is not None
    assert other.power[1] == pytest.approx(found.power[1], rel=0.02)


def test_utilization_is_design_power_over_rated_power(accessory: Drive) -> None:
    rated = np.array([6000.0, 4000.0, np.nan])
    plain = utilization(accessory, rated, POWERS)
    assert plain[:2] == pytest.approx([0.5, 0.7375])
    assert np.isnan(plain[2])
    served = accessory.replace(limits={"service_factor": 1.2})
    assert utilization(served, rated, POWERS)[:2] == pytest.approx(1.2 * plain[:2])
    assert utilization(accessory, np.zeros(3), POWERS)[0] == np.inf


def test_without_a_rating_there_is_nothing(drive: Drive) -> None:
    assert rate(prepare(drive), SPEEDS[:2], POWERS[:2], np.zeros((2, 2))) is None
