"""The paper's cases have the paper's values."""

import numpy as np
import pytest

from beltdyn.model import install
from validation.published import (
    CASES,
    better,
    loaded_case_1,
    loaded_two_pulley,
    three_pulleys,
    two_pulley,
    unequal_pulleys,
)


@pytest.mark.parametrize("name", CASES)
def test_every_case_has_published_settings(name: str) -> None:
    drive = CASES[name].build()
    assert (drive.contact.integration, drive.contact.normal_law) == ("fixed", "published")
    assert (drive.simulation.start, drive.simulation.rtol) == ("laid", 1e-3)
    assert CASES[name].description


def test_two_pulley_takes_what_the_paper_varies() -> None:
    drive = two_pulley(25, youngs_modulus=1e9, creep_rate_factor=1e4)
    assert (drive.elements, drive.belt.youngs_modulus, drive.contact.creep_rate_factor) == (25, 1e9, 1e4)
    assert drive.path.span_lengths == pytest.approx([0.382882, 0.382882], abs=1e-6)


def test_the_loaded_drive_is_that_of_eq_29() -> None:
    drive = loaded_two_pulley(1e5, 7)
    driver, driven = drive.pulleys
    assert (drive.belt_length, drive.belt.bending_factor, drive.elements) == (1.2443, 0.001, 30)
    assert (drive.contact.creep_rate_factor, drive.contact.quadrature_points) == (1e5, 7)
    assert driver.speed is not None
    assert driven.torque is not None
    np.testing.assert_allclose(driver.speed.at([0.05, 0.325, 1.0]), [0.0, 60.0, 120.0])
    np.testing.assert_allclose(driven.torque.at([0.05, 0.3, 1.0]), [0.0, -22.5, -45.0])


def test_only_the_radius_of_the_driven_pulley_differs_in_fig_14() -> None:
    one, other = two_pulley(), unequal_pulleys()
    assert other.pulleys[1].radius == 0.1218
    assert other.replace(pulley=[other.pulleys[0], other.pulleys[1].replace(radius=0.08125)]) == one


def test_three_pulleys_are_stretched_like_two() -> None:
    """The length of their belt is given to 0.1 mm, 0.006 % of it."""
    assert install(three_pulleys()).strain == pytest.approx(install(two_pulley()).strain, abs=6e-5)


def test_the_load_of_case_1_is_a_quarter_of_what_the_belt_carries() -> None:
    drive = loaded_case_1()
    driven = drive.pulleys[1]
    grip = np.exp(drive.contact.friction * drive.path.wrap_angles[1])
    carried = 2.0 * install(drive).tension * driven.radius * (grip - 1.0) / (grip + 1.0)
    assert driven.torque is not None
    assert -float(driven.torque.at(2.0)) / carried == pytest.approx(0.25, abs=0.01)


def test_better_changes_settings_and_not_the_drive() -> None:
    drive = loaded_two_pulley()
    improved = better(drive, 60, rtol=1e-4)
    assert (improved.contact.integration, improved.contact.normal_law) == ("zone", "no_pull")
    assert (improved.simulation.start, improved.simulation.rtol, improved.belt.elements) == ("equilibrium", 1e-4, 60)
    assert improved.pulleys == drive.pulleys
    assert improved.replace(belt=drive.belt, contact=drive.contact, simulation=drive.simulation) == drive
