"""The rating of a V-belt drive in steady running, against the hand calculation of a catalogue."""

from math import asin, log10, pi

import numpy as np
import pytest

from beltdyn.designs.named_results import names_of
from beltdyn.errors import ModelError
from beltdyn.model import Drive, example, loads
from beltdyn.model.rating import RatedBelt
from beltdyn.points.belt_rating import _doubts, rating
from beltdyn.results import Result, key_numbers
from beltdyn.state.steady import steady_state

RPM = 30.0 / pi
POWER = 22e3
TEXT = f"""
[belt]
profile = "SPA"
ribs = 4
nominal_length = "2 m"
installed_tension = "2000 N"
[[pulley]]
name = "motor"
center = [0.0, 0.0]
diameter = "160 mm"
speed = "1450 rpm"
[[pulley]]
name = "fan"
center = [0.5, 0.0]
diameter = "315 mm"
inertia = 1.0
torque = {{ kind = "constant", value = {-POWER / (1450.0 / RPM * 160.0 / 315.0):.6g} }}
[[tensioner]]
kind = "fixed"
pulley = "fan"
direction = [1, 0]
[simulation]
duration = 1.0
[limits]
service_factor = 1.2
"""


@pytest.fixture(scope="module")
def fan() -> Drive:
    return loads(TEXT)


@pytest.fixture(scope="module")
def found(fan: Drive) -> Result:
    return rating(fan)


def test_power_per_belt_and_number_of_belts(found: Result, fan: Drive) -> None:
    """Basic power between rows of the Megadyne table of SPA, 7.24 and 8.80 kW on 150 and 170 mm at 1400 rpm."""
    dataset = found.dataset
    motor = dataset.sel(pulley="motor")
    assert 7.24e3 < motor.basic_power < 9.32e3
    assert float(motor.ratio_power) == pytest.approx(0.19 / 500.0 * 1450.0 * 1e3, rel=0.1)  # its additional power
    distance = float(fan.centers[1, 0]) if fan.belt.installed_tension is None else float(found.drive.centers[1, 0])
    wrap = pi - 2.0 * asin((0.315 - 0.160) / (2.0 * distance))
    factor = 1.25 * (1.0 - 5.0 ** (-wrap / pi))
    assert float(motor.wrap_factor) == pytest.approx(factor, rel=5e-3)
    length, belts = (2.0 / 2.654) ** 0.192, 1.0 - 0.05 * 4.0 / 3.0
    rated = 4 * belts * length * factor * float(motor.basic_power + motor.ratio_power)
    assert float(motor.rated_power) == pytest.approx(rated, rel=5e-3)
    assert float(motor.utilization) == pytest.approx(1.2 * float(motor.power) / rated, rel=5e-3)
    assert dataset.largest_utilization == motor.utilization
    needed = int(dataset.most_belts_needed)
    assert needed == (3 if float(motor.utilization) < 0.75 else 4)
    assert (int(dataset.belts), float(dataset.service_factor)) == (4, 1.2)
    assert "Megadyne" in dataset.attrs["rating_source"]
    assert found.warnings == []


def test_the_driven_pulley_has_the_losses_less_and_a_larger_rating(found: Result) -> None:
    dataset = found.dataset
    assert float(dataset.power.sel(pulley="fan")) == pytest.approx(-POWER, rel=0.02)
    assert dataset.rated_power.sel(pulley="fan") > dataset.rated_power.sel(pulley="motor")
    assert dataset.utilization.sel(pulley="fan") < dataset.utilization.sel(pulley="motor")


def test_designs_and_sensitivities_may_ask_for_it(fan: Drive, drive: Drive) -> None:
    assert {"utilization[motor]", "rated_power[fan]"} <= set(names_of(fan))
    assert not any(name.startswith(("utilization", "rated_power")) for name in names_of(drive))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"belt.profile": "PK-elastic"}, r'profile "PK-elastic" has no rating'),
        ({"belt.youngs_modulus": 2e9}, "the belt is not given by a profile"),
    ],
)
def test_what_has_no_rating_is_refused(fan: Drive, changes: dict[str, object], said: str) -> None:
    with pytest.raises(ModelError, match=rf"{said}.*beltdyn catalogue"):
        rating(fan.with_(changes))


def test_what_is_outside_the_range_is_said(fan: Drive) -> None:
    fast = fan.with_({"pulley[motor].speed": "5500 rpm", "pulley[fan].torque": {"kind": "constant", "value": -10.0}})
    found = rating(fast)
    (warning,) = found.warnings
    assert "Outside the rating: the belt runs at 46.1 m/s, but its rating ends at 35 m/s" in warning
    assert (found.dataset.rated_power == 0.0).all()
    assert found.dataset.largest_utilization == np.inf
    assert bool(found.dataset.most_belts_needed.isnull())


def test_a_pulley_below_the_smallest_is_outside_the_rating(fan: Drive) -> None:
    """And its limit is not met, whatever the other pulley says."""
    small = fan.with_({"pulley[motor].diameter": "80 mm", "limits.largest_utilization": 5.0})
    found = rating(small)
    assert any("Outside the rating: motor, smaller than the smallest pulley" in text for text in found.warnings)
    assert found.dataset.utilization.sel(pulley="motor") == np.inf
    assert np.isfinite(float(found.dataset.utilization.sel(pulley="fan")))
    numbers = {one.key: one for one in key_numbers(steady_state(small))}
    assert numbers["largest_utilization"].value == np.inf
    assert numbers["largest_utilization"].passes is False


@pytest.mark.parametrize("changes", [{}, {"belt.profile": "PK", "belt.ribs": 24}])
def test_rated_power_is_the_product_of_its_factors(fan: Drive, changes: dict[str, object]) -> None:
    """V-belts of a set share the load unequally, the ribs of a belt do not."""
    dataset = rating(fan.with_(changes | {"pulley[fan].torque": -100.0})).dataset
    factors = dataset.belts * dataset.belts_factor * dataset.pulleys_factor * dataset.length_factor
    power = factors * dataset.wrap_factor * (dataset.basic_power + dataset.ratio_power)
    np.testing.assert_allclose(dataset.rated_power, power, rtol=1e-12)
    assert (float(dataset.belts_factor) == 1.0) is bool(changes)


def test_what_takes_all_of_the_rated_pull_is_told(fan: Drive) -> None:
    """Within the range of speeds: bending and centrifugal force, or of a toothed belt an arc without a tooth."""
    for drive, wrap, heavier, cause in (
        (fan, pi, 100.0, "since bending and centrifugal force take all of the rated pull"),
        (loads(TOOTHED), 0.01, 1.0, "since no tooth is in mesh, or centrifugal force takes all of the rated pull"),
    ):
        belt, loaded = drive.rated_belt, np.ones(len(drive.pulleys), dtype=bool)
        assert belt is not None
        diameters, wraps = 2.0 * np.array(drive.radii), np.full(loaded.size, wrap)
        carried = belt.on(diameters, np.full(loaded.size, pi), 30.0, loaded)
        assert not [text for text in _doubts(drive, belt, carried, 30.0) if "rated power is zero" in text]
        if isinstance(belt, RatedBelt):
            belt = belt._replace(rating=belt.rating.replace(centrifugal=heavier * belt.rating.centrifugal))
        spent = belt.on(diameters, wraps, 30.0, loaded)
        (warning,) = (text for text in _doubts(drive, belt, spent, 30.0) if "rated power is zero" in text)
        assert warning.startswith("motor")
        assert cause in warning


def test_cogged_belts_say_that_they_are_rated_as_wrapped_ones(fan: Drive) -> None:
    found = rating(fan.with_({"belt.profile": "XPA", "limits.service_factor": None}))
    (warning,) = found.warnings
    power = found.dataset.power.sel(pulley="motor")
    assert float(found.dataset.service_factor) == 1.0
    assert float(found.dataset.utilization[0]) == pytest.approx(float(power / found.dataset.rated_power[0]), rel=5e-3)
    assert "The rating is that of the wrapped belt SPA, a lower bound" in warning


TOOTHED = """
[belt]
profile = "AT5"
width = "16 mm"
teeth = 120
installed_tension = "250 N"
[[pulley]]
name = "motor"
center = [0.0, 0.0]
teeth = 20
speed = "1500 rpm"
[[pulley]]
name = "shaft"
center = [0.2, 0.0]
teeth = 40
inertia = 1e-3
torque = "-8 N m"
[[pulley]]
name = "idler"
center = [0.1, 0.036]
diameter = "30 mm"
side = "outside"
inertia = 1e-5
[[tensioner]]
kind = "fixed"
pulley = "shaft"
direction = [1, 0]
[simulation]
duration = 1.0
[limits]
service_factor = 1.5
"""


def test_teeth_in_mesh_share_the_pull_and_pulleys_the_power() -> None:
    """By six teeth at most, with a service factor of 1 by default; losses take a percent."""
    dataset = rating(example("timing_drive")).dataset
    whole = np.floor(dataset.teeth_in_mesh)
    np.testing.assert_allclose(dataset.mesh_factor, np.minimum(whole, 6.0) / 6.0)
    assert float(dataset.service_factor) == 1.0
    assert int(dataset.counted_teeth) == 6
    given = float(dataset.power.sel(pulley="crankshaft"))
    assert 0.0 <= float(dataset.power.sum()) < 0.01 * given
    pull = np.abs(dataset.power / dataset.belt_speed)
    counted = np.minimum(whole, 6.0) * dataset.allowed_tooth_load
    np.testing.assert_allclose(dataset.utilization, pull / dataset.allowed_pull, rtol=5e-3)
    assert bool((dataset.allowed_pull <= counted)[dataset.teeth_in_mesh.notnull()].all())
    np.testing.assert_allclose(dataset.width_needed, dataset.width * dataset.utilization)


def test_a_toothed_belt_is_rated_by_its_teeth_in_mesh_and_its_cords() -> None:
    """By the cords, 896 N of 16 mm: twelve teeth of 58 N at rest would carry less on the motor at 1500 rpm."""
    dataset = rating(loads(TOOTHED)).dataset
    motor = dataset.sel(pulley="motor")
    wrap = float(motor.wrap_angle)
    assert float(motor.teeth_in_mesh) == pytest.approx(20.0 * wrap / (2.0 * pi), rel=1e-6)
    whole = int(float(motor.teeth_in_mesh))
    load = 1.6 * 36.4 * (1.0 - 0.28 * log10(1.0 + 1500.0 / 93.0))
    assert float(motor.allowed_tooth_load) == pytest.approx(load, rel=1e-3)
    speed = 20 * 5e-3 * 25.0
    pull = min(whole, 12) * load - 1.6 * 0.03 * speed**2
    assert float(motor.allowed_pull) == pytest.approx(pull, rel=2e-3)
    needed = 1.5 * 8.0 / (40 * 5e-3 / (2.0 * pi)) / pull
    assert float(motor.utilization) == pytest.approx(needed, rel=0.01)  # the idler turns on the belt
    assert float(dataset.largest_utilization) == float(motor.utilization)
    assert float(motor.width_needed) == pytest.approx(0.016 * float(motor.utilization))
    assert float(dataset.standard_width) in (0.016, 0.025)
    assert bool(dataset.utilization.sel(pulley="idler").isnull())
