"""Verified: modes, against closed forms of strings and beams, a lumped model, and an independent code."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.model import Belt, Drive
from beltdyn.published.cases import better, loaded_two_pulley
from beltdyn.solve.modes import modes
from beltdyn.solve.vibration.eigenvalues import pencil, swinging
from beltdyn.solve.vibration.vibrations import Vibrations
from beltdyn.system.build import belt_system
from beltdyn.system.state import straight

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
RIM, HUB, SPRING, SLIDE, RATE = 1e-3, 5e-3, 250.0, 1.5, 3e4


def belted() -> Drive:
    """A crank that stands, a rotor behind an isolator, and a pulley on a slide; a light belt."""
    pulleys: list[dict[str, Any]] = [
        {"name": name, "center": CENTERS[name], "radius": RADII[name], "inertia": RIM} for name in ("rotor", "slide")
    ]
    pulleys[0]["hub"] = [{"kind": "isolator", "stiffness": SPRING, "inertia": HUB}]
    crank = {"name": "crank", "center": CENTERS["crank"], "radius": RADII["crank"], "speed": STILL}
    slide = {"kind": "sliding", "pulley": "slide", "direction": [0.0, 1.0], "mass": SLIDE, "preload": 800.0}
    return Drive(
        belt={
            "width": 0.02,
            "thickness": 1e-3,
            "density": 50.0,
            "youngs_modulus": 5e9,
            "poissons_ratio": 0.3,
            "bending_factor": 1e-3,
            "installed_tension": 450.0,
        },
        pulley=[crank, *pulleys],
        tensioner=[slide | {"rate": RATE}],
        contact=CONTACT,
        simulation={"duration": 1.0, "output_interval": 0.1},
    )


def lumped(axial: float, tension: float) -> FloatArray:
    """Frequencies, Hz, of rims, rotor and slide on spans as springs EA / L, from centres and radii alone.

    A span is a tangent of two pulleys: it stretches by the ways of their rims, and by the motion of the slide along it;
    across it, its tension is a spring T / L.
    """
    rotor, slide, hub, way = np.eye(4)
    turned = {"crank": 0.0 * rotor, "rotor": RADII["rotor"] * rotor, "slide": RADII["slide"] * slide}
    stiffness = RATE * np.outer(way, way) + SPRING * np.outer(rotor - hub, rotor - hub)
    for first, second in (("crank", "rotor"), ("rotor", "slide"), ("slide", "crank")):
        away, difference = np.subtract(CENTERS[second], CENTERS[first]), RADII[first] - RADII[second]
        angle = np.arctan2(away[1], away[0]) + np.arcsin(difference / np.hypot(*away))
        length = np.sqrt(away @ away - difference**2)
        moved = way * ((second == "slide") - (first == "slide"))
        stretch = turned[second] - turned[first] + np.sin(angle) * moved
        swing = np.cos(angle) * moved
        stiffness += (axial * np.outer(stretch, stretch) + tension * np.outer(swing, swing)) / length
    inertia = np.array([RIM, RIM, HUB, SLIDE])
    return np.sort(np.sqrt(np.linalg.eigvals(stiffness / inertia[:, None]).real)) / (2.0 * np.pi)


def test_rims_rotor_and_slide_of_a_lumped_model() -> None:
    drive = belted()
    found = modes(drive, about="rest", count=40).dataset
    expected = lumped(drive.belt.axial_stiffness, 450.0)
    moving = found.frequency.values[(found.kind != "span").values]
    nearest = [moving[np.argmin(np.abs(moving - one))] for one in expected]
    np.testing.assert_allclose(nearest, expected, rtol=0.01)
