"""Where springs hold tensioners: virtual work and least energy."""

from collections.abc import Callable
from math import cos, sin
from typing import Any

import numpy as np
import pytest

from beltdyn.model import Drive, dumps, install, loads

MakeDrive = Callable[..., Drive]
SLIDING = {"kind": "sliding", "pulley": "idler", "direction": (0, 1), "mass": 0.5, "preload": 300.0, "rate": 2e3}
ROTARY = {
    "kind": "rotary",
    "pulley": "tensioner",
    "pivot": (-0.17, 0.17),
    "inertia": 0.01,
    "preload": 30.0,
    "rate": 20.0,
}
TENSIONERS = pytest.mark.parametrize(
    ("layout", "length", "tensioner"), [("flat", 2.6, SLIDING), ("serpentine", 1.84, ROTARY)]
)


@TENSIONERS
def test_force_of_the_spring_is_tension_times_the_change_of_length(
    make_drive: MakeDrive, layout: str, length: float, tensioner: dict[str, Any]
) -> None:
    """Virtual work, with dL/dq by central differences of the path laid anew."""
    drive = make_drive(layout, length=length, tensioner=[tensioner])
    installation = install(drive)
    (q,) = installation.tensioner_positions
    step = 1e-5
    longer, shorter = (path_length(drive, q + turn) for turn in (step, -step))
    spring = tensioner["preload"] - tensioner["rate"] * q
    assert installation.tension * (longer - shorter) / (2 * step) == pytest.approx(spring, rel=1e-7)
    assert installation.path.length == pytest.approx(path_length(drive, q), rel=1e-14)
    assert loads(dumps(drive)) == drive


@TENSIONERS
def test_energy_of_belt_and_spring_is_least(
    make_drive: MakeDrive, layout: str, length: float, tensioner: dict[str, Any]
) -> None:
    """On hard pulleys, E A (g^2 - 1)^2 L / 8 - (preload - rate q / 2) q is least where the tensioner stands."""
    drive = make_drive(layout, length=length, tensioner=[tensioner], contact={"stiffness": 1e15})
    (q,) = install(drive).tensioner_positions

    def energy(at: float) -> float:
        stretch = path_length(drive, at) / drive.belt_length
        belt = drive.belt.axial_stiffness * (stretch**2 - 1) ** 2 * drive.belt_length / 8
        return float(belt - (tensioner["preload"] - tensioner["rate"] * at / 2) * at)

    around = [energy(q + step) for step in (-1e-4, -1e-5, 0.0, 1e-5, 1e-4)]
    assert np.argmin(around) == 2
    slope, curvature = (around[4] - around[0]) / 2e-4, (around[4] - 2 * around[2] + around[0]) / 1e-8
    assert abs(slope / curvature) < 1e-6


@TENSIONERS
def test_tension_and_tensioner_give_the_length(
    make_drive: MakeDrive, layout: str, length: float, tensioner: dict[str, Any]
) -> None:
    drive = make_drive(layout, installed_tension=320.0, tensioner=[tensioner])
    installation = install(drive)
    assert installation.tension == pytest.approx(320.0, rel=1e-9)
    again = make_drive(layout, length=drive.belt_length, tensioner=[tensioner])
    np.testing.assert_allclose(install(again).tensioner_positions, installation.tensioner_positions, rtol=1e-9)


@pytest.mark.parametrize(("preload", "stop"), [(10.0, -0.05), (300.0, 0.05)])
def test_stops_hold_the_arm(make_drive: MakeDrive, preload: float, stop: float) -> None:
    """Beyond its stop the arm is where belt, spring and the spring of the stop are in balance."""
    held = ROTARY | {"preload": preload, "stops": (-0.05, 0.05), "stop_stiffness": 1e6}
    drive = make_drive("serpentine", length=1.84, tensioner=[held])
    installation = install(drive)
    (q,) = installation.tensioner_positions
    assert q == pytest.approx(stop, abs=5e-4)
    assert abs(q) > abs(stop)
    slope = (path_length(drive, q + 1e-5) - path_length(drive, q - 1e-5)) / 2e-5
    moment = preload - 20.0 * q + 1e6 * (stop - q)
    assert installation.tension * slope == pytest.approx(moment, rel=1e-6)


@pytest.mark.slow
def test_two_tensioners(make_drive: MakeDrive) -> None:
    second = {"kind": "sliding", "pulley": "idler", "direction": (-1, 0), "mass": 0.5, "preload": 500.0, "rate": 1e4}
    drive = make_drive("serpentine", length=1.84, tensioner=[ROTARY, second])
    installation = install(drive)
    angle, shift = installation.tensioner_positions
    path = installation.path
    gradient = path.span_directions[2] - path.span_directions[3]
    assert installation.tension * (gradient @ [-1, 0]) == pytest.approx(500.0 - 1e4 * shift, rel=1e-8)
    arm = path.centers[6] - [-0.17, 0.17]
    gradient = path.span_directions[5] - path.span_directions[6]
    sense = np.sign(angle) * np.sign(arm[0])
    turned = np.array([-arm[1], arm[0]]) * np.sign(gradient @ [-arm[1], arm[0]])
    assert sense != 0
    assert installation.tension * (gradient @ turned) == pytest.approx(30.0 - 20.0 * angle, rel=1e-8)


def path_length(drive: Drive, q: float) -> float:
    """Length of the path with the first tensioner at a position, its pulley moved by hand."""
    tensioner = drive.model_dump(by_alias=True)["tensioner"][0]
    number = [pulley.name for pulley in drive.pulleys].index(tensioner["pulley"])
    center = np.array(drive.pulleys[number].center)
    if tensioner["kind"] == "sliding":
        center = center + q * np.array(tensioner["direction"])
    else:
        pivot = np.array(tensioner["pivot"])
        turn = np.array([[cos(q), sin(q)], [-sin(q), cos(q)]])  # clockwise lengthens the path of the serpentine
        center = pivot + turn @ (center - pivot)
    path = drive.path
    centers = path.centers.copy()
    centers[number] = center
    return type(path)(centers, path.radii).length
