"""A pulley, both friction laws, and the control points of random belt-like curves of several degrees."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import strategies as st

from beltdyn.arrays import FloatArray, records
from beltdyn.contact.contact_zone import fill_bernstein
from beltdyn.contact.friction import LAWS, FrictionParameters
from beltdyn.contact.law import ContactLaw, PulleyState
from beltdyn.contact.normal import NoPull
from beltdyn.contact.surface import KINDS, SHAPE, SHAPES, Round, ShapedRims, surface_at


@pytest.fixture(scope="session")
def pulley() -> PulleyState:
    return PulleyState(0.3, -0.2, Round(0.1), speed=7.0, friction=0.5, rolling=0.02)


@pytest.fixture(scope="session")
def eccentric() -> Callable[[float], PulleyState]:
    """The same pulley with a rim that is 4 mm eccentric, at an angle."""
    table = records(SHAPE, reach=[4e-3])
    SHAPES.fill(table[0], KINDS["eccentric"], {"eccentricity": 4e-3, "eccentric_angle": 0.3})

    def at(angle: float) -> PulleyState:
        surface = surface_at(ShapedRims(np.array([0.1]), table), 0, angle)
        return PulleyState(0.3, -0.2, surface, speed=7.0, friction=0.5, rolling=0.02)

    return at


@pytest.fixture(scope="session", params=sorted(LAWS))
def friction(request: pytest.FixtureRequest) -> FrictionParameters:
    """Every friction law with usual parameters, smoothed so that the points of tests are not all saturated."""
    law = LAWS[request.param]
    made: FrictionParameters = law.record(*(parameter.example for parameter in law.parameters)).smoothed(40.0)
    return made


@pytest.fixture(scope="session")
def law(friction: FrictionParameters) -> ContactLaw:
    return ContactLaw(NoPull(1e6, 40.0), friction, follow_zone=True, arm_to_rim=False)


@pytest.fixture(scope="session")
def place() -> Callable[[PulleyState, float, float], tuple[float, float]]:
    """Point at a penetration and an angle."""

    def at(pulley: PulleyState, penetration: float, angle: float) -> tuple[float, float]:
        distance = pulley.surface.radius - penetration
        return pulley.center_x + distance * np.cos(angle), pulley.center_y + distance * np.sin(angle)

    return at


@pytest.fixture(scope="session")
def elevate() -> Callable[[FloatArray, int], FloatArray]:
    """Write a curve of degree p (control points, or what makes them, in rows) as one of a higher degree."""

    def raised(control: FloatArray, degree: int) -> FloatArray:
        while len(control) <= degree:
            count = len(control)
            share = (np.arange(count + 1) / count)[:, None]
            padded = np.vstack([control[:1], control, control[-1:]])
            control = share * padded[:-1] + (1.0 - share) * padded[1:]
        return control

    return raised


@pytest.fixture(scope="session")
def make_curve() -> Callable[..., FloatArray]:
    """Control points of a curve that begins near the unit circle and turns."""

    def curve(start: float, radius: float, heading: float, turn: float, length: float, stretch: float) -> FloatArray:
        directions = start + np.pi / 2 + heading + np.array([0.0, turn, 0.5 * turn])
        first, last, chord = np.stack([np.cos(directions), np.sin(directions)], axis=1)
        begin = radius * np.array([np.cos(start), np.sin(start)])
        end = begin + stretch * length * chord
        return np.array([begin, begin + length / 3 * first, end - length / 3 * last, end])

    return curve


@pytest.fixture(scope="session")
def belt_like(make_curve: Callable[..., FloatArray]) -> st.SearchStrategy[FloatArray]:
    """Control points of curves from near the unit circle, up to half of it long, that turn by up to half a turn."""
    return st.builds(
        make_curve,
        st.floats(0.0, 6.28),
        st.floats(0.7, 1.3),
        st.floats(-0.8, 0.8),
        st.floats(-3.14, 3.14),
        st.floats(0.05, 3.14),
        st.floats(0.6, 1.1),
    )


@pytest.fixture(scope="session")
def wave() -> Callable[[float], FloatArray]:
    """Control points of a curve of degree 7 along the unit circle that swings through it seven times.

    It does so like a Chebyshev polynomial, and begins outside for a positive sign.
    """
    places = 0.5 - 0.5 * np.cos(np.pi * np.arange(8) / 7.0)
    weights = np.empty((8, 8))
    for xi, row in zip(places, weights, strict=True):
        fill_bernstein(xi, row)

    def along_the_rim(sign: float) -> FloatArray:
        swing = 1e-3 * sign * np.cos(np.pi * np.arange(8))
        return np.asarray(np.linalg.solve(weights, np.stack([0.01 * (places - 0.5), 1.0 + swing], axis=1)))

    return along_the_rim
