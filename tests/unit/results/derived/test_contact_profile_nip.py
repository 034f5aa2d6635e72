"""A nip with a parabolic pressure, and a run that holds it: sums by hand, and what turning it around changes."""

from collections.abc import Callable

import numpy as np
import pytest
import xarray as xr

from beltdyn.errors import ModelError
from beltdyn.model import prepare
from beltdyn.results import Run
from beltdyn.results.derived import nip_profile, nips
from tests.unit.model.test_nip import pressed

HALF, PEAK, FRICTION, DEPTH = 8e-3, 3e5, 0.4, 0.4e-3
"""Half of the width, m; line force on the line of centers, N/m; shear over pressure on both faces; overlap, m."""
DRUM, PRESS = 0, 2
MakeNip = Callable[..., Run]


@pytest.fixture
def make_nip() -> MakeNip:
    return made


def made(
    sense: float = 1.0, at: int = 0, friction: float | None = None, speed: float | None = None, middle: int = 2000
) -> Run:
    """The belt runs over the drum with its coordinate (or against it); the press is on the left, its belt runs down.

    The pressure is centered some contact points behind the line of centers.
    The shear on the roller pushes the belt on, with 0.1 of the pressure; that on the drum pulls it back, with 0.3.
    """
    drive = pressed()
    if friction is not None:
        drive = drive.replace(contact=drive.contact.replace(friction=friction))
    prepared = prepare(drive)
    coordinates = np.linspace(0.0, prepared.belt_length, 4001)[:-1]
    half = 0.5 * prepared.belt_length
    along, place = (
        (coordinates - coordinates[point] + half) % prepared.belt_length - half for point in (middle + at, middle)
    )
    pressure = np.where(np.abs(along) < HALF, PEAK * (1.0 - (along / HALF) ** 2), 0.0)
    radii, centers = prepared.radii, prepared.path.centers.copy()
    apart = radii[DRUM] + radii[PRESS] - DEPTH
    centers[PRESS] = centers[DRUM] - [apart, 0.0]
    turning = np.array([pulley.turning for pulley in prepared.pulleys])
    rims = sense * np.array([2.0, 2.0, 1.98]) if speed is None else np.full(3, speed)
    angle = np.pi + turning[DRUM] * place / radii[DRUM]
    places = centers[DRUM] + radii[DRUM] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    onward = sense * pressure
    fields = {
        "normal_force": pressure,
        "friction_force": -0.3 * turning[DRUM] * onward,
        "slip_velocity": sense * 0.01 * np.ones_like(pressure),
        "nip_normal_force": pressure[None],
        "nip_friction_force": 0.1 * turning[PRESS] * onward[None],
        "nip_slip_velocity": sense * 0.02 * np.ones_like(pressure[None]),
    }
    hub = np.zeros((3, 2))
    hub[PRESS] = [-4.0 / 3.0 * HALF * PEAK, 50.0]
    outputs = {
        "pulley_center": (("pulley", "axis"), centers),
        "pulley_speed": (("pulley",), rims / (prepared.rolling_radii * turning)),
        "hub_force": (("pulley", "axis"), hub),
        "shaft_torque": (("pulley",), np.array([5.0, -3.0, 0.5])),
        "contact_damping_power": (("pulley",), np.array([7.0, 100.0, 11.0])),
        "nip_width": (("nip",), np.array([2.0 * HALF])),
        "nip_tension_before": (("nip",), np.array([1200.0])),
        "nip_tension_after": (("nip",), np.array([900.0])),
    }
    data = {name: (("time", *dims), values[None]) for name, (dims, values) in outputs.items()}
    for name, values in fields.items():
        dims = ("field_time", *["nip"] * (values.ndim - 1), "contact_point")
        data[name] = (dims, values[None])
    data["contact_position"] = (("field_time", "contact_point", "axis"), places[None])
    points = {
        "time": [1.0],
        "field_time": [1.0],
        "filtered_time": [1.0],
        "belt_coordinate": ("contact_point", coordinates),
    }
    dataset = xr.Dataset(data, points).assign(unused=("filtered_time", [0.0]))
    return Run(dataset, drive)


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_sums_over_a_nip(make_nip: MakeNip, sense: float) -> None:
    """Integrals of the parabola, whichever way the belt runs."""
    run = make_nip(sense)
    nip, prepared = nips(run).isel(nip=0), run.prepared
    load, width = 4.0 / 3.0 * HALF * PEAK, prepared.belt.width
    assert nip.nip.item() == "press"
    assert float(nip.force) == pytest.approx(load)
    assert float(nip.width) == 2.0 * HALF
    assert float(nip.peak_pressure) == pytest.approx(PEAK / width)
    assert nip.pull.values == pytest.approx([0.1 * load, -0.3 * load], rel=1e-2)
    assert nip.grip_limit.values == pytest.approx([FRICTION * load] * 2, rel=1e-2)
    assert nip.grip.values == pytest.approx([0.1 / FRICTION, 0.3 / FRICTION], rel=1e-9)
    assert float(nip.indentation) == pytest.approx(DEPTH, rel=1e-9)
    assert float(nip.gap) == pytest.approx(prepared.belt.thickness - DEPTH, rel=1e-9)
    thinner = 2.0 * PEAK / prepared.contact_stiffness
    assert float(nip.thickness) == pytest.approx(prepared.belt.thickness - thinner, rel=1e-9)
    assert float(nip.thickness_after) == prepared.belt.thickness
    assert float(nip.compression_loss) == 18.0
    assert nip.torque.values.tolist() == [0.5, 5.0]
    assert [float(nip.tension_before), float(nip.tension_after)] == [1200.0, 900.0]
    assert float(nip.speed_ratio) == pytest.approx(0.99)


def test_a_lasting_part_of_the_compression_thins_the_belt_behind_the_nip() -> None:
    run = made()
    drive = run.drive.replace(belt=run.drive.belt.replace(compression_set=0.2))
    nip = nips(Run(run.dataset, drive)).isel(nip=0)
    thickness = drive.belt.thickness
    assert thickness - float(nip.thickness_after) == pytest.approx(0.2 * (thickness - float(nip.thickness)), rel=1e-9)


def test_without_friction_there_is_no_grip(make_nip: MakeNip) -> None:
    nip = nips(make_nip(friction=0.0)).isel(nip=0)
    assert not nip.grip_limit.any()
    assert np.isnan(nip.grip).all()


def test_at_rest_forward_is_along_the_belt_coordinate(make_nip: MakeNip) -> None:
    still, running = (nips(make_nip(speed=speed)).isel(nip=0) for speed in (0.0, None))
    assert np.isnan(still.speed_ratio)
    np.testing.assert_array_equal(still.pull, running.pull)
    xr.testing.assert_equal(nip_profile(make_nip(speed=0.0), "press"), nip_profile(make_nip(), "press"))


@pytest.mark.parametrize("center", [2000, 0], ids=["within", "across the start of the belt"])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_profile_runs_with_the_belt(make_nip: MakeNip, sense: float, center: int) -> None:
    """From the entry to the exit; shear is positive where it pushes the belt on."""
    run = make_nip(sense, at=2, middle=center)
    profile, width = nip_profile(run, "press"), run.prepared.belt.width
    distance = profile.distance.values
    assert profile.face.values.tolist() == ["press", "drum"]
    assert np.all(np.diff(distance) > 0.0)
    middle = sense * 2.0 * run.prepared.belt_length / 4000
    assert distance.mean() == pytest.approx(middle, rel=1e-2)
    expected = PEAK / width * (1.0 - ((distance - middle) / HALF) ** 2)
    np.testing.assert_allclose(profile.pressure, [expected, expected], atol=2e-3 * PEAK / width)
    np.testing.assert_allclose(profile.shear, profile.pressure * np.array([[0.1], [-0.3]]), rtol=1e-9)
    turning = np.array([[pulley.turning] for pulley in run.prepared.pulleys])[[PRESS, DRUM]]
    np.testing.assert_allclose(profile.slip_velocity, turning * np.array([[0.02], [0.01]]) + 0.0 * expected, rtol=1e-9)


def test_only_the_roller_beside_the_path_has_a_profile(make_nip: MakeNip) -> None:
    with pytest.raises(ModelError, match=r'"drum" is not the roller of a nip. Choose one of press\.'):
        nip_profile(make_nip(), "drum")
