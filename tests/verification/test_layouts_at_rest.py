"""Crossed belts, idlers on the back and serpentine drives in static equilibrium, against the estimates by hand.

The estimates leave out bending, and the ends of contact, where the belt rises to the rim.
"""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.model import Drive, install
from beltdyn.state.equilibrium import equilibrium

CROSSED = (("driver", 0.0, 0.0, 0.12, "inside"), ("driven", 0.6, 0.0, 0.08, "outside"))
FLAT = (
    ("motor", 0.0, 0.0, 0.1, "inside"),
    ("idler", 0.25, -0.05, 0.04, "outside"),
    ("fan", 0.8, 0.0, 0.2, "inside"),
)
SERPENTINE = (
    ("crank", 0.0, 0.0, 0.08, "inside"),
    ("air conditioning", 0.22, -0.06, 0.06, "inside"),
    ("alternator", 0.26, 0.16, 0.03, "inside"),
    ("idler", 0.11, 0.16, 0.035, "outside"),
    ("power steering", 0.08, 0.33, 0.06, "inside"),
    ("water pump", -0.03, 0.17, 0.05, "outside"),
    ("tensioner", -0.17, 0.07, 0.035, "inside"),
)
Circles = tuple[tuple[str, float, float, float, str], ...]
LAYOUTS = pytest.mark.parametrize("circles", [CROSSED, FLAT, SERPENTINE], ids=["crossed", "flat", "serpentine"])


def make(circles: Circles, turned: float = 0.0, shift: tuple[float, float] = (0.0, 0.0)) -> Drive:
    turn = np.array([[np.cos(turned), -np.sin(turned)], [np.sin(turned), np.cos(turned)]])
    return Drive(
        belt={
            "installed_tension": 400.0,
            "width": 0.02,
            "thickness": 0.005,
            "density": 1100.0,
            "poissons_ratio": 0.3,
            "youngs_modulus": 5e8,
            "bending_factor": 0.002,
            "elements": 240,
            "crossed": circles is CROSSED,
            "pitch_offset": 0.002,
            "back_offset": 0.003,
        },
        pulley=[
            {"name": name, "center": (turn @ (x, y) + shift).tolist(), "radius": radius, "side": side, "inertia": 0.01}
            for name, x, y, radius, side in circles
        ],
        contact={
            "allowed_penetration": 1e-4,
            "friction": 0.5,
            "creep_rate_factor": 1e4,
            "damping": 0.0,
            "friction_law": "force_slope",
            "moment_arm": "point",
        },
        simulation={"duration": 0.1, "output_interval": 1e-3},
    )


@LAYOUTS
def test_tension_and_hub_loads(circles: Circles, measured: Callable[..., None]) -> None:
    """The ends of contact add 5/12 d lambda / R each; bending, in the ends and on the arcs, is left out (0.05 %)."""
    drive = make(circles)
    belt = drive.belt.replace(length=drive.belt_length)  # the length by hand, not that for the tension
    hand, found = install(drive), equilibrium(drive.replace(belt=belt)).dataset
    rise = 5 / 12 * hand.penetrations * np.sqrt(hand.penetrations / drive.radii)
    expected = 400.0 * 2 * float(rise.sum()) / (hand.path.length - drive.belt_length)
    tension = found["span_tension"].values
    measured(tension=float(tension.mean()), spread=float(np.ptp(tension)), by_hand=400.0 + expected)
    assert tension.mean() == pytest.approx(400.0 + expected, rel=5e-4)
    np.testing.assert_allclose(tension, tension.mean(), rtol=2e-3)
    np.testing.assert_allclose(found["hub_force"].values, hand.hub_loads, atol=0.005 * 400.0)


@LAYOUTS
def test_turned_and_shifted(circles: Circles) -> None:
    """The search for equilibrium ends within 1e-6 of the forces."""
    turn, shift = 0.7, (3.0, -2.0)
    plain, moved = (equilibrium(drive).fields_at() for drive in (make(circles), make(circles, turn, shift)))
    np.testing.assert_allclose(moved["span_tension"], plain["span_tension"], rtol=1e-5)
    matrix = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    np.testing.assert_allclose(moved["hub_force"].values, plain["hub_force"].values @ matrix.T, atol=400.0 * 1e-4)
