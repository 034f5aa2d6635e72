"""Formulas of belt drives against their own definitions."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beltdyn.contact.friction import CoefficientSlope, ForceSlope, FrictionParameters, RelativeCreep
from beltdyn.model import Drive, Path
from beltdyn.results import Run
from beltdyn.results.mechanics import (
    across,
    cells,
    element_lengths,
    gross_sliding,
    pressing,
    relative_loss,
    rim_speeds,
    sliding_shares,
    sliding_velocity,
    wraps_of_contact,
)

ROUNDING = 1e-9
CENTERS = np.array([[0.0, 0.0], [0.4, 0.0], [0.2, 0.06]])


def serpentine(friction: FrictionParameters | None = None) -> Any:
    """Three pulleys of which the belt's back touches the last, with as much of a drive as the formulas ask for."""
    return SimpleNamespace(
        toothed=np.zeros(3, dtype=bool),
        pulleys=[SimpleNamespace(turning=turning) for turning in (1, 1, -1)],
        radii=np.array([0.1, 0.05, 0.02]),
        rolling_radii=np.array([0.1, 0.05, 0.02]),
        frictions=np.array([0.5, 1.0, 0.3]),
        friction_parameters=friction or ForceSlope(1e3),
        belt=SimpleNamespace(mass_per_length=0.2),
        path=Path(CENTERS, np.array([0.1, 0.05, -0.02])),
    )


def test_rims_run_with_the_belt_on_either_side() -> None:
    """A pulley at the back turns clockwise, and none of the three slips."""
    rim = rim_speeds(np.array([10.0, 20.0, -50.0]), serpentine())
    np.testing.assert_allclose(rim, 1.0)
    np.testing.assert_allclose(relative_loss(-rim, rim, 0), 0.0)


def test_wraps_are_at_most_those_of_straight_spans() -> None:
    """Penetration adds to angles of contact; a belt that has lifted off touches less, or nothing."""
    drive = serpentine()
    straight = drive.path.wrap_angles
    wraps = wraps_of_contact(drive, CENTERS, straight + 0.05)
    np.testing.assert_allclose(wraps, straight)
    assert wraps @ np.sign(drive.path.radii) == pytest.approx(2.0 * np.pi)
    lifted = np.stack([straight * [1.0, 0.5, 0.0], straight + 0.01])
    found = wraps_of_contact(drive, np.stack([CENTERS, CENTERS]), lifted)
    np.testing.assert_allclose(found, [straight * [1.0, 0.5, 0.0], straight])


def test_slip_is_the_loss_against_the_driver_whichever_way_it_runs() -> None:
    for way in (1.0, -1.0):
        rim = way * np.array([1.9, 2.0, 2.1])
        np.testing.assert_allclose(relative_loss(-rim, rim, 1), [0.05, 0.0, -0.05])
    assert np.all(np.isnan(relative_loss(np.ones(2), np.array([0.0, 1.0]), 0)))


def test_spans_before_and_after_pulleys() -> None:
    before, after = across(np.array([1.0, 2.0, 3.0]), serpentine())
    assert before.tolist() == [3.0, 1.0, 2.0]
    assert after.tolist() == [1.0, 2.0, 3.0]


def test_the_last_span_of_an_open_belt_is_the_one_before_the_first_pulley() -> None:
    closed = serpentine().path
    prepared: Any = SimpleNamespace(path=Path(closed.centers, closed.radii, np.array([[-9.0, 0.0], [9.0, 0.0]])))
    before, after = across(np.array([[1.0, 2.0, 3.0, 4.0]]), prepared)
    assert before.tolist() == [[4.0, 1.0, 2.0]]
    assert after.tolist() == [[1.0, 2.0, 3.0]]


def test_cells_share_out_the_belt(drive: Drive) -> None:
    coordinate = np.sort(np.random.default_rng(1).uniform(0.0, drive.belt_length, 50))
    cell = cells(coordinate, drive.belt_length)
    assert cell.sum() == pytest.approx(drive.belt_length)
    assert cell[7] == pytest.approx(0.5 * (coordinate[8] - coordinate[6]))


@pytest.mark.parametrize(
    ("friction", "creep"),
    [
        (ForceSlope(1e3), 0.5 * 200.0 / 1e3),
        (CoefficientSlope(0.02), 0.02),
        (RelativeCreep(0.03, 0.04), 0.05),
    ],
)
def test_sliding_is_what_goes_beyond_creep(friction: FrictionParameters, creep: float) -> None:
    """At mu f_n / nu_s with a slope of the force, at the creep velocity with one of it; at s v_r with a ratio."""
    velocity = np.array([[0.5 * creep, creep + 0.3, -creep - 0.2, 5.0, 5.0]])
    normal = np.array([[200.0, 200.0, 200.0, 0.0, 200.0]])
    touched = np.array([[0, 0, 0, 0, -1]])
    found = sliding_velocity(velocity, normal, touched, np.array([[-10.0, 0.0, 0.0]]), serpentine(friction))
    np.testing.assert_allclose(found, [[0.0, 0.3, -0.2, 0.0, 0.0]], atol=ROUNDING)


def test_shares_of_arcs_that_slide() -> None:
    touched = np.array([[0, 0, 0, 1, 1, -1]])
    sliding = np.array([[0.0, 0.1, 0.1, -0.2, -0.3, 0.0]])
    pressed = pressing(np.full((1, 6), 9.0), touched, 3)
    shares = sliding_shares(sliding, pressed, np.array([2.0, 1.0, 1.0, 1.0, 1.0, 1.0]))
    np.testing.assert_allclose(shares, [[0.5, 1.0, 0.0]])


def test_a_whole_arc_slides_only_if_all_of_it_slides_one_way() -> None:
    touched = np.array([[0, 0, 1, 1, 2, 2]] * 3)
    pressed = pressing(np.full((3, 6), 9.0), touched, 3)
    sliding = np.array(
        [
            [0.2, 0.1, -0.3, -0.4, 0.6, 0.5],
            [0.2, 0.0, -0.3, 0.0, 0.0, 0.5],
            [0.2, -0.1, 0.3, -0.4, 0.0, 0.0],
        ]
    )
    found = gross_sliding(sliding, pressed, serpentine())
    np.testing.assert_allclose(found, [[0.1, -0.3, -0.5], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])


def test_a_pulley_without_contact_does_not_slide() -> None:
    pressed = pressing(np.zeros((1, 2)), np.array([[-1, 0]]), 3)
    assert not gross_sliding(np.array([[1.0, 1.0]]), pressed, serpentine()).any()


def test_lengths_add_up_to_the_belt(run: Run) -> None:
    lengths = element_lengths(run.dataset, run.drive.belt_length)
    assert lengths.shape == (20,)
    assert lengths.sum() == pytest.approx(run.drive.belt_length)
