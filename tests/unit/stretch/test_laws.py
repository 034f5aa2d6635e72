"""What every law of stretch promises (`StretchLaw`): energy, tension and their derivatives belong together."""

import numpy as np
import pytest

from beltdyn.stretch import LAWS, Green, Linear, StretchParameters, stretching

STIFFNESS = 2e4
STRETCHES = np.array([0.8, 0.99, 1.0, 1.001, 1.03, 1.5])


@pytest.fixture(params=list(LAWS))
def law(request: pytest.FixtureRequest) -> StretchParameters:
    made: StretchParameters = LAWS[request.param].make(STIFFNESS)
    return made


def test_stiffness_without_strain(law: StretchParameters) -> None:
    assert law.stiffness == STIFFNESS
    assert float(law.tension(1.0)) == 0.0
    assert float(law.tangent_stiffness(1.0)) == pytest.approx(STIFFNESS, rel=1e-12)


def test_stretch_is_the_inverse_of_tension(law: StretchParameters) -> None:
    np.testing.assert_allclose(law.stretch(law.tension(STRETCHES)), STRETCHES, rtol=1e-12)
    assert np.isnan(law.stretch(np.nan))


def test_tangent_stiffness_is_the_slope_of_the_tension(law: StretchParameters) -> None:
    step = 1e-6
    slope = (law.tension(STRETCHES + step) - law.tension(STRETCHES - step)) / (2 * step)
    np.testing.assert_allclose(law.tangent_stiffness(STRETCHES), slope, rtol=1e-9)


@pytest.mark.parametrize("g", STRETCHES)
def test_energy_gives_the_tension(law: StretchParameters, g: float) -> None:
    """N = 2 g dW/dG and dN/dg = 2 dW/dG + 4 G d2W/dG2; W by central differences in g with a step of 1e-5."""
    here, step = stretching(law, g * g), 1e-5
    tension, stiffness = float(law.tension(g)), float(law.tangent_stiffness(g))
    assert 2.0 * g * here.slope == pytest.approx(tension, rel=1e-12, abs=1e-12 * STIFFNESS)
    assert 2.0 * here.slope + 4.0 * g * g * here.curvature == pytest.approx(stiffness, rel=1e-12)
    up, down = (stretching(law, (g + s) ** 2).energy for s in (step, -step))
    assert (up - down) / (2 * step) == pytest.approx(tension, rel=1e-7, abs=1e-9 * STIFFNESS)
    assert stretching(law, 1.0).energy == 0.0


def test_elastic_belt() -> None:
    """An elastic belt of 4994 N at 3.14 %: 156.8 N as sold, 164.2 N by Green's strain."""
    assert float(Linear(4994.0).tension(1.0314)) == pytest.approx(156.8, abs=0.05)
    assert float(Green(4994.0).tension(1.0314)) == pytest.approx(164.3, abs=0.1)
