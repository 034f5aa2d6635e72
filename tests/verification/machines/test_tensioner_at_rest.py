"""Drives with a tensioner in static equilibrium: virtual work, hub load, stops and weight.

The spring is computed by hand from the place at which the solver leaves the tensioner.  The spans lie on lines at the
distance R - d / 2 + E I / (2 R T) from the centers, d the depth to which the belt sinks in at the solver's tension T:
it comes up to the rim with the slope d / lambda, lambda^2 = d R, and its bending moment goes over into an offset of
the tension.  This leaves out the square of d / R, here up to 3e-4, with a factor of order one, and the mesh.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, Path, RotaryTensioner, SlidingTensioner
from beltdyn.state.equilibrium import equilibrium

Make = Callable[..., Drive]
Measured = Callable[..., None]

CRANK = {"name": "crank", "center": (0.0, 0.0), "radius": 0.08, "speed": {"kind": "constant", "value": 0.0}}
DRIVEN = {"name": "driven", "center": (0.3, 0.02), "radius": 0.06, "inertia": 1e-3}
BELOW = {"name": "idler", "center": (0.15, -0.12), "radius": 0.04, "inertia": 1e-4, "mass": 1.5}
ABOVE = BELOW | {"center": (0.15, 0.05), "side": "outside"}
LAYOUTS: dict[str, tuple[list[dict[str, Any]], tuple[float, float], tuple[float, float]]] = {
    # pulleys, direction of the slide, pivot of the arm
    "inside": ([CRANK, BELOW, DRIVEN], (0.2, -1.0), (0.24, -0.15)),
    "outside": ([CRANK, DRIVEN, ABOVE], (0.1, -1.0), (0.08, 0.19)),
}
BELT = {"elements": 300, "bending_factor": 1e-3}
LENGTHS = {"inside": 1.094, "outside": 1.076}
VIRTUAL_WORK = 5e-4


def sliding(layout: str, **keys: Any) -> dict[str, Any]:
    direction = LAYOUTS[layout][1]
    return {"kind": "sliding", "pulley": "idler", "direction": direction, "preload": 400.0, "mass": 0.5} | keys


def rotary(layout: str, **keys: Any) -> dict[str, Any]:
    pivot = LAYOUTS[layout][2]
    arm = {"kind": "rotary", "pulley": "idler", "pivot": pivot, "preload": 40.0, "inertia": 1e-3, "mass": 2.0}
    return arm | {"center_of_mass": 0.4} | keys


def center(drive: Drive, q: float) -> FloatArray:
    """Where the pulley of the tensioner stands: on its line, or on the circle about its pivot."""
    given = drive.tensioners[0]
    nominal = np.array(drive.pulleys[drive.carried(given)].center)
    if isinstance(given, SlidingTensioner):
        return np.asarray(nominal + q * np.array(given.direction))
    assert isinstance(given, RotaryTensioner)
    pivot = np.array(given.pivot)
    x, y = nominal - pivot

    def turned(angle: float) -> FloatArray:
        sine, cosine = np.sin(angle), np.cos(angle)
        return np.asarray(pivot + np.array([x * cosine - y * sine, x * sine + y * cosine]))

    longer = path(drive, turned(1e-6), 100.0).length > path(drive, turned(-1e-6), 100.0).length
    return turned(q if longer else -q)


def lever(drive: Drive, q: float) -> FloatArray:
    """Derivative of the place of the pulley with respect to q, by differences over 1e-5 m or rad."""
    return (center(drive, q + 1e-5) - center(drive, q - 1e-5)) / 2e-5


def path(drive: Drive, place: FloatArray, tension: float) -> Path:
    """Path that the spans take under a tension, with the tensioner's pulley at a place."""
    centers, radii = drive.centers.copy(), np.abs(drive.radii)
    centers[drive.carried(drive.tensioners[0])] = place
    depth = tension / (drive.contact_stiffness * radii)
    offset = drive.belt.bending_stiffness / (2 * radii * tension)
    signs = [1.0 if pulley.side == "inside" else -1.0 for pulley in drive.pulleys]
    return Path(centers, np.array(signs) * (radii - 0.5 * depth + offset))


def lengthening(drive: Drive, q: float, tension: float) -> float:
    """Derivative of the length of the path, by differences over 1e-5 m or rad."""
    ahead, behind = (path(drive, center(drive, q + step), tension).length for step in (1e-5, -1e-5))
    return (ahead - behind) / 2e-5


def rest(drive: Drive) -> tuple[xr.Dataset, float, float]:
    """The output of the equilibrium, the place of the tensioner, and the tension beside its pulley."""
    output = equilibrium(drive).fields_at()
    carried = drive.carried(drive.tensioners[0])
    beside = output.span_tension.values[[carried - 1, carried]]
    return output, float(output.tensioner_position[0]), float(beside.mean())


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize(
    ("tensioner", "keys"),
    [
        (sliding, {}),
        (sliding, {"preload": 200.0, "rate": 5e4}),
        (rotary, {}),
        (rotary, {"preload": 70.0}),
        (rotary, {"preload": 30.0, "rate": 500.0}),
    ],
    ids=["sliding", "sliding spring", "rotary", "rotary strong", "rotary spring"],
)
def test_virtual_work(
    make: Make, measured: Measured, layout: str, tensioner: Callable[..., Any], keys: dict[str, float]
) -> None:
    """M = T dL/dphi, and M + F . dc/dphi = 0 with the force F of the belt, to which the search for equilibrium ends."""
    drive = make(LAYOUTS[layout][0], tensioner=[tensioner(layout, **keys)], belt=BELT | {"length": LENGTHS[layout]})
    output, q, tension = rest(drive)
    given: Any = drive.tensioners[0]
    spring = given.preload - given.rate * q
    work = tension * lengthening(drive, q, tension)
    hub = -output.hub_force.values[drive.carried(given)] @ lever(drive, q)
    measured(q=q, tension=tension, spring=spring, virtual_work=work / spring - 1, hub=hub / spring - 1)
    assert hub == pytest.approx(spring, rel=1e-8)
    assert work == pytest.approx(spring, rel=VIRTUAL_WORK)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_hub_load(make: Make, measured: Measured, span_lines: Callable[..., Any], layout: str) -> None:
    """The square root of T1^2 + T2^2 - 2 T1 T2 cos theta, theta the angle from span to span as the nodes have it."""
    drive = make(LAYOUTS[layout][0], tensioner=[rotary(layout)], belt=BELT | {"length": LENGTHS[layout]})
    output, _, _ = rest(drive)
    lines, tension = span_lines(output), output.span_tension.values
    errors = []
    for pulley in range(3):
        before, after = lines[pulley - 1], lines[pulley]
        theta = np.arccos(before @ after)
        t1, t2 = tension[pulley - 1], tension[pulley]
        hand = np.sqrt(t1**2 + t2**2 - 2 * t1 * t2 * np.cos(theta))
        errors.append(float(np.linalg.norm(output.hub_force.values[pulley]) / hand - 1))
    measured(**dict(zip(output.pulley.values, errors, strict=True)))
    np.testing.assert_allclose(errors, 0.0, atol=1e-4)


@pytest.mark.parametrize(("stops", "upper"), [((-0.02, 5e-3), True), ((-5e-4, 0.02), False)], ids=["upper", "lower"])
def test_stops(make: Make, measured: Measured, stops: tuple[float, float], upper: bool) -> None:
    """A stop carries what the belt does not, k_s times its depth; the belt has what its length asks for there."""
    keys: dict[str, Any] = {"preload": 1200.0 if upper else 20.0, "stops": stops, "stop_stiffness": 1e6}
    drive = make(LAYOUTS["inside"][0], tensioner=[sliding("inside", **keys)], belt=BELT | {"length": LENGTHS["inside"]})
    _, q, tension = rest(drive)
    stop = 1e6 * (stops[1] - q if upper else stops[0] - q)
    work = tension * lengthening(drive, q, tension)
    measured(q=q, tension=tension, stop=stop, error=work / (keys["preload"] + stop) - 1)
    assert (stop < -50.0) if upper else (stop > 50.0)
    assert work == pytest.approx(keys["preload"] + stop, rel=VIRTUAL_WORK)


@pytest.mark.parametrize("tensioner", [sliding, rotary])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_weight(make: Make, measured: Measured, layout: str, tensioner: Callable[..., Any]) -> None:
    """Weight of the arm at its own center of mass, of what slides, and of the pulley, by hand; the belt sags a little.

    A span of the weight w hangs by w / 2 T from its chord at both ends, 2e-4 here, which its hub load feels.
    """
    gravity = (8.0, -6.0)
    given = tensioner(layout)
    drive = make(LAYOUTS[layout][0], tensioner=[given], belt=BELT | {"length": LENGTHS[layout]}, gravity=gravity)
    _, q, tension = rest(drive)
    part = given.get("center_of_mass", 1.0)
    moved = 1.5 * lever(drive, q) + given["mass"] * part * lever(drive, q)
    weight = float(moved @ gravity)
    work = tension * lengthening(drive, q, tension)
    measured(q=q, tension=tension, weight=weight, spring=given["preload"], error=work / (given["preload"] + weight) - 1)
    assert abs(weight) > 0.01 * given["preload"]
    assert work == pytest.approx(given["preload"] + weight, rel=1e-3)
