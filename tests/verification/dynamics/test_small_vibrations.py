"""Verified: modes and linear response, against vibrations over time, and against formulas by hand."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.model import Drive
from beltdyn.parts.quantity import RPM
from beltdyn.points.changed_drive import at_speed, held_at
from beltdyn.results import Run
from beltdyn.solvers.eigenvalues import Pencil, all_eigenvalues, nearest, pencil
from beltdyn.solvers.flutter import Vibrations, flutter_shift
from beltdyn.state.linearized import SmallMotions
from beltdyn.state.steady import steady_state
from beltdyn.vibration.modes import modes
from beltdyn.vibration.response import response
from beltdyn.vibration.response_answers import Excited, ForcedMotion
from beltdyn.vibration.small_motions import about_steady
from validation.published.cases import better, loaded_two_pulley

SPEED, TORQUE = 120.0, -45.0
STEADY = {"kind": "constant", "value": SPEED}


def over_time(drive: Drive, duration: float, torque: dict[str, Any], **driver: Any) -> Run:
    """Case 2 with a steep friction law from steady running on, on a mesh that stays, in steps of 0.1 ms."""
    first, second = drive.pulleys
    settings = drive.simulation.replace(
        duration=duration, output_interval=2e-4, max_step=1e-4, frame="staying", start="steady"
    )
    pulleys = [first.replace(speed=STEADY, **driver), second.replace(torque=torque)]
    return bd.simulate(drive.replace(pulley=pulleys, simulation=settings))


def case_2() -> Drive:
    return better(loaded_two_pulley(1e5), 80)


def exponents(values: FloatArray, step: float, count: int) -> ComplexArray:
    """Eigenvalues of a sum of so many exponentials, 1/s (matrix pencil, Hua and Sarkar 1990)."""
    rows = np.lib.stride_tricks.sliding_window_view(values, values.size // 2)
    space = np.linalg.svd(rows, full_matrices=False)[2][:count].T
    found: ComplexArray = np.linalg.eigvals(np.linalg.pinv(space[:-1]) @ space[1:])
    return np.asarray(np.log(found.astype(complex)) / step)


def nearest_of(values: ComplexArray, frequency: float) -> complex:
    return complex(values[np.argmin(np.abs(values.imag - 2.0 * np.pi * frequency))])


@pytest.mark.slow
def test_vibrations_after_a_small_knock(measured: Callable[..., None]) -> None:
    """A step of the load by 0.4 %: rotation and both spans ring as their modes say, to 0.5 %, and die away."""
    knock = {"kind": "step", "time": 0.01, "before": TORQUE, "value": TORQUE - 0.2}
    run = over_time(case_2(), 0.22, knock)
    found = modes(run.drive, count=3).dataset
    assert found.kind.values.tolist() == ["rotational", "span", "span"]
    dataset = run.dataset
    after, step = dataset.time.values > 0.0105, 2e-4
    seen = [dataset.pulley_speed.values[after, 1], *dataset.mid_span_displacement.values[after].T.astype(float)]
    for number, values in enumerate(seen):
        expected = complex(found.growth_rate[number] + 2j * np.pi * found.frequency[number])
        ringing = nearest_of(exponents(values - values[-50:].mean(), step, 10), float(found.frequency[number]))
        measured(frequency=ringing.imag / (2.0 * np.pi), decay=ringing.real, expected=float(found.frequency[number]))
        assert ringing.imag == pytest.approx(expected.imag, rel=5e-3)
        assert ringing.real == pytest.approx(expected.real, rel=0.06)
        if number == 0:
            assert ringing.real == pytest.approx(expected.real, rel=5e-3)


@pytest.mark.slow
def test_forced_vibrations_over_time(measured: Callable[..., None]) -> None:
    """A wave of 0.2 % in the speed of the driver: amplitude and phase of order 2 when the start has died away."""
    waves = [{"order": 2, "amplitude": 0.002}]
    run = over_time(case_2(), 0.4, {"kind": "constant", "value": TORQUE}, harmonics=waves)
    linear = response(run.drive, speed=f"{SPEED} rad/s").dataset.isel(speed=0, excitation=0)
    turns = 8.0 * np.pi / SPEED
    last = run.dataset.isel(time=run.dataset.time.values > float(run.dataset.time[-1]) - turns)
    angle = 2.0 * SPEED * last.time.values
    fit = np.column_stack([np.ones(angle.size), np.cos(angle), np.sin(angle)])
    for name in ("span_tension", "pulley_speed", "pulley_torque"):
        parts = np.linalg.lstsq(fit, last[name].values, rcond=None)[0]
        amplitude, phase = np.hypot(parts[1], parts[2]), np.arctan2(-parts[2], parts[1])
        expected = linear[f"{name}_amplitude"].values
        measured(**{name: amplitude[1], f"expected_{name}": expected[1]})
        np.testing.assert_allclose(amplitude, expected, rtol=5e-3)
        np.testing.assert_allclose(np.exp(1j * (phase - linear[f"{name}_phase"].values)), 1.0, atol=5e-3)


FIXED_CENTERS = """
[belt]
profile = "PK"
ribs = 6
friction = {friction}
installed_tension = "350 N"
[[pulley]]
name = "crank"
center = [0, 0]
radius = "75 mm"
speed = "1500 rpm"
[[pulley]]
name = "alternator"
center = [0.0, 0.30]
radius = "{radius} mm"
inertia = "35 kg cm^2"
load = [{{ kind = "resistance", constant = "{load} N m" }}]
[simulation]
duration = 0.5
output_interval = "0.25 ms"
"""


def drive_beyond(name: str) -> Drive:
    """A drive whose harmonics of the crank are beyond the range of a linear response, at the end of its ramps."""
    if name == "idle":
        given = bd.example("alternator_drive")
        load = [{"kind": "resistance", "constant": 0.2}]
        return given.replace(pulley=[one.replace(load=load) if one.load else one for one in given.pulleys])
    if name == "fixed":
        return bd.loads(FIXED_CENTERS.format(friction=0.35, radius=28, load=7))
    if name == "near its limit":
        return bd.loads(FIXED_CENTERS.format(friction=0.14, radius=40, load=10))
    return bd.example(name)


def order_2_over_time(drive: Drive, rpm: float, wave: float, duration: float) -> FloatArray:
    """Amplitudes of order 2 of the span tensions in the last 0.15 s, from steady running with constant loads on."""
    constant = at_speed(held_at(drive, None), 0, rpm / RPM)
    crank, *others = constant.pulleys
    wavy = crank.replace(harmonics=[{"order": 2, "amplitude": wave}])
    settings = {"duration": duration, "output_interval": 2.5e-4, "start": "steady"}
    run = bd.simulate(constant.replace(pulley=[wavy, *others], simulation=settings)).dataset
    last = run.time.values > duration - 0.15
    angle = 2.0 * rpm / RPM * run.time.values[last]
    waves = [part(k * angle) for k in (1, 2, 3, 4) for part in (np.cos, np.sin)]
    parts = np.linalg.lstsq(np.column_stack([np.ones(angle.size), *waves]), run.span_tension.values[last])[0]
    return np.asarray(np.hypot(parts[1], parts[2]))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "rpm", "wave"),
    [
        ("alternator_drive", 1400.0, 0.002),
        ("alternator_drive", 1400.0, 0.005),
        ("alternator_drive", 1400.0, 0.01),
        ("alternator_drive", 1600.0, 0.01),
        ("idle", 1400.0, 0.002),
        ("idle", 1400.0, 0.005),
        ("fixed", 1500.0, 0.01),
        ("fixed", 1900.0, 0.002),
        ("near its limit", 1900.0, 0.003),
        ("near its limit", 1900.0, 0.006),
        ("near its limit", 2400.0, 0.001),
    ],
)
def test_a_linear_response_errs_by_no_more_than_it_says(
    name: str, rpm: float, wave: float, measured: Callable[..., None]
) -> None:
    """Of the largest tension amplitude, beside 2 % of mesh and time steps; within its range by no more than those."""
    drive = drive_beyond(name)
    crank, *others = drive.pulleys
    wavy = crank.replace(harmonics=[{"order": 2, "amplitude": wave}])
    linear = response(drive.replace(pulley=[wavy, *others]), speed=f"{rpm} rpm")
    amplitude = linear.dataset.span_tension_amplitude.values[0, 0]
    seen, estimate = order_2_over_time(drive, rpm, wave, 0.45), float(linear.dataset.amplitude_error[0])
    error = float(np.max(np.abs(amplitude - seen)) / amplitude.max())
    measured(linear=amplitude.max(), seen=seen[amplitude.argmax()], error=error, estimate=estimate)
    assert error < estimate + 0.025
    assert any("beyond its range" in one for one in linear.warnings) == (estimate > 0.05)


@pytest.mark.slow
@pytest.mark.parametrize(("rpm", "wave"), [(1200.0, 0.005), (1350.0, 0.01)])
def test_dry_friction_of_a_tensioner_as_dashpot(rpm: float, wave: float, measured: Callable[..., None]) -> None:
    """The arm of the accessory drive, held by its friction under order 2 alone: the dashpot has the same effect."""
    given = bd.example("accessory_drive")
    smooth = [one.replace(load=[load.replace(harmonics=()) for load in one.load]) for one in given.pulleys]
    drive = given.replace(pulley=smooth)
    crank, *others = drive.pulleys
    wavy = drive.replace(pulley=[crank.replace(harmonics=[{"order": 2, "amplitude": wave}]), *others])
    linear = response(wavy, speed=f"{rpm} rpm")
    amplitude = linear.dataset.span_tension_amplitude.values[0, 0]
    seen = order_2_over_time(drive, rpm, wave, 0.5)
    change = float(np.max(np.abs(amplitude - seen)) / amplitude.max())
    expected = float(linear.dataset.friction_change[0])
    measured(change=change, expected=expected)
    assert expected == pytest.approx(change, abs=0.02)
    assert any("dry friction of tensioners, which this response neglects" in one for one in linear.warnings)
    held = response(wavy, speed=f"{rpm} rpm", dry_tensioners="stuck").dataset
    np.testing.assert_allclose(held.span_tension_amplitude.values[0, 0], seen, atol=0.02 * amplitude.max())
    assert float(held.friction_change[0]) < 0.02


STIFFNESS, DAMPING, ROTOR = 200.0, 0.05, 3e-3
HUBS: dict[str, dict[str, Any]] = {
    "isolator": {"kind": "isolator", "stiffness": STIFFNESS, "damping": DAMPING, "inertia": ROTOR},
    "decoupler": {"kind": "one_way_clutch", "locking_damping": 5.0, "inertia": ROTOR},
}


@pytest.mark.parametrize("kind", HUBS)
def test_rotor_behind_its_rim(kind: str) -> None:
    """(k + i w c) / (k + i w c - w^2 J), whatever the belt does; a locked clutch has its damping alone."""
    drive = better(loaded_two_pulley())
    driver, driven = drive.pulleys
    hub = driven.replace(hub=[HUBS[kind]], inertia=0.05)
    motion = ForcedMotion(steady_state(drive.replace(pulley=[driver, hub])), stuck=False)
    spring, damper = (STIFFNESS, DAMPING) if kind == "isolator" else (0.0, HUBS[kind]["locking_damping"])
    own = np.sqrt(STIFFNESS / ROTOR)
    for frequency in own * np.array([0.3, 0.9, 1.0, 1.1, 3.0]):
        found = motion.answer(Excited(float(frequency), {0: 1e-3}, {}))
        rate = spring + 1j * frequency * damper
        expected = rate / (rate - frequency**2 * ROTOR)
        assert found["shaft_speed"][1] / found["pulley_speed"][1] == pytest.approx(expected, rel=1e-6)


def test_rotor_behind_a_decoupler() -> None:
    """A locked one-way clutch and an isolator in one chain: two bodies behind the rim, each in balance of moments."""
    part = 1e-3
    links = [HUBS["decoupler"] | {"inertia": part}, HUBS["isolator"]]
    driver, driven = better(loaded_two_pulley()).pulleys
    drive = better(loaded_two_pulley()).replace(pulley=[driver, driven.replace(hub=links, inertia=0.05)])
    motion = ForcedMotion(steady_state(drive), stuck=False)
    for frequency in np.sqrt(STIFFNESS / ROTOR) * np.array([0.3, 0.9, 1.0, 1.1, 1.5, 2.0, 3.0]):
        found = motion.answer(Excited(float(frequency), {0: 1e-3}, {}))
        clutch, spring = 1j * frequency * HUBS["decoupler"]["locking_damping"], STIFFNESS + 1j * frequency * DAMPING
        balance = [
            [clutch + spring - frequency**2 * part, -spring],
            [-spring, spring - frequency**2 * ROTOR],
        ]
        rotor = np.linalg.solve(np.array(balance), np.array([clutch, 0.0]))[1]
        assert found["shaft_speed"][1] / found["pulley_speed"][1] == pytest.approx(rotor, rel=1e-6)


@pytest.fixture(scope="module")
def motions() -> SmallMotions:
    """Case 2 in steady running."""
    return about_steady(steady_state(better(loaded_two_pulley(1e5))))


@pytest.fixture(scope="module")
def first_order(motions: SmallMotions) -> Pencil:
    return pencil(motions.stiffness, motions.damping, motions.mass, motions.free)


@pytest.fixture(scope="module")
def every(first_order: Pencil) -> ComplexArray:
    return all_eigenvalues(first_order)[0]


@pytest.mark.slow
def test_number_and_pairs_of_modes(motions: SmallMotions, first_order: Pencil, every: ComplexArray) -> None:
    """Two eigenvalues a coordinate; the place of node 0 is one less, and each free motion has one eigenvalue less."""
    coordinates, free = motions.free.shape
    assert every.size == 2 * (coordinates - 1) - free
    assert every.size <= first_order.size
    above, below = every[every.imag > 0.0], every[every.imag < 0.0]
    assert above.size == below.size
    first, second = (values[np.lexsort((values.real, values.imag))] for values in (above, below.conj()))
    np.testing.assert_allclose(first, second, rtol=1e-6)


@pytest.mark.slow
def test_growth_near_contact_is_that_of_all_eigenvalues(
    motions: SmallMotions, first_order: Pencil, every: ComplexArray
) -> None:
    """Of the vibrations near the frequency of the belt on its contact none is taken for another, or for none."""
    shift, state = flutter_shift(motions.system), motions.state
    found = Vibrations(motions.system).fastest_growing(0.0, state.position, state.velocity, shift)
    near = every[np.argsort(np.abs(every - shift))]
    assert np.abs(near - found).min() < 1e-6 * abs(shift)
    assert found.real >= near[:24].real.max() - 1e-6 * abs(shift)
    by_pencil = nearest(first_order, shift, 24)[0]
    np.testing.assert_allclose(np.sort(by_pencil[:24].real), np.sort(near[:24].real), rtol=1e-6)


@pytest.mark.slow
def test_growth_of_a_belt_with_hysteresis() -> None:
    """In units of other masses than one residuals are small of what is no vibration of a belt with hysteresis."""
    belt = {"profile": "PJ-elastic", "ribs": 5, "installed_tension": 155.0}
    driver = {"name": "motor", "center": (0.0, 0.0), "radius": 8e-3, "speed": {"kind": "constant", "value": 1250.0}}
    load = [{"kind": "resistance", "constant": 12.0}]
    drum = {"name": "drum", "center": (0.36, 0.0), "radius": 0.135, "inertia": 1e-3, "load": load}
    simulation = {"duration": 1.0, "output_interval": 0.01}
    drive = Drive(belt=belt, pulley=[driver, drum], contact={"friction": 0.4}, simulation=simulation)
    motions = about_steady(steady_state(drive))
    shift, state = flutter_shift(motions.system), motions.state
    found = Vibrations(motions.system).fastest_growing(0.0, state.position, state.velocity, shift)
    every = all_eigenvalues(pencil(motions.stiffness, motions.damping, motions.mass, motions.free))[0]
    near = every[np.argsort(np.abs(every - shift))]
    assert np.abs(near - found).min() < 1e-6 * abs(shift)
    assert near[:24].real.max() - 1e-6 * abs(shift) <= found.real < 0.0
