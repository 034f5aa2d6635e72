"""What is derived from results, on drives whose answer theory knows."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.model import Drive
from beltdyn.results import Run, summarize
from beltdyn.results.derived import balance, pulley_powers, slip_safety, slips
from beltdyn.transient.simulate import simulate

Measured = Callable[..., None]
Change = Callable[..., Drive]
RIM = 12.0 * 0.08125


def slipping(drive: Drive, change: Change, elements: int) -> Run:
    """Load the two-pulley drive with 3 N m, of which friction of 0.3 transmits 2: it slides through from 0.13 s on."""
    driver, driven = drive.pulleys
    pulleys: list[Any] = [
        driver.replace(speed={"kind": "ramp", "start": 0.0, "end": 0.05, "value": 12.0}),
        driven.replace(inertia=0.02, torque={"kind": "cosine_ramp", "start": 0.1, "end": 0.15, "value": -3.0}),
    ]
    return simulate(
        change(
            drive,
            pulley=[pulley.model_dump(exclude_none=True) for pulley in pulleys],
            belt={"elements": elements},
            contact={"friction": 0.3, "damping": 100.0},  # with the published 10 N s/m^2 the sliding belt flutters
            simulation={"duration": 0.3, "start": "equilibrium"},
        )
    )


@pytest.mark.slow
def test_a_drive_that_slides_through_has_the_slip_safety_of_a_capstan(
    drive: Drive, change: Change, measured: Measured
) -> None:
    """The slip safety, from tensions, says 1 when the whole arc slides, which is seen from slip velocities.

    It counts the angle between the spans: within 0.5 % on both meshes.
    """
    coarse, fine = slipping(drive, change, 40), slipping(drive, change, 80)
    errors = [float(np.abs(slip_safety(run, start=0.25).mean("time") - 1.0).max()) for run in (coarse, fine)]
    measured(coarse=errors[0], fine=errors[1])
    assert max(errors) < 0.005
    driver, driven = summarize(fine).pulleys
    assert driven.sliding_arc == pytest.approx(driven.wrap_angle)
    parts = slips(fine, start=0.25)
    # creep of a sliding belt: its stretch, 24 N of 10 kN, and mu f_n / nu_s on both pulleys
    stretch, creep = 24.0 / 1e4, 2.0 * 0.3 * 40.0 / 0.08125 / 1e5 / RIM
    assert float(np.abs(parts["creep"]).max()) < 100.0 * 2.0 * (stretch + creep)
    assert float(parts["sliding"][:, 1].min()) > 50.0
    assert any("gross slip: the belt slides on the whole arc" in warning for warning in fine.warnings)
    assert driver.slip == 0.0


def test_powers_of_the_shafts_are_the_works_that_were_integrated(small: Drive, change: Change) -> None:
    """By the trapezoidal rule over outputs 0.1 ms apart, whose error is a twelfth of the square of that over 30 ms."""
    run = simulate(change(small, simulation={"output_interval": 1e-4}))
    dataset = run.dataset
    power = pulley_powers(run)["power_in"].sum("pulley")
    work = dataset["driver_work"] + dataset["torque_work"]
    gained = float(np.trapezoid(power, power["time"]))
    assert gained == pytest.approx(float(work[-1] - work[0]), rel=1e-3)


def test_what_comes_in_is_taken_out_lost_or_stored(small: Drive, change: Change) -> None:
    """To the closure of the energy account and the sampling of the powers."""
    run = simulate(change(small, simulation={"output_interval": 1e-4}))
    whole = balance(run)
    missing = whole.power_in - whole.power_out - whole.lost - whole.stored
    assert abs(missing) < 1e-2 * whole.power_in
