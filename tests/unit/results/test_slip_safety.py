"""The slip safety against closed forms, of whatever holds the tension of the belt."""

import math
from importlib.resources import files

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, loads, prepare
from beltdyn.results.mechanics import SpanTension
from beltdyn.results.slip_safety import grip_of_states, slip_safety_of_states
from beltdyn.theory.creep import tight_tension

EXACT = 1e-5


def example(name: str) -> Drive:
    return loads(files("beltdyn").joinpath("examples", f"{name}.toml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def slid(drive: Drive) -> Drive:
    """Two equal pulleys, one of them on a slide along the spans, whose weight holds the sum of both tensions."""
    slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0}
    return drive.replace(tensioner=[slide])


def sliding(drive: Drive, slack: float, speed: float) -> FloatArray:
    """Tensions with which both pulleys slide, the tight one first."""
    wrap, friction = float(drive.path.wrap_angles[0]), float(drive.frictions[0])
    mass = drive.belt.mass_per_length
    return np.array([tight_tension(slack, friction, wrap, mass_per_length=mass, speed=speed), slack])


def safeties(drive: Drive, tension: FloatArray, speed: float = 0.0) -> FloatArray:
    uniform = SpanTension.uniform(tension)
    return slip_safety_of_states(uniform, np.full(tension.shape, speed), drive.centers, prepare(drive)).all_loads


@pytest.mark.parametrize("speed", [0.0, 12.0, -12.0])
@pytest.mark.parametrize("factor", [0.01, 0.2, 0.7, 1.0, 1.4])
def test_a_slide_along_the_spans_holds_the_sum(slid: Drive, factor: float, speed: float) -> None:
    edge = sliding(slid, 40.0, speed)
    mean, half = edge.mean(), 0.5 * (edge[0] - edge[1])
    tension = mean + factor * half * np.array([1.0, -1.0])
    np.testing.assert_allclose(safeties(slid, tension, speed), 1.0 / factor, rtol=EXACT)


@given(slack=st.floats(20.0, 500.0), speed=st.floats(-8.0, 8.0))
def test_a_belt_that_slides_on_the_whole_arc_has_the_slip_safety_one(drive: Drive, slack: float, speed: float) -> None:
    np.testing.assert_allclose(safeties(drive, sliding(drive, slack, speed), speed), 1.0, rtol=EXACT)
    edge = SpanTension.uniform(sliding(drive, slack, speed))
    used = grip_of_states(edge, np.full(2, speed), drive.centers, prepare(drive)).used
    np.testing.assert_allclose(used, 1.0, rtol=EXACT)


def test_fixed_centers_hold_the_length_and_not_quite_the_sum(drive: Drive) -> None:
    """Two equal pulleys under a load f times that at which they slide: the belt on spans and arcs is as long there.

    Up to a sliding arc of ln(T1 / T2) / mu the arcs have the tension of the span that reaches them. The slip
    safety takes the sliding arcs at their mean tension: within 0.5 %.
    """
    law, radius = drive.belt.stretch_parameters, float(drive.radii[0])
    wrap, friction = float(drive.path.wrap_angles[0]), float(drive.frictions[0])
    span = float(drive.path.span_lengths[0])

    def belt(tight: float, slack: float) -> float:
        """Unstretched length on a hard path, by quadrature along the sliding arcs."""
        total = span / law.stretch(tight) + span / law.stretch(slack)
        angle = math.log(tight / slack) / friction
        along = np.linspace(0.0, angle, 2001)
        slid = np.trapezoid(1.0 / law.stretch(slack * np.exp(friction * along)), along)
        stuck = (wrap - angle) * (1.0 / law.stretch(tight) + 1.0 / law.stretch(slack))
        return float(total + radius * (stuck + 2.0 * slid))

    hard = drive.replace(contact=drive.contact.replace(stiffness=1e12))
    tight, slack = 60.0, 30.0
    found = float(safeties(hard, np.array([tight, slack]), 1e-9)[0])
    ratio = math.exp(friction * wrap)
    edge = brentq(lambda one: belt(one * ratio, one) - belt(tight, slack), 1.0, 100.0)
    assert found == pytest.approx(edge * (ratio - 1.0) / (tight - slack), rel=5e-3)
    held = (tight + slack) * math.tanh(0.5 * friction * wrap) / (tight - slack)
    assert found != pytest.approx(held, rel=0.1)


@pytest.mark.parametrize(("held", "load"), [("slack", 12.0), ("tight", 80.0), ("tight", 5.0)])
def test_the_end_of_a_belt_that_is_pulled_keeps_its_tension(held: str, load: float) -> None:
    """A band brake: Euler's largest difference of tensions over the present one."""
    drive = example("band_brake").with_({"belt.mass_per_length": 1e-9})
    grip = math.exp(float(drive.frictions[0] * drive.path.wrap_angles[0]))
    (pulled,) = (number for number, end in enumerate(drive.ends) if not end.held)
    span = (-1, -2)[pulled]
    tension = np.full(drive.path.spans, 100.0 + (load if held == "slack" else -load))
    tension[span] = 100.0
    most = 100.0 * (grip - 1.0 if held == "slack" else 1.0 - 1.0 / grip)
    assert float(safeties(drive, tension)[0]) == pytest.approx(most / load, rel=EXACT)


def test_a_spring_on_the_slack_side_holds_its_tension() -> None:
    """Its arm hardly turns: Euler's largest difference at the present slack tension, over the present one."""
    drive = example("alternator_drive").replace(contact={"friction": 0.1})
    tension = np.array([300.0, 300.0, 540.0])
    found = safeties(drive, tension)
    grip = np.exp(drive.frictions * drive.path.wrap_angles)[[0, 2]]
    held_sum = (840.0 * np.tanh(0.5 * np.log(grip)) / 240.0).min()
    assert np.isnan(found[1])
    assert float(np.nanmin(found)) == pytest.approx(300.0 * (grip.min() - 1.0) / 240.0, rel=0.05)
    assert float(np.nanmin(found)) > 1.1 * held_sum


def test_safeties_of_many_instants_are_those_of_each() -> None:
    drive = example("alternator_drive").replace(contact={"friction": 0.1})
    tension = np.array([[300.0, 300.0, 540.0], [200.0, 201.0, 260.0], [100.0, 100.0, 900.0], [np.nan, 1.0, 2.0]])
    speed, centers = np.full((4, 3), 11.0), np.tile(drive.centers, (4, 1, 1))
    found = slip_safety_of_states(SpanTension.uniform(tension), speed, centers, prepare(drive)).all_loads
    for row in range(4):
        np.testing.assert_allclose(found[row], safeties(drive, tension[row], 11.0), rtol=EXACT)
    assert found[2, 2] < 1.0
    assert np.isnan(found[3]).all()


def test_slip_safety_without_load_or_grip(drive: Drive) -> None:
    for tension in ([100.0, 100.0], [100.0, 100.0 + 1e-12]):
        assert np.all(np.isnan(safeties(drive, np.array(tension))))
    assert np.all(safeties(drive, np.array([10.0, 12.0]), 50.0) == 0.0)  # m v^2 = 260 N lifts the belt off
