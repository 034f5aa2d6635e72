"""Turning, shifting, mirroring and renumbering a drive changes its results in the same way, and nothing else.

The nodes of the small drive fall on nodes when it is mirrored or renumbered, so that the discrete systems are the same
too, and equal steps of 50 µs leave no choices that rounding could turn.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray

from beltdyn import simulate
from beltdyn.model import Drive

Change = Callable[..., Drive]
Pulleys = list[dict[str, Any]]
Measured = Callable[..., None]
TURN = np.array([[0.6, -0.8], [0.8, 0.6]])
SHIFT = np.array([0.7, -0.3])
SCALARS = ("kinetic_energy", "strain_energy", "penalty_energy", "driver_work", "friction_loss")
PULLEYS = ("pulley_speed", "pulley_torque", "shaft_torque", "wrap_angle")
ROUNDING = 1e-9
"""Relative to the largest value: rounding, as contact and friction amplify it over six hundred steps."""


@pytest.fixture(scope="module")
def reference(paced: Drive) -> xr.Dataset:
    return simulate(paced).dataset


@pytest.fixture(scope="module")
def paced(small: Drive, change: Change) -> Drive:
    return change(small, simulation={"max_step": 5e-5, "rtol": 1e-2})


@pytest.fixture(scope="module")
def pulleys(small: Drive) -> Pulleys:
    return [pulley.model_dump(exclude_none=True) for pulley in small.pulleys]


def turned(pulleys: Pulleys) -> Pulleys:
    return [pulley | {"center": tuple(TURN @ pulley["center"] + SHIFT)} for pulley in pulleys]


def mirrored(pulleys: Pulleys) -> Pulleys:
    """About the x axis: the drive runs clockwise."""
    driver, driven = pulleys
    speed, torque = driver["speed"], driven["torque"]
    back = {"speed": speed | {"value": -speed["value"]}}, {"torque": torque | {"value": -torque["value"]}}
    return [driver | back[0], driven | back[1]]


def renumbered(pulleys: Pulleys) -> Pulleys:
    return pulleys[::-1]


def keep(values: NDArray[Any]) -> NDArray[Any]:
    return values


def swap(values: NDArray[Any]) -> NDArray[Any]:
    return values[:, ::-1]


CASES: dict[str, Any] = {
    # how the pulleys change, how hub forces do, how the order of the pulleys does, the sign of speeds and torques
    "turned and shifted": (turned, TURN, keep, 1.0),
    "mirrored": (mirrored, np.diag([1.0, -1.0]), keep, -1.0),
    "renumbered": (renumbered, np.eye(2), swap, 1.0),
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("contact", [{}, {"integration": "fixed"}], ids=["zone", "fixed"])
def test_results_follow(
    paced: Drive, pulleys: Pulleys, change: Change, measured: Measured, case: str, contact: dict[str, str]
) -> None:
    alter, frame, order, sign = CASES[case]
    reference = simulate(change(paced, contact=contact)).dataset
    run = simulate(change(paced, pulley=alter(pulleys), contact=contact)).dataset
    differences = {name: difference(run[name].values, reference[name].values) for name in SCALARS}
    for name in PULLEYS:
        factor = 1.0 if name == "wrap_angle" else sign
        differences[name] = difference(order(run[name].values), factor * reference[name].values)
    differences["hub_force"] = difference(order(run.hub_force.values), reference.hub_force.values @ frame.T)
    measured(worst=max(differences.values()))
    assert max(differences.values()) < ROUNDING, differences


def difference(values: NDArray[Any], expected: NDArray[Any]) -> float:
    return float(np.max(np.abs(values - expected)) / np.max(np.abs(expected)))


def test_nodes_follow_a_turn(paced: Drive, pulleys: Pulleys, change: Change, reference: xr.Dataset) -> None:
    run = simulate(change(paced, pulley=turned(pulleys))).dataset
    expected = reference.node_position.values @ TURN.T + SHIFT
    np.testing.assert_allclose(run.node_position, expected, atol=ROUNDING * paced.belt_length)
