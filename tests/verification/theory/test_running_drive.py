"""Verified: forces and tension along the arcs of the loaded drive (Eq. 29, 120 rad/s) at 1 s, point by point.

Against: the boundary-value problem of steady running on penalty contact, and the exponentials of a rigid pulley.
"""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
import xarray as xr

from beltdyn import simulate
from beltdyn.arrays import FloatArray, IntArray
from beltdyn.model import Drive
from beltdyn.theory.creep import creep_speed_loss, friction_along_arc, layer_length
from beltdyn.theory.running_drive import RunningBelt, RunningDrive, run_steadily

Around = Callable[[FloatArray, tuple[float, float]], FloatArray]
SPEED, LOAD = 120.0, 45.0
MESHES = [30, 60, 120]

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module", params=[1e4, 1e5], ids=["1e4", "1e5"])
def factor(request: pytest.FixtureRequest) -> float:
    return float(request.param)


@pytest.fixture(scope="module")
def numbers(loaded: Callable[..., Drive], running: Callable[..., RunningDrive], factor: float) -> RunningDrive:
    return running(loaded(30, factor), SPEED, LOAD)


@pytest.fixture(scope="module")
def theory(numbers: RunningDrive) -> RunningBelt:
    return run_steadily(numbers)


@pytest.fixture(scope="module")
def outputs(loaded: Callable[..., Drive], factor: float) -> dict[int, xr.Dataset]:
    """The drive at 1 s; velocities err by rtol of the rim's, and friction by nu_s times that."""
    return {n: simulate(loaded(n, factor, rtol=1e-4)).fields_at() for n in MESHES}


def angles(numbers: RunningDrive, theory: RunningBelt, pulley: int, around: Around) -> tuple[IntArray, FloatArray]:
    """Points of the theory that touch a pulley, in the order of their angle, and the angles, rad."""
    center = np.array([pulley * numbers.distance, 0.0])
    side = (2 * pulley - 1.0, 0.0)
    touching = np.flatnonzero(theory.normal_force[pulley] > 0.0)
    angle = around(theory.position[:, touching].T - center + np.array(side), side)
    rank = np.argsort(angle)
    return touching[rank], angle[rank]


def mean_tension(numbers: RunningDrive, theory: RunningBelt, output: xr.Dataset) -> FloatArray:
    """Tension of the theory, averaged over each element of an output where it stands."""
    places = output.node_position.values + np.array([0.5 * numbers.distance, 0.0])
    nearest = [int(np.argmin(np.hypot(*(theory.position - place[:, None])))) for place in places]
    first, points = nearest[0], theory.tension.size - 1
    ends = [(index - first) % points for index in nearest] + [points]
    once = np.roll(theory.tension[:-1], -first)
    return np.array([once[i:j].mean() for i, j in pairwise(ends)])


@pytest.mark.parametrize("pulley", [0, 1], ids=["driver", "driven"])
def test_forces_along_the_arc(
    numbers: RunningDrive,
    theory: RunningBelt,
    outputs: dict[int, xr.Dataset],
    around: Around,
    on_pulley: Callable[[xr.Dataset, int], xr.Dataset],
    measured: Callable[..., None],
    curve: Callable[..., None],
    pulley: int,
) -> None:
    """Root mean square of the difference over the largest force: the mesh, whose nodes pass the ends of contact.

    At 30 elements a node passes every 42 mm through ends of 13 mm; friction is nu_s times a small difference of speeds.
    """
    points, angle = angles(numbers, theory, pulley, around)
    name = f"{('driver', 'driven')[pulley]}_{numbers.creep_rate_factor:.0e}"
    fields = {"normal_force": theory.normal_force, "friction_force": theory.friction_force}
    errors: dict[str, list[float]] = {field: [] for field in fields}
    for elements, output in outputs.items():
        here = on_pulley(output, pulley)
        center = (pulley - 0.5) * numbers.distance, 0.0
        at = around(here.contact_position.values, center)
        for field, values in fields.items():
            expected = np.interp(at, angle, values[pulley, points])
            error = here[field].values - expected
            errors[field].append(float(np.sqrt(np.mean(error**2)) / np.abs(values[pulley]).max()))
            if elements in MESHES[:2]:
                curve(f"running_drive/{field}_{name}", np.degrees(at), here[field], f"{elements} elements", ".")
    for field, values in fields.items():
        curve(f"running_drive/{field}_{name}", np.degrees(angle), values[pulley, points], "theory", "k-")
        label = f"{field.replace('_', ' ')}, {('driver', 'driven pulley')[pulley]}"
        curve(f"running_drive_error/{numbers.creep_rate_factor:.0e}", MESHES, errors[field], label)
        measured(**{f"{field}_{n}": error for n, error in zip(MESHES, errors[field], strict=True)})
    normal, friction = errors["normal_force"], errors["friction_force"]
    assert normal[0] < 0.02
    assert max(normal[1:]) < 0.002
    assert friction[0] < 0.1
    assert max(friction[1:]) < 0.015


def test_tension_and_speed(
    numbers: RunningDrive,
    theory: RunningBelt,
    outputs: dict[int, xr.Dataset],
    measured: Callable[..., None],
    curve: Callable[..., None],
) -> None:
    speeds, tensions = [], []
    for output in outputs.values():
        expected = mean_tension(numbers, theory, output)
        difference = output.belt_tension.values - expected
        tensions.append(float(np.sqrt(np.mean(difference**2)) / np.ptp(theory.tension)))
        speeds.append(abs(float(output.pulley_speed[1]) / theory.driven_speed - 1.0))
    curve(f"running_drive_error/{numbers.creep_rate_factor:.0e}", MESHES, tensions, "tension")
    curve(f"running_drive_error/{numbers.creep_rate_factor:.0e}", MESHES, speeds, "driven speed")
    measured(**{f"tension_{n}": error for n, error in zip(MESHES, tensions, strict=True)}, driven=theory.driven_speed)
    measured(**{f"speed_{n}": error for n, error in zip(MESHES, speeds, strict=True)})
    assert tensions[0] < 0.1
    assert max(tensions[1:]) < 0.01
    assert speeds[0] < 1e-4
    assert speeds[-1] < 1e-5


def test_rigid_pulley_in_closed_form(
    numbers: RunningDrive,
    theory: RunningBelt,
    around: Around,
    measured: Callable[..., None],
    curve: Callable[..., None],
) -> None:
    """The exponential of a rigid pulley, over an arc longer at each end by a layer, lambda^2 = d (R - d).

    The drag of the ends of contact, where the belt runs on and off at an angle, is not in it: it lowers the loss.
    """
    slack, tight = theory.tension.min(), theory.tension.max()
    mean = float(numbers.law.stretch(0.5 * (slack + tight)))
    layer = layer_length(numbers.creep_rate_factor, theory.transport_speed, numbers.law, mass=numbers.mass, at=mean)
    points, angle = angles(numbers, theory, 0, around)
    depth = numbers.radii[0] - float(np.hypot(*theory.position[:, points]).min())
    inner = numbers.radii[0] - depth
    arc = (np.pi * inner + 2.0 * np.sqrt(depth * inner)) / mean
    contact = float(np.mean(theory.normal_force[0] > 0.0)) * numbers.length
    x = arc * (angle - angle.min()) / np.ptp(angle)
    rigid = friction_along_arc(x, tight, slack, arc, layer)
    middle = np.abs(angle) < np.pi / 4
    growth = np.polyfit(theory.coordinate[points[middle]], np.log(theory.friction_force[0, points[middle]]), 1)[0]
    loss, found = creep_speed_loss(tight, slack, numbers.law, arc, layer), 1.0 - theory.driven_speed / SPEED
    measured(
        layer=layer, arc=arc, contact=contact, fitted_layer=1.0 / growth, loss=loss, found=found, ratio=loss / found
    )
    panel = f"running_drive/friction_force_driver_{numbers.creep_rate_factor:.0e}"
    curve(panel, np.degrees(angle), rigid, "rigid pulley", "--")
    assert arc == pytest.approx(contact, rel=0.01)
    assert loss == pytest.approx(found, rel=0.1)
    assert 1.0 / growth == pytest.approx(layer, rel=0.1)
