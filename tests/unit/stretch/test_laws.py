"""What every law of stretch promises (`StretchLaw`): energy, tension and their derivatives belong together."""

import numpy as np
import pytest

from beltdyn.stretch import Green, Linear, StretchParameters, stretching, through

STRETCHES = np.array([0.8, 0.99, 1.0 + 1e-4, 1.003, 1.033, 1.5])


@pytest.fixture
def law(stretch_law: StretchParameters) -> StretchParameters:
    return stretch_law


def test_stiffness_without_strain(law: StretchParameters) -> None:
    assert law.stiffness == pytest.approx(2e4, rel=0.5)
    assert float(law.tension(1.0)) == 0.0
    assert float(law.tangent_stiffness(1.0)) == pytest.approx(law.stiffness, rel=1e-12)


def test_stretch_is_the_inverse_of_tension(law: StretchParameters) -> None:
    np.testing.assert_allclose(law.stretch(law.tension(STRETCHES)), STRETCHES, rtol=1e-12)
    assert np.isnan(law.stretch(np.nan))


def test_tangent_stiffness_is_the_slope_of_the_tension(law: StretchParameters) -> None:
    step = 1e-7
    slope = (law.tension(STRETCHES + step) - law.tension(STRETCHES - step)) / (2 * step)
    np.testing.assert_allclose(law.tangent_stiffness(STRETCHES), slope, rtol=1e-8)


@pytest.mark.parametrize("g", STRETCHES)
def test_energy_gives_the_tension(law: StretchParameters, g: float) -> None:
    """N = 2 g dW/dG and dN/dg = 2 dW/dG + 4 G d2W/dG2; W by central differences in g with a step of 1e-5."""
    here, step = stretching(law, g * g), 1e-5
    tension, stiffness = float(law.tension(g)), float(law.tangent_stiffness(g))
    assert 2.0 * g * here.slope == pytest.approx(tension, rel=1e-12, abs=1e-12 * law.stiffness)
    assert 2.0 * here.slope + 4.0 * g * g * here.curvature == pytest.approx(stiffness, rel=1e-12)
    up, down = (stretching(law, (g + s) ** 2).energy for s in (step, -step))
    assert (up - down) / (2 * step) == pytest.approx(tension, rel=1e-7, abs=1e-9 * law.stiffness)
    assert stretching(law, 1.0).energy == 0.0


def test_elastic_belt() -> None:
    """An elastic belt of 4994 N at 3.14 %: 156.8 N as sold, 164.2 N by Green's strain."""
    assert float(Linear(4994.0).tension(1.0314)) == pytest.approx(156.8, abs=0.05)
    assert float(Green(4994.0).tension(1.0314)) == pytest.approx(164.3, abs=0.1)


def test_a_measured_law_goes_through_its_points_without_overshoot() -> None:
    strains, tensions = [0.0, 0.01, 0.02, 0.05, 0.06], [0.0, 60.0, 62.0, 180.0, 181.0]
    law = through(strains, tensions)
    np.testing.assert_allclose(law.tension(1.0 + np.array(strains)), tensions, rtol=1e-12)
    between = law.tension(np.linspace(1.0, 1.07, 2000))
    assert np.all(np.diff(between) > 0.0)


def test_a_measured_law_of_points_on_a_line_is_linear() -> None:
    strains = np.array([0.0, 0.01, 0.03, 0.1])
    law, line, g = through(strains, 5e3 * strains), Linear(5e3), np.linspace(0.9, 1.2, 31)
    np.testing.assert_allclose(law.tension(g), line.tension(g), atol=1e-9)
    for one in g:
        np.testing.assert_allclose(stretching(law, one**2), stretching(line, one**2), rtol=1e-9, atol=1e-9)
