"""Belts with spread teeth against closed forms: load sharing, pitch error, stiffness, ratio, energy.

The belt hardly bends and the contact is hard, as the closed forms have it: they leave out bending and penetration.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.model import OptimizationStudy
from beltdyn.results import Run

AXIAL, TOOTH, PITCH, TEETH = 1e5, 1e6, 8e-3, 120
RADIUS = TEETH * PITCH / (2.0 * np.pi)
LENGTH = np.sqrt(PITCH * AXIAL / TOOTH)
"""Lambda, over which a load is shared, m."""
BELT = {
    "teeth": 240,
    "width": 0.02,
    "thickness": 0.004,
    "axial_stiffness": AXIAL,
    "bending_stiffness": 1e-5,
    "mass_per_length": 0.1,
}


def drive(torque: float, tension: float = 100.0, pitch_error: float = 1e-3, **toothing: float) -> bd.Drive:
    """Two equal pulleys of 120 teeth, and spans of 60 pitches."""
    driver = {"name": "driver", "center": [0.0, 0.0], "teeth": TEETH, "speed": 10.0, "pitch_error": pitch_error}
    driven = {"name": "driven", "center": [0.5, 0.0], "teeth": TEETH, "inertia": 1e-3, "torque": torque}
    return bd.Drive(
        belt=BELT | {"installed_tension": tension, "toothing": {"pitch": PITCH, "tooth_stiffness": TOOTH, **toothing}},
        pulley=[driver, driven | {"pitch_error": pitch_error}],
        contact={"friction": 0.0, "stiffness": 2e11},
        tensioner=[{"kind": "fixed", "pulley": "driven", "direction": [1.0, 0.0]}],
        simulation={"duration": 1.0},
    )


def arc(run: Run, pulley: int) -> tuple[FloatArray, FloatArray, float]:
    """Places along an arc (m), traction of teeth along the belt (N/m), and distance of the belt from the shaft (m)."""
    seen = run.dataset.isel(field_time=-1)
    here = np.flatnonzero(seen.contact_pulley.values == pulley)
    along = seen.belt_coordinate.values[here]
    if np.diff(along).max() > 0.1:  # over the first node
        along = np.where(along < along.mean(), along + run.prepared.belt_length, along)
    order = np.argsort(along)
    away = seen.contact_position.values[here] - seen.pulley_center.isel(time=-1).values[pulley]
    return along[order], seen.friction_force.values[here][order], float(np.median(np.hypot(*away.T)))


@pytest.fixture(scope="module")
def loaded() -> Run:
    return bd.steady_state(drive(-10.0), force_tolerance=1e-3)


@pytest.mark.parametrize("pulley", [0, 1])
def test_load_sharing(loaded: Run, pulley: int, curve: Callable[..., None]) -> None:
    along, traction, away = arc(loaded, pulley)
    x, length = along - along[0], along[-1] - along[0]
    after, before = loaded.dataset.span_tension.isel(time=-1).values[[pulley, 1 - pulley]]
    agree = AXIAL * (2.0 * np.pi * away / (TEETH * PITCH) - 1.0)  # the tension at which pitches agree
    shape = -(before - agree) * np.cosh((length - x) / LENGTH) + (after - agree) * np.cosh(x / LENGTH)
    slope = shape / (LENGTH * np.sinh(length / LENGTH))
    name = ("driver", "driven pulley")[pulley]
    curve("toothed", 1e3 * x, -PITCH * traction, f"{name}, found", "-")
    curve("toothed", 1e3 * x[::12], PITCH * slope[::12], f"{name}, closed form", ".")
    np.testing.assert_allclose(-traction, slope, atol=1e-4 * np.abs(slope).max())


def test_an_unloaded_pitch_error_turns_no_pulley() -> None:
    run = bd.steady_state(drive(0.0, pitch_error=2e-3), force_tolerance=1e-3)
    along, traction, _ = arc(run, 1)
    largest = float(np.abs(traction).max())
    middle = along[0] + along[-1] - along
    assert PITCH * largest > 1.0  # the pitch error loads teeth
    # the mesh need not be symmetric: its error in peaks
    np.testing.assert_allclose(np.interp(middle, along, traction), -traction, atol=1e-3 * largest)
    total = float(np.trapezoid(np.abs(traction), along))
    assert abs(float(np.trapezoid(traction, along))) < 1e-3 * total
    assert float(abs(run.dataset.pulley_torque.isel(time=-1, pulley=1))) < 1e-9 * AXIAL * RADIUS


def twist(torque: float) -> float:
    """Angle by which the driven pulley is ahead of the driver, rad."""
    run = bd.steady_state(drive(torque), force_tolerance=1e-3)
    driver, driven = np.asarray(run.dataset.attrs["tooth_phases"])
    return float(driven - driver)


def stiffness_in_series(run: Run) -> float:
    """Torque over the angle between the pulleys, N m/rad, of spans and arcs."""
    stretch, radius = run.prepared.path.length / run.prepared.belt_length, run.prepared.radii[0]
    span, arc = float(run.prepared.path.span_lengths[0]) / stretch, np.pi * radius / stretch
    return float(2.0 * radius**2 * AXIAL / (span + 2.0 * LENGTH / np.tanh(arc / (2.0 * LENGTH))))


def test_stiffness_of_spans_and_arcs_in_series() -> None:
    stiffness = 2.0 / (twist(-1.0) - twist(1.0))
    expected = stiffness_in_series(bd.steady_state(drive(-1.0), force_tolerance=1e-3))
    assert abs(stiffness) == pytest.approx(expected, rel=1e-3)  # strains of 1e-3 are not in the closed form


def test_the_curve_over_torque() -> None:
    """Wind-up by the stiffness in series, and loads of teeth by load sharing, whose peaks are at the ends of arcs."""
    given = drive(0.0).with_({"contact.stiffness": 2e10})
    found = bd.traction(given, torque="-2, 2, 6, 12 N m", force_tolerance=1e-3).dataset
    assert found.mesh_error.max() < 1e-3
    wound = 4.0 / stiffness_in_series(bd.steady_state(drive(-2.0), force_tolerance=1e-3))
    assert float(found.wind_up[1]) == pytest.approx(wound, rel=1e-3)
    peaks = found.torque / RADIUS * PITCH / (2.0 * LENGTH) / np.tanh(np.pi * RADIUS / (2.0 * LENGTH))
    # without what bending adds; strains change the pitch by a part in a thousand
    np.testing.assert_allclose((found.tooth_load[3] - found.tooth_load[2]), peaks[3] - peaks[2], rtol=0.01)
    assert float(found.limit_torque) == 12.0


@pytest.mark.parametrize("torque", [0.0, -5.0, -12.0])
def test_the_ratio_is_that_of_the_teeth_under_any_load(torque: float) -> None:
    given = drive(torque)
    driven = given.pulleys[1].merged({"teeth": 96})
    run = bd.steady_state(given.replace(pulley=[given.pulleys[0], driven]), force_tolerance=1e-2)
    speeds = run.dataset.pulley_speed.isel(time=-1).values
    assert speeds[1] / speeds[0] == pytest.approx(TEETH / 96, rel=1e-12)


def test_teeth_lose_nothing(loaded: Run) -> None:
    end = loaded.dataset.isel(time=-1)
    assert float(abs(end.energy_closure)) < 1e-9
    # pulleys of one pitch give back what they take; pitches differ by the penetration, of 1e-7 of the radius
    lost = abs(float(end.compression_loss)) + abs(float(end.friction_loss))
    assert lost < 1e-5 * float(end.driver_work)


def test_sensitivity_to_tension_and_load() -> None:
    """Both spans have the installed tension, and half of the load over the radius more and less; but for strains."""
    given = drive(-10.0)
    numbers = "belt.installed_tension, pulley[driven].torque.value"
    found = bd.sensitivity(given, of="span_tension", numbers=numbers, force_tolerance=1e-3).dataset.derivative
    np.testing.assert_allclose(found.sel(number="belt.installed_tension").values, 1.0, rtol=1e-2)
    by_torque = found.sel(number="pulley[driven].torque.value").values
    np.testing.assert_allclose(np.sort(by_torque), np.array([-0.5, 0.5]) / RADIUS, rtol=1e-2)


@pytest.mark.slow
def test_the_least_tension_for_a_tight_slack_span() -> None:
    """An optimization whose result is known: the slack span has half of the load over the radius less than at rest."""
    study = OptimizationStudy(
        number=[{"path": "belt.installed_tension", "least": 60.0, "largest": 300.0}],
        goal={"result": "largest_tension"},
        requirement=[{"result": "span_tension", "at_least": "40 N"}],
    )
    found = bd.optimize(drive(-10.0, tension=200.0), study=study)
    assert float(found.dataset.best[0]) == pytest.approx(40.0 + 0.5 * 10.0 / RADIUS, rel=1e-2)


@pytest.fixture(scope="module")
def over_time() -> Run:
    given = drive(-10.0)
    settings = given.simulation.replace(duration=0.05, start="steady")
    return bd.simulate(given.replace(simulation=settings, contact={"friction": 0.0}))


@pytest.mark.slow
def test_a_run_that_starts_steadily_stays_steady(over_time: Run) -> None:
    speeds = over_time.dataset.pulley_speed.values
    assert float(np.ptp(speeds, axis=0).max()) < 1e-5  # of 10 rad/s: the tolerance of the time integration
    assert float(abs(over_time.dataset.energy_closure).max()) < 1e-4


@pytest.mark.slow
def test_a_run_goes_on_with_the_grooves_where_they_are(over_time: Run, tmp_path: Path) -> None:
    file = tmp_path / "first.nc"
    over_time.save(file)
    settings = over_time.drive.simulation.replace(start={"file": str(file)}, duration=0.01)
    later = bd.simulate(over_time.drive.replace(simulation=settings)).dataset
    before = over_time.dataset.span_tension.values[-1]
    np.testing.assert_allclose(later.span_tension.values[[0, -1]], [before, before], rtol=1e-6)


@pytest.mark.slow
def test_modes_of_a_run_are_those_of_steady_running(over_time: Run) -> None:
    one = bd.modes(bd.steady_state(over_time.drive)).dataset.frequency.values[:6]
    other = bd.modes(over_time, at=0.05).dataset.frequency.values[:6]
    np.testing.assert_allclose(other, one, rtol=2e-3)  # the meshes differ


@pytest.fixture(scope="module")
def travelling() -> Run:
    given = drive(-10.0)
    settings = given.simulation.replace(duration=0.02, start="steady", frame="travelling")
    return bd.simulate(given.replace(simulation=settings, contact={"friction": 0.0}))


@pytest.mark.slow  # kernels of a mesh that travels with teeth
def test_a_mesh_that_travels_runs_as_one_that_stays(travelling: Run, over_time: Run) -> None:
    seen, other = travelling.dataset, over_time.dataset
    tension = other.span_tension.isel(time=-1).values
    # the default mesh resolves tensions to half a per cent of that at rest
    np.testing.assert_allclose(seen.span_tension.mean("time").values, tension, atol=5e-3 * 100.0)
    np.testing.assert_allclose(seen.pulley_speed.mean("time").values, [10.0, 10.0], rtol=1e-3)
    assert float(abs(seen.energy_closure).max()) < 1e-5


@pytest.mark.slow
def test_a_belt_at_rest_on_a_mesh_that_travels_turns_no_pulley() -> None:
    given = drive(0.0, pitch_error=2e-3)
    settings = given.simulation.replace(duration=1e-3, frame="travelling")
    parked = given.pulleys[0].merged({"speed": 0.0})
    run = bd.simulate(given.replace(simulation=settings, pulley=[parked, given.pulleys[1]], contact={"friction": 0.0}))
    start = run.dataset.isel(time=0)
    held, free = np.abs(start.pulley_torque.values)
    assert free < 1e-9 * 100.0 * RADIUS
    assert held < 1e-4 * 100.0 * RADIUS  # the mesh, which has no teeth, rests on the pulley that does not turn
    np.testing.assert_allclose(start.span_tension.values, 100.0, rtol=1e-4)
