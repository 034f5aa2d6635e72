from collections.abc import Callable
from math import cos, pi, sin
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, dumps, install, loads
from beltdyn.theory.stretch import tension as tension_of

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


@pytest.mark.parametrize("layout", ["open", "crossed", "flat", "serpentine"])
@pytest.mark.parametrize("contact", [{"stiffness": 1e7}, {"allowed_penetration": 1e-5}])
def test_length_for_a_tension(make_drive: MakeDrive, layout: str, contact: dict[str, float]) -> None:
    drive = make_drive(layout, contact=contact, installed_tension=350.0, pitch_offset=0.001, back_offset=0.002)
    assert drive.belt.installed_tension is None
    assert install(drive).tension == pytest.approx(350.0, rel=1e-11)
    assert loads(dumps(drive)) == drive


def test_allowed_penetration_is_that_on_the_smallest_pulley(make_drive: MakeDrive) -> None:
    drive = make_drive("serpentine", contact={"allowed_penetration": 2e-5}, length=1.84)
    assert drive.contact.allowed_penetration is None
    depths = install(drive).penetrations
    assert depths.max() == pytest.approx(2e-5, rel=1e-9)
    np.testing.assert_allclose(depths * drive.radii, 2e-5 * 0.03, rtol=1e-9)
    assert loads(dumps(drive)) == drive


def test_fixed_tensioner_moves_its_pulley(make_drive: MakeDrive) -> None:
    fixed = {"kind": "fixed", "pulley": "idler", "direction": (3, 4), "take_up": "10 mm"}
    drive = make_drive("flat", tensioner=[fixed])
    np.testing.assert_allclose(drive.centers[1], [0.256, -0.042], rtol=1e-14)
    assert drive.tensioners[0].model_dump()["take_up"] == 0.0
    assert loads(dumps(drive)) == drive


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("length", [2.56, 2.62])
def test_take_up_for_a_tension(make_drive: MakeDrive, length: float, sense: int) -> None:
    """The idler climbs for a long belt and sinks for a short one, on its line, however that is directed."""
    fixed = {"kind": "fixed", "pulley": "idler", "direction": (0, sense)}
    drive = make_drive("flat", tensioner=[fixed], length=length, installed_tension=500.0)
    assert drive.belt.length == length
    assert install(drive).tension == pytest.approx(500.0, rel=1e-9)
    assert drive.centers[1, 0] == 0.25
    assert (drive.centers[1, 1] > -0.05) == (length == 2.62)
    assert loads(dumps(drive)) == drive


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
        stretch = path_length(drive, at) / drive.belt.length
        belt = drive.belt.axial_stiffness * (stretch**2 - 1) ** 2 * drive.belt.length / 8
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
    again = make_drive(layout, length=drive.belt.length, tensioner=[tensioner])
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


def test_hub_loads(make_drive: MakeDrive) -> None:
    """sqrt(T1^2 + T2^2 - 2 T1 T2 cos(wrap)), and all of them are in balance."""
    installation = install(make_drive("serpentine", length=1.8))
    tension, wraps = installation.tension, installation.path.wrap_angles
    loads_of = np.linalg.norm(installation.hub_loads, axis=1)
    np.testing.assert_allclose(loads_of, tension * np.sqrt(2 - 2 * np.cos(wraps)), rtol=1e-12)
    np.testing.assert_allclose(installation.hub_loads.sum(axis=0), 0.0, atol=1e-10)
    pulled = install(make_drive("open"))
    assert pulled.hub_loads[0, 0] > 0 > pulled.hub_loads[1, 0]


def test_span_frequency_of_a_string_and_of_a_beam(make_drive: MakeDrive) -> None:
    string = make_drive("open", bending_factor=1e-12)
    installation = install(string)
    stretch = 1 + installation.strain
    mass = string.belt.mass_per_length / stretch
    length = installation.path.span_lengths[0]
    expected = np.sqrt(installation.tension / mass) / (2 * length)
    assert installation.span_frequencies[0] == pytest.approx(expected, rel=1e-9)
    beam = make_drive("open", installed_tension=1e-3, bending_factor=1.0)
    expected = pi / (2 * length**2) * np.sqrt(beam.belt.bending_stiffness / beam.belt.mass_per_length)
    assert install(beam).span_frequencies[0] == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("layout", "belt", "tensioner", "words"),
    [
        ("open", {"length": 1.8, "installed_tension": 400.0}, (), ("both given, with 0 fixed", 'kind = "fixed"')),
        ("open", {"installed_tension": 1e9}, (), ("installed_tension = 1e+09 N", "50%", "Lower it")),
        (
            "flat",
            {"length": 3.9, "installed_tension": 400.0},
            [{"kind": "fixed", "pulley": "idler", "direction": (0, 1)}],
            ('no take-up of "idler"', "3.9 m", "Change belt.length"),
        ),
        (
            "serpentine",
            {"length": 3.0},
            [ROTARY],
            ("length = 3 m is longer", "where its tensioners put them", "Shorten it, or raise the preload"),
        ),
        (
            "flat",
            {"length": 3.9},
            [SLIDING | {"rate": 0.0}],
            ("only where no belt can run", '"fan" to "motor"', "give stops"),
        ),
        ("flat", {"length": 2.5}, [SLIDING | {"preload": 1e-3, "rate": 0.0}], ("pushes the tensioner", "preload")),
        ("flat", {"length": 2.5}, [SLIDING | {"preload": -50.0, "rate": 0.0}], ("pushes the tensioner", "preload")),
        ("flat", {}, [SLIDING | {"pulley": "idle"}], ('pulley = "idle" is not the name', "motor, idler, fan")),
    ],
)
def test_what_cannot_come_to_rest(
    make_drive: MakeDrive, layout: str, belt: dict[str, float], tensioner: Any, words: tuple[str, ...]
) -> None:
    with pytest.raises(ModelError) as caught:
        make_drive(layout, tensioner=tensioner, **belt)
    for part in words:
        assert part in str(caught.value)


def test_penetration_that_takes_all_tension(make_drive: MakeDrive) -> None:
    with pytest.raises(ModelError, match="loses all tension by sinking"):
        make_drive("open", length=1.81, contact={"allowed_penetration": 5e-3})


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


def test_tension_law(make_drive: MakeDrive) -> None:
    """The belt of a given tension is as long as its path, shortened by the penetrations, at the stretch of its law."""
    drive = make_drive("flat", installed_tension=700.0, contact={"stiffness": 1e6})
    installation = install(drive)
    shortened = drive.path.length - drive.path.wrap_angles @ installation.penetrations
    assert tension_of(shortened / drive.belt.length, drive.belt.axial_stiffness) == pytest.approx(700.0, rel=1e-10)
