"""Six points with links between them, bent by less than half a turn at each, and central differences."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.arrays import FloatArray

Scalar = Callable[[FloatArray], float]
LINK = 0.05
"""Reference length of a link, m."""


@pytest.fixture(scope="session")
def link() -> float:
    return LINK


@pytest.fixture(scope="session")
def straight() -> FloatArray:
    """Unstretched, along the x axis."""
    return np.stack([LINK * np.arange(6), np.zeros(6)], axis=1).ravel()


@pytest.fixture(scope="session")
def polyline() -> Callable[..., FloatArray]:
    """Points of links of given directions (rad) and stretches, from the origin."""

    def make(directions: FloatArray, stretches: FloatArray | float = 1.0) -> FloatArray:
        steps = LINK * np.multiply(stretches, [np.cos(directions), np.sin(directions)])
        return np.vstack([np.zeros(2), np.cumsum(steps.T, axis=0)]).ravel()

    return make


@pytest.fixture(params=range(5))
def deformed(request: pytest.FixtureRequest, polyline: Callable[..., FloatArray]) -> FloatArray:
    """Links stretched by up to a fifth, and bent by up to 2 rad at every point."""
    random = np.random.default_rng(request.param)
    return polyline(np.cumsum(random.uniform(-2.0, 2.0, 5)), random.uniform(0.8, 1.2, 5))


@pytest.fixture(scope="session")
def slope() -> Callable[[Callable[[FloatArray], FloatArray | float], FloatArray], FloatArray]:
    """Central differences with respect to the 12 coordinates; the last axis of the result runs over them."""
    step = 1e-5 * LINK

    def differences(function: Callable[[FloatArray], FloatArray | float], e: FloatArray) -> FloatArray:
        moves = step * np.eye(e.size)
        columns = [np.subtract(function(e + move), function(e - move)) / (2.0 * step) for move in moves]
        return np.stack(columns, axis=-1)

    return differences
