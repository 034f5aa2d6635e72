"""Closed forms of a drive at rest against the computed equilibrium: all examples, and idlers of small wrap."""

from collections.abc import Callable

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.model import Drive, Installation, estimate_at_rest, prepare
from beltdyn.state.installation import bring_to_rest

WITHIN = 0.01
"""What `check` says of closed forms."""
QUICK = "alternator_drive", "two_pulley"
SLOW = tuple(
    pytest.param(name, marks=pytest.mark.slow)
    for name in (
        "accessory_drive",
        "band_brake",
        "conveyor",
        "crossed_belt",
        "fan_direct_start",
        "flat_belt_idler",
        "slip_through",
        "tensioner_stop",
        "unequal_radii",
        "washing_machine",
    )
)


def errors(hand: Installation, found: Installation) -> dict[str, float]:
    """Largest relative errors of tensions, hub loads and frequencies."""
    sizes = [np.linalg.norm(one.hub_loads, axis=1) for one in (hand, found)]
    pairs = {
        "tension": (hand.span_tensions, found.span_tensions),
        "hub_load": (sizes[0], sizes[1]),
        "frequency": (hand.span_frequencies, found.span_frequencies),
        "wrap": (hand.path.wrap_angles, found.path.wrap_angles),
    }
    return {name: float(np.max(np.abs(one / other - 1.0))) for name, (one, other) in pairs.items()}


@pytest.mark.parametrize("name", [*QUICK, *SLOW])
def test_examples(name: str, measured: Callable[..., None]) -> None:
    """The published mesh of 20 elements is 1.1 % off itself; all other examples agree within 0.1 %."""
    drive = bd.example(name)
    prepared, hand = estimate_at_rest(prepare(drive))
    rest = bring_to_rest(drive)
    found = errors(hand, rest.installation)
    measured(**found)
    assert max(found.values()) < (WITHIN if name == "two_pulley" else 1e-3)
    assert prepared.belt_length == pytest.approx(rest.drive.belt_length, rel=5e-5)


@pytest.mark.slow
@pytest.mark.parametrize("lift", [0.058, 0.046], ids=["wrap 17 degrees", "wrap 9 degrees"])
@pytest.mark.parametrize(("bending", "within"), [(0.005, 0.005), (0.1, 0.01)], ids=["flexible", "stiff"])
def test_idlers_of_small_wrap(lift: float, bending: float, within: float, measured: Callable[..., None]) -> None:
    """Hub loads, of which the path without bending misses up to a third where arcs are shorter than sqrt(EI / T).

    There the estimate promises 1 %: with 9 degrees it is 0.53 % off on any mesh, 0.34 % of it by the layers that meet.
    """
    drive = Drive(
        belt={
            "installed_tension": 400.0,
            "width": 0.02,
            "thickness": 0.005,
            "mass_per_length": 0.11,
            "axial_stiffness": 5e4,
            "bending_stiffness": bending,
            "elements": 240,
        },
        pulley=[
            {"name": "driver", "center": [0.0, 0.0], "radius": 0.06, "speed": 100.0},
            {"name": "driven", "center": [0.5, 0.0], "radius": 0.06, "inertia": 0.01},
            {"name": "idler", "center": [0.25, lift], "radius": 0.03, "inertia": 0.001},
        ],
        contact={"friction": 0.5},
        simulation={"duration": 0.1, "frame": "travelling"},
    )
    found = errors(estimate_at_rest(prepare(drive))[1], bring_to_rest(drive).installation)
    measured(**found)
    assert max(found.values()) < within
