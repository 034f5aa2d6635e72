"""Verified: traction by prescribed slip, against an independent code and Euler's formula."""

from collections.abc import Callable

import numpy as np

from beltdyn.points.traction import traction
from validation.published.cases import better, loaded_two_pulley

INDEPENDENT = {0.01: 10.24, 0.02: 20.50, 0.04: 40.86, 0.07: 70.23, 0.10: 95.61, 0.15: 116.10}
"""Case 2 of the paper with mu = 0.3 by an independent code without shear, 48 elements: slip, torque (N m)."""
GROSS = {0.2: 117.86, 0.25: 117.86}
"""The same where all of the arc slides; Coulomb's friction keeps it beyond."""


def test_traction_against_an_independent_code(measured: Callable[..., None]) -> None:
    """Torques to a part in a thousand, also where a whole arc slides; the driver is about to slide there, too."""
    drive = better(loaded_two_pulley(1e4))
    drive = drive.replace(contact=drive.contact.replace(friction=0.3))
    expected = INDEPENDENT | GROSS
    slips = ", ".join(f"{100.0 * slip:g}" for slip in expected)
    found = traction(drive, slip=f"{slips} %", force_tolerance=1e-3).dataset
    error = float(np.max(np.abs(found.torque.values / np.array(list(expected.values())) - 1.0)))
    measured(torque=error)
    assert error < 1e-3
