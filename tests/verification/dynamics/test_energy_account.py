"""The energy account of a run closes, for both friction laws, and what cannot be lost is not lost."""

from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr

from beltdyn import simulate
from beltdyn.model import Drive
from beltdyn.results.energy_balance import energy_put_in

Change = Callable[..., Drive]
Measured = Callable[..., None]
SLOPE_OF_COEFFICIENT = {"friction_law": "coefficient_slope", "creep_velocity": 0.05, "creep_rate_factor": None}


def closure(run: xr.Dataset) -> float:
    return float(np.max(np.abs(run.energy_closure.values)))


@pytest.mark.parametrize(
    "contact",
    [{}, pytest.param(SLOPE_OF_COEFFICIENT, marks=pytest.mark.slow)],
    ids=["force_slope", "coefficient_slope"],
)
@pytest.mark.parametrize("integration", ["zone", "fixed"])
def test_closes_better_with_tighter_tolerance(
    small: Drive, change: Change, measured: Measured, curve: Measured, contact: dict[str, object], integration: str
) -> None:
    drive = change(small, contact=contact | {"integration": integration})
    errors = [closure(simulate(change(drive, simulation={"rtol": rtol})).dataset) for rtol in (1e-3, 1e-4, 1e-5)]
    measured(rtol_1e3=errors[0], rtol_1e4=errors[1], rtol_1e5=errors[2])
    law = "coefficient slope" if contact else "force slope"
    curve("energy/small", (1e-3, 1e-4, 1e-5), errors, f"{law}, {integration}")
    assert errors[0] < 1e-3
    assert errors[1] < 0.3 * errors[0]
    assert errors[2] < 0.3 * errors[1]


def test_closes_for_the_laid_start(drive: Drive, change: Change, measured: Measured) -> None:
    """The published start at 20 elements, where most of the energy goes into impacts on the pulleys."""
    run = simulate(change(drive, simulation={"duration": 0.02})).dataset
    measured(closure=closure(run), damping_loss=float(run.damping_loss[-1]))
    assert closure(run) < 1e-3
    assert run.damping_loss[-1] > 0.0


@pytest.mark.parametrize(
    ("contact", "lost"),
    [
        ({"friction": 0.0}, {"damping_loss"}),
        ({"damping": 0.0}, {"friction_loss"}),
        ({"friction": 0.0, "damping": 0.0}, set()),
    ],
    ids=["no friction", "no damping", "neither"],
)
def test_no_law_no_loss(small: Drive, change: Change, contact: dict[str, float], lost: set[str]) -> None:
    run = simulate(change(small, contact=contact, simulation={"start": "laid", "duration": 0.005})).dataset
    for name in ("friction_loss", "damping_loss"):
        assert (float(run[name][-1]) > 0.0) == (name in lost)
    assert closure(run) < 3e-3  # five points an element do not resolve the contact of ten elements thrown on a pulley


def test_what_the_integrator_takes_is_told_apart(small: Drive, change: Change, measured: Measured) -> None:
    """A belt that rings without friction: long steps damp it, which is no gap in the account of forces."""
    quiet = change(
        small,
        contact={"friction": 0.0, "quadrature_points": 10},
        simulation={"start": "laid", "duration": 0.03, "rtol": 1e-2},
    )
    run = simulate(quiet).dataset
    taken = run.numerical_loss.values / energy_put_in(run)
    measured(taken=float(taken[-1]), closure=closure(run))
    assert taken[-1] > 0.03
    assert closure(run) < 0.25 * taken[-1]


@pytest.mark.slow
def test_numerical_loss_falls_with_the_tolerance(small: Drive, change: Change, measured: Measured) -> None:
    rtols = (1e-2, 1e-3, 1e-4)
    runs = [
        simulate(change(small, contact={"friction": 0.0}, simulation={"start": "laid", "duration": 0.01, "rtol": rtol}))
        for rtol in rtols
    ]
    taken = [float(run.dataset.numerical_loss[-1]) for run in runs]
    measured(**{f"rtol_{rtol:.0e}": value for rtol, value in zip(rtols, taken, strict=True)})
    assert taken[1] < 0.5 * taken[0]
    assert taken[2] < 0.5 * taken[1]


def test_quadrature_of_the_zone_sets_the_floor(small: Drive, change: Change, measured: Measured) -> None:
    """Forces integrated on a moving zone are not the exact gradient of the integrated penalty energy."""
    laid = change(small, simulation={"start": "laid", "duration": 0.005, "rtol": 1e-4})
    errors = [closure(simulate(change(laid, contact={"quadrature_points": k})).dataset) for k in (5, 10)]
    measured(points_5=errors[0], points_10=errors[1])
    assert errors[1] < 2e-4
    assert errors[1] < 0.2 * errors[0]


def test_free_running_drive_keeps_its_energy_but_for_losses(small: Drive, change: Change) -> None:
    """A driver at rest and no torque: nothing is put in, and the stored energy only falls."""
    pulleys = [pulley.model_dump(exclude_none=True) for pulley in small.pulleys]
    pulleys[0]["speed"], pulleys[1]["torque"] = ({"kind": "constant", "value": 0.0} for _ in range(2))
    run = simulate(change(small, pulley=pulleys, simulation={"start": "laid", "duration": 0.01, "rtol": 1e-4})).dataset
    stored = (run.kinetic_energy + run.strain_energy + run.penalty_energy).values
    np.testing.assert_array_equal(run.driver_work, 0.0)
    np.testing.assert_array_equal(run.torque_work, 0.0)
    assert np.all(np.diff(stored) <= 2e-3 * stored[0])  # the floor of the quadrature
    assert stored[-1] < 0.9 * stored[0]
