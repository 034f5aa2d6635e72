"""Checks of the belt in the workshop against string, beam and the formulas of belt makers."""

from collections.abc import Callable
from math import pi, sqrt

import numpy as np
import pytest

from beltdyn.model import Drive, install, layer_lengths, loads
from beltdyn.model.installation import DEFLECTION, HELD, STATES, TensionCheck, tension_checks
from beltdyn.theory.span import deflection_force

MakeDrive = Callable[..., Drive]


def test_layer_lengths(drive: Drive) -> None:
    bending, sinking = layer_lengths(drive, 1600.0)
    assert bending == pytest.approx(sqrt(drive.belt.bending_stiffness / 1600.0))
    assert sinking == pytest.approx(sqrt(1600.0 / 1e7))


def test_hub_loads(make_drive: MakeDrive) -> None:
    """sqrt(T1^2 + T2^2 - 2 T1 T2 cos(wrap)), and all of them are in balance."""
    installation = install(make_drive("serpentine", length=1.8))
    tension, wraps = installation.tension, installation.path.wrap_angles
    loads_of = np.linalg.norm(installation.hub_loads, axis=1)
    np.testing.assert_allclose(loads_of, tension * np.sqrt(2 - 2 * np.cos(wraps)), rtol=1e-12)
    np.testing.assert_allclose(installation.hub_loads.sum(axis=0), 0.0, atol=1e-10)
    pulled = install(make_drive("open"))
    assert pulled.hub_loads[0, 0] > 0 > pulled.hub_loads[1, 0]


def test_span_frequency_of_a_string_and_of_a_beam(make_drive: MakeDrive) -> None:
    string = make_drive("open", bending_factor=1e-12)
    installation = install(string)
    stretch = 1 + installation.strain
    mass = string.belt.mass_per_length / stretch
    length = installation.path.span_lengths[0]
    expected = np.sqrt(installation.tension / mass) / (2 * length)
    assert installation.span_frequencies[0] == pytest.approx(expected, rel=1e-9)
    beam = make_drive("open", installed_tension=1e-3, bending_factor=1.0)
    expected = pi / (2 * length**2) * np.sqrt(beam.belt.bending_stiffness / beam.belt.mass_per_length)
    assert install(beam).span_frequencies[0] == pytest.approx(expected, rel=1e-3)


TEXT = """
[belt]
profile = "SPB"
ribs = 3
installed_tension = "2400 N"
[[pulley]]
name = "motor"
center = [0.0, 0.0]
diameter = "200 mm"
speed = "1450 rpm"
[[pulley]]
name = "fan"
center = [0.9, 0.0]
diameter = "400 mm"
inertia = 1.0
[simulation]
duration = 1.0
"""


@pytest.fixture(scope="module")
def fan() -> Drive:
    return loads(TEXT)


def checks_of(drive: Drive, specified: float | None = None) -> dict[str, TensionCheck]:
    return {one.state: one for one in tension_checks(drive, install(drive), specified)}


def test_a_new_belt_a_run_in_one_and_the_least(fan: Drive) -> None:
    found = checks_of(fan)
    assert found.keys() == STATES.keys()
    assert found["run in"].tension == pytest.approx(2400.0, rel=1e-3)
    assert found["new"].tension / found["least"].tension == pytest.approx(1.5)
    assert found["run in"].tension / found["least"].tension == pytest.approx(1.3)
    for name in ("frequencies", "forces"):
        new, run_in, least = (getattr(found[state], name) for state in STATES)
        assert np.all(new > run_in)
        assert np.all(run_in > least)


def test_the_frequency_is_that_of_a_string_made_stiffer(fan: Drive) -> None:
    """f = sqrt(T/m)/2l of the three belts together; EI adds (pi/l)^2 EI/T / 2, below 0.2 % here, stretch up to 1 %."""
    path, found = install(fan).path, checks_of(fan)["run in"]
    length = float(path.span_lengths[0])
    string = np.sqrt(found.tension / fan.belt.mass_per_length) / (2.0 * length)
    assert found.frequencies[0] == pytest.approx(string, rel=0.01)
    assert found.frequencies[0] > string


def test_the_force_on_each_belt_is_that_of_the_makers(fan: Drive) -> None:
    """F = (T + EA 2 q^2 l / L) 4 q with q the deflection over the length: makers print (T + Y l / L) / 16 for 1/64."""
    length, found = float(install(fan).path.span_lengths[0]), checks_of(fan)["run in"]
    each = found.tension / 3.0
    stretch = fan.belt.axial_stiffness / 3.0 * 2.0 * DEFLECTION**2 * length / fan.belt_length
    flexible = 4.0 * DEFLECTION * (each + stretch)
    assert flexible < found.forces[0] < 1.05 * flexible
    stiff = deflection_force(DEFLECTION * length, length, each + stretch, fan.belt.bending_stiffness / 3.0)
    assert found.forces[0] == pytest.approx(stiff, rel=1e-3)


def test_a_stiff_belt_is_a_beam(fan: Drive) -> None:
    """With EI far above T l^2 the force is 48 EI w / l^3."""
    installed = install(fan)
    stiff = fan.replace(belt=fan.belt.replace(bending_stiffness=1e6))
    found = tension_checks(stiff, installed)[1]
    length = float(installed.path.span_lengths[0])
    assert found.forces[0] == pytest.approx(48.0 * 1e6 * DEFLECTION / length**2 / 3.0, rel=1e-3)


def test_a_specified_tension_counts(fan: Drive) -> None:
    assert checks_of(fan, 1200.0)["run in"].tension == pytest.approx(1200.0)


def test_a_ribbed_belt_is_pressed_as_a_whole(fan: Drive) -> None:
    ribbed = fan.with_({"belt.profile": "PL", "belt.ribs": 6})
    assert ribbed.belt.v_belts == 1
    assert fan.belt.v_belts == 3
    found = checks_of(ribbed)["run in"]
    assert found.forces[0] > 4.0 * DEFLECTION * 2400.0


def test_a_spring_holds_the_tension(fan: Drive) -> None:
    slide = {"kind": "sliding", "pulley": "fan", "direction": [1, 0], "mass": 1.0, "preload": "4 kN"}
    held = fan.replace(tensioner=[slide], belt=fan.belt.replace(length=fan.belt_length))
    assert checks_of(held).keys() == HELD.keys()
    (found,) = checks_of(held).values()
    each = found.tension / 3.0
    assert found.forces[0] == pytest.approx(4.0 * DEFLECTION * each, rel=0.05)
