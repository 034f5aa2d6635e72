"""Verified: modes, against closed forms of strings and beams, a lumped model, and an independent code."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import optimize

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.model import Belt, Drive
from beltdyn.points.changed_drive import at_speed, driver_of, held_at
from beltdyn.solvers.eigenvalues import all_eigenvalues, lightly_damped, pencil, swinging, swings
from beltdyn.solvers.flutter import Vibrations
from beltdyn.system.build import belt_system
from beltdyn.system.state import straight
from beltdyn.vibration.modes import modes
from beltdyn.vibration.small_motions import about_steady
from validation.published.cases import better, loaded_two_pulley

TENSION, MASS, LENGTH, STIFFNESS = 200.0, 0.1, 0.4, 0.01
"""Of a tensioned beam: N, kg/m, m, N m^2."""


def test_tensioned_beam_between_pins() -> None:
    """f_n = n / (2 L) sqrt(T / m) sqrt(1 + n^2 pi^2 EI / (T L^2)); 55.99 Hz with these numbers."""
    width, thickness = 0.01, 2e-3
    modulus = 12.0 * STIFFNESS / (width * thickness**3)
    part = 2.0 * TENSION / (modulus * width * thickness)
    strain = float(np.roots([1.0, 0.0, -1.0, -part])[0].real) - 1.0  # T = EA g (g^2 - 1) / 2
    beam = Belt(
        length=LENGTH / (1.0 + strain),
        width=width,
        thickness=thickness,
        density=MASS / (width * thickness) * (1.0 + strain),
        youngs_modulus=modulus,
        poissons_ratio=0.0,
        elements=60,
    )
    system = belt_system(beam, closure="open", fixed=[(0, 0), (0, 1), (-1, 0), (-1, 1)])
    state = straight(system)
    nodes = state.nodes(system)
    nodes[:, [0, 2]] *= 1.0 + strain
    vibrations = Vibrations(system)
    kept = np.flatnonzero(~system.supports.fixed)
    tangents = vibrations.tangents(0.0, state.position, state.velocity)
    stiffness, damping, mass = (vibrations.matrix(one)[kept][:, kept] for one in tangents)
    found = swinging(pencil(stiffness, damping, mass, np.zeros((kept.size, 0))), 3)[0].imag / (2.0 * np.pi)
    number = np.arange(1, 4)
    string = number / (2.0 * LENGTH) * np.sqrt(TENSION / MASS)
    expected = string * np.sqrt(1.0 + (number * np.pi / LENGTH) ** 2 * STIFFNESS / TENSION)
    assert expected[0] == pytest.approx(55.99, abs=5e-3)
    np.testing.assert_allclose(found, expected, rtol=1e-3)


def spans_of(result: bd.Result, span: int, count: int) -> list[int]:
    """Numbers of the slowest modes of one span alone."""
    dataset = result.dataset
    own = dataset.span_share.values
    chosen = np.flatnonzero((dataset.kind.values == "span") & (own.argmax(axis=1) == span))
    return [int(number) for number in chosen[:count]]


@pytest.fixture(scope="module")
def thread() -> bd.Run:
    """A belt almost without bending stiffness on hard pulleys under load, at 40 m/s: its spans have two tensions."""
    pulleys = [
        {"name": "driver", "center": [0.0, 0.0], "radius": 0.05, "speed": {"kind": "constant", "value": 800.0}},
        {
            "name": "driven",
            "center": [0.6, 0.0],
            "radius": 0.05,
            "inertia": 0.01,
            "torque": {"kind": "constant", "value": -10.0},
        },
    ]
    drive = Drive(
        belt={
            "width": 0.02,
            "thickness": 2e-3,
            "density": 2000.0,
            "youngs_modulus": 5e9,
            "poissons_ratio": 0.3,
            "bending_factor": 1e-4,
            "installed_tension": 600.0,
        },
        pulley=pulleys,
        contact=CONTACT,
        simulation={"duration": 1.0, "output_interval": 0.1},
    )
    return bd.steady_state(drive)


@pytest.fixture(scope="module")
def thread_modes(thread: bd.Run) -> bd.Result:
    return modes(thread.drive, about=thread, count=14)


def string_of(run: bd.Run, span: int) -> tuple[float, float, float]:
    """Wave speed in the belt and speed of the belt, m/s, by unit length of stretched belt, and length of the span."""
    instant = run.dataset.isel(time=-1)
    tension, speed = float(instant.span_tension[span]), float(instant.belt_speed[span])
    stretch = 1.0 + tension / run.drive.belt.axial_stiffness
    mass = run.drive.belt.mass_per_length / stretch
    return np.sqrt(tension / mass), speed, float(run.drive.path.span_lengths[span])


@pytest.mark.slow
@pytest.mark.parametrize("span", [0, 1])
def test_moving_string(thread: bd.Run, thread_modes: bd.Result, span: int) -> None:
    """f_n = n (c^2 - v^2) / (2 L c) (Mote 1965), and the phase advances by omega v / (c^2 - v^2) along the span."""
    wave, speed, length = string_of(thread, span)
    numbers = spans_of(thread_modes, span, 3)
    frequency = thread_modes.dataset.frequency.values[numbers]
    expected = np.arange(1, 4) * (wave**2 - speed**2) / (2.0 * length * wave)
    assert speed / wave > 0.2
    np.testing.assert_allclose(frequency, expected, rtol=0.01)
    phase, place = phase_along(thread_modes, numbers[0], span)
    slope = np.polyfit(place, phase, 1)[0]
    assert slope == pytest.approx(2.0 * np.pi * frequency[0] * speed / (wave**2 - speed**2), rel=1e-3)


BENT = {"axial_stiffness": 1e5, "bending_stiffness": 0.2, "mass_per_length": 0.1}
"""A stiff belt: N, N m^2, kg/m."""


@pytest.fixture(scope="module")
def stiff() -> bd.Run:
    """A stiff belt at 25 m/s on large pulleys under load: bending reaches 20 mm into spans of 0.6 m."""
    pulleys = [
        {"name": "driver", "center": [0.0, 0.0], "radius": 0.2, "speed": {"kind": "constant", "value": 125.0}},
        {
            "name": "driven",
            "center": [0.6, 0.0],
            "radius": 0.2,
            "inertia": 5.0,
            "torque": {"kind": "constant", "value": -20.0},
        },
    ]
    return bd.steady_state(
        Drive(
            belt={"width": 0.02, "thickness": 2e-3, "installed_tension": 600.0} | BENT,
            pulley=pulleys,
            contact=CONTACT,
            simulation={"duration": 1.0, "output_interval": 0.1},
        )
    )


def travelling_beam(tension: float, speed: float, mass: float, length: float, guess: float) -> float:
    """Frequency, Hz, of a tensioned beam that moves through clamps, near a guess.

    EI w_xxxx + m (w_tt + 2 v w_xt + v^2 w_xx) = T w_xx has waves exp(i (omega t + k x)) with four k; clamps hold w and
    w_x.  The determinant is divided by that of Vandermonde, which vanishes where two k are one.
    """
    bending = BENT["bending_stiffness"]

    def determinant(omega: complex) -> complex:
        terms = [bending, 0.0, tension - mass * speed**2, -2.0 * mass * speed * omega, -mass * omega**2]
        waves = np.roots(terms)
        ends = np.exp(1j * waves * length)
        rows = np.array([1.0 + 0.0 * waves, waves, ends, waves * ends]) / np.maximum(np.abs(ends), 1.0)
        return complex(np.linalg.det(rows) / np.linalg.det(np.vander(waves)))

    solve: Callable[..., Any] = optimize.newton
    return float(solve(determinant, complex(2.0 * np.pi * guess), tol=1e-9).real) / (2.0 * np.pi)


@pytest.mark.slow
def test_travelling_beam(stiff: bd.Run, measured: Callable[..., None]) -> None:
    """A belt leaves a hard pulley clamped, behind the tangent by l = sqrt(EI / (T - m v^2)).

    It has the curvature 1 / R of the pulley there, which dies away as exp(-x / l) along the span: so its slope l / R is
    that of the pulley l before the tangent.  What moves keeps place and slope there, to first order.  Bent ends make
    spans stretch as they swing, which is left out here: a belt of four times the EA swings faster by 0.7 % at most.
    """
    found, instant = modes(stiff.drive, about=stiff, count=18).dataset, stiff.dataset.isel(time=-1)
    for span, straight_length in enumerate(stiff.drive.path.span_lengths):
        tension, speed = float(instant.span_tension[span]), float(instant.belt_speed[span])
        mass = BENT["mass_per_length"] / (1.0 + tension / BENT["axial_stiffness"])
        reach, wave = np.sqrt(BENT["bending_stiffness"] / (tension - mass * speed**2)), np.sqrt(tension / mass)
        string = np.arange(1, 4) * (wave**2 - speed**2) / (2.0 * float(straight_length) * wave)
        length = float(straight_length) + 2.0 * reach
        guesses = zip(string, (1.0, 1.05, 1.1), strict=True)
        expected = np.array([travelling_beam(tension, speed, mass, length, one * more) for one, more in guesses])
        own = (found.kind == "span").values & (found.span_share.values.argmax(axis=1) == span)
        frequency = found.frequency.values[own]
        nearest = frequency[np.abs(frequency[:, None] - expected).argmin(axis=0)]
        for number in range(3):
            measured(found=nearest[number], beam=expected[number], string=string[number])
        assert speed / wave > 0.3
        np.testing.assert_allclose(nearest, expected, rtol=5e-3)
        assert nearest[2] > 1.05 * string[2]


def phase_along(result: bd.Result, number: int, span: int) -> tuple[FloatArray, FloatArray]:
    """Phase of the displacement, rad, over the place along the span, m, in the middle two thirds of it."""
    one = result.dataset.isel(mode=number)
    path = result.drive.path
    start, end = path.span_points[span]
    along = (one.point_position.values - start) @ (end - start) / float(path.span_lengths[span]) ** 2
    middle = (one.point_span.values == span) & (along > 1.0 / 6.0) & (along < 5.0 / 6.0)
    middle &= np.abs(one.point_normal.values @ (end - start)) < 1e-2
    shape: NDArray[np.complex128] = one.belt_shape.values[0, middle] + 1j * one.belt_shape.values[1, middle]
    order = np.argsort(along[middle])
    return np.unwrap(np.angle(shape[order])), along[middle][order] * float(path.span_lengths[span])


@pytest.mark.slow
def test_case_2_by_an_independent_code() -> None:
    """Spans 147.95 and 177.86 Hz, rotation 25.27 Hz with a decay of 27.6 1/s on 26 elements without shear."""
    run = bd.steady_state(better(loaded_two_pulley(1e5)), force_tolerance=2e-3)
    dataset = modes(run.drive, about=run, count=3).dataset
    assert dataset.kind.values.tolist() == ["rotational", "span", "span"]
    np.testing.assert_allclose(dataset.frequency, [25.27, 147.95, 177.86], rtol=2e-3)
    assert float(dataset.growth_rate[0]) == pytest.approx(-27.6, rel=0.015)


RADII = {"crank": 0.06, "rotor": 0.05, "slide": 0.04}
CENTERS = {"crank": (0.0, 0.0), "rotor": (0.45, 0.0), "slide": (0.2, 0.3)}
CONTACT = {
    "stiffness": 1e9,
    "damping": 10.0,
    "friction": 0.8,
    "friction_law": "force_slope",
    "creep_rate_factor": 1e6,
}
STILL = {"kind": "constant", "value": 0.0}
RIM, HUB, SPRING, SLIDE, RATE, TIGHT = 1e-3, 5e-3, 250.0, 1.5, 3e4, 450.0


ARM = 0.15
"""From the pivot to the center of the pulley, m."""
UP, ASKEW = np.pi / 2.0, 2.0
"""Directions in which a pulley is free to move, rad."""


def belted(tensioner: dict[str, Any]) -> Drive:
    """A crank that stands, a rotor behind an isolator, and a pulley on a tensioner; a light belt."""
    pulleys: list[dict[str, Any]] = [
        {"name": name, "center": CENTERS[name], "radius": RADII[name], "inertia": RIM} for name in ("rotor", "slide")
    ]
    pulleys[0]["hub"] = [{"kind": "isolator", "stiffness": SPRING, "inertia": HUB}]
    crank = {"name": "crank", "center": CENTERS["crank"], "radius": RADII["crank"], "speed": STILL}
    return Drive(
        belt={
            "width": 0.02,
            "thickness": 1e-3,
            "density": 50.0,
            "youngs_modulus": 5e9,
            "poissons_ratio": 0.3,
            "bending_factor": 1e-3,
            "installed_tension": TIGHT,
        },
        pulley=[crank, *pulleys],
        tensioner=[{"pulley": "slide"} | tensioner],
        contact=CONTACT,
        simulation={"duration": 1.0, "output_interval": 0.1},
    )


def lumped(axial: float, direction: float, arm: float | None = None) -> tuple[FloatArray, float]:
    """Frequencies, Hz, of rims, rotor and a pulley on a tensioner on spans as springs EA / L; and its balance, N.

    From centers and radii alone.  A span is a tangent of two pulleys: it stretches by the ways of their rims, and by
    the motion of the pulley along it; across it, its tension is a spring T / L.  An arm draws its pulley back by
    s^2 / (2 a) on a way s, against the pull of both spans along it.
    """
    rotor, slide, hub, way = np.eye(4)
    turned = {"crank": 0.0 * rotor, "rotor": RADII["rotor"] * rotor, "slide": RADII["slide"] * slide}
    stiffness = RATE * np.outer(way, way) + SPRING * np.outer(rotor - hub, rotor - hub)
    pull = np.zeros(2)
    for first, second in (("crank", "rotor"), ("rotor", "slide"), ("slide", "crank")):
        away, difference = np.subtract(CENTERS[second], CENTERS[first]), RADII[first] - RADII[second]
        angle = np.arctan2(away[1], away[0]) + np.arcsin(difference / np.hypot(*away))
        length = np.sqrt(away @ away - difference**2)
        moves = float(second == "slide") - float(first == "slide")
        stretch = turned[second] - turned[first] + np.cos(angle - direction) * moves * way
        swing = np.sin(angle - direction) * moves * way
        stiffness += (axial * np.outer(stretch, stretch) + TIGHT * np.outer(swing, swing)) / length
        pull -= moves * TIGHT * np.array([np.cos(angle), np.sin(angle)])
    if arm is not None:  # lies a quarter turn behind the direction in which its pulley moves
        outward = np.array([np.sin(direction), -np.cos(direction)])
        stiffness += pull @ outward / arm * np.outer(way, way)
    inertia = np.array([RIM, RIM, HUB, SLIDE])
    frequencies = np.sort(np.sqrt(np.linalg.eigvals(stiffness / inertia[:, None]).real)) / (2.0 * np.pi)
    return frequencies, -float(pull @ [np.cos(direction), np.sin(direction)])


def require_modes(drive: Drive, expected: FloatArray) -> FloatArray:
    """Make sure that modes at rest are those of the lumped model; what they are, Hz."""
    found = modes(drive, about="rest", count=40).dataset
    moving = found.frequency.values[(found.kind != "span").values]
    nearest = np.array([moving[np.argmin(np.abs(moving - one))] for one in expected])
    np.testing.assert_allclose(nearest, expected, rtol=0.01)
    return nearest


@pytest.mark.slow
def test_rims_rotor_and_slide_of_a_lumped_model() -> None:
    slide = {"kind": "sliding", "direction": [0.0, 1.0], "mass": SLIDE, "preload": 800.0, "rate": RATE}
    drive = belted(slide)
    require_modes(drive, lumped(drive.belt.axial_stiffness, UP)[0])


@pytest.mark.parametrize("direction", [pytest.param(UP, marks=pytest.mark.slow), ASKEW])
def test_rims_rotor_and_arm_of_a_lumped_model(direction: float, measured: Callable[..., None]) -> None:
    """An arm of the same mass and rate at its pulley; of two directions of the arm one is askew to the spans."""
    x, y = CENTERS["slide"]
    arm = {
        "kind": "rotary",
        "pivot": [x - ARM * np.sin(direction), y + ARM * np.cos(direction)],
        "inertia": SLIDE * ARM**2,
        "preload": ARM * lumped(1.0, direction)[1],
        "rate": RATE * ARM**2,
    }
    drive = belted(arm)
    expected, _ = lumped(drive.belt.axial_stiffness, direction, ARM)
    for lone, found in zip(expected, require_modes(drive, expected), strict=True):
        measured(lumped=lone, found=found)


@pytest.mark.parametrize("speed", [0.3, pytest.param(0.01, marks=pytest.mark.slow)])
def test_near_standstill_modes_are_those_of_all_eigenvalues(speed: float) -> None:
    """Among hundreds of creeping motions that do not swing, of an arc whose friction hardly lets it slip."""
    drive = held_at(bd.example("flat_belt_idler"), None)
    drive = at_speed(drive, driver_of(drive), speed)
    motions = about_steady(bd.steady_state(drive, force_tolerance=0.5))
    given = pencil(motions.stiffness, motions.damping, motions.mass, motions.free)
    every = all_eigenvalues(given)[0]
    assert np.count_nonzero((every.real < 0.0) & (every.imag == 0.0) & (every.real > -1e3)) > 50
    light = np.sort_complex(1j * every[swings(every) & lightly_damped(every)].conj())[:8]
    for count in (1, 8):
        found = swinging(given, count, counted=lightly_damped)[0]
        found = np.sort_complex(1j * found[lightly_damped(found)].conj())
        np.testing.assert_allclose(found, light[:count], rtol=1e-6)
