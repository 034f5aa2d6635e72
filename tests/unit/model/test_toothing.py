"""Teeth of belts and pulleys in a drive file: forms, errors, and what follows."""

from math import pi
from typing import Any

import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Toothing, read_catalogue

BELT = {"profile": "HTD 8M", "width": "20 mm", "teeth": 100}


def drive(belt: dict[str, Any] | None = None, **driver: Any) -> bd.Drive:
    first = {"name": "driver", "center": [0.0, 0.0], "teeth": 24, "speed": 100.0} | driver
    return bd.Drive(
        belt=BELT | (belt or {}),
        pulley=[first, {"name": "driven", "center": [0.28, 0.0], "teeth": 36, "inertia": 1e-3, "torque": -5.0}],
        simulation={"duration": 1.0},
    )


def test_a_belt_is_as_long_as_its_teeth() -> None:
    belt = bd.Belt(**BELT)
    assert belt.given_length * belt.measured_stretch == pytest.approx(0.8, rel=1e-12)
    assert belt.nominal_length_of(belt.given_length) == pytest.approx(0.8, rel=1e-12)
    unmeasured = belt.replace(measuring_force=0.0)
    assert unmeasured.length == pytest.approx(0.8, rel=1e-12)
    assert unmeasured.replace(teeth=110).length == pytest.approx(0.88, rel=1e-12)
    assert unmeasured.given_pitch == pytest.approx(8e-3, rel=1e-12)
    assert "length" not in belt.arguments


def test_teeth_of_a_profile_are_as_wide_as_the_belt() -> None:
    entry = read_catalogue()["HTD 8M"]
    assert entry.toothing is not None
    belt = bd.Belt(**BELT | {"toothing": {"backlash": "0.1 mm"}})
    assert belt.toothing is not None
    assert belt.toothing.tooth_stiffness == pytest.approx(2.0 * entry.toothing.tooth_stiffness)
    assert belt.toothing.largest_tooth_load == pytest.approx(2.0 * (entry.toothing.largest_tooth_load or 0.0))
    assert (belt.toothing.backlash, belt.toothing.pitch) == (1e-4, 8e-3)


def test_radii_follow_from_teeth() -> None:
    made = drive()
    assert made.radii.tolist() == pytest.approx([24 * 8e-3 / (2 * pi), 36 * 8e-3 / (2 * pi)], rel=1e-12)
    assert made.with_({"pulley[driver].teeth": 25}).radii[0] == pytest.approx(25 * 8e-3 / (2 * pi), rel=1e-12)
    assert drive(pitch_error=1e-3).radii[0] == pytest.approx(1.001 * made.radii[0], rel=1e-12)
    assert bd.loads(bd.dumps(made)) == made
    assert made.frictions.tolist() == [0.0, 0.0]  # lands do not rub unless they are told to


def test_a_smooth_pulley_on_the_inside_touches_the_tops_of_teeth() -> None:
    belt = bd.Belt(**BELT)
    assert belt.toothing is not None
    assert belt.toothing.tooth_height is not None
    assert belt.offset("inside", toothed=False) == pytest.approx(belt.pitch_offset + belt.toothing.tooth_height)
    assert belt.offset("outside", toothed=False) == belt.back_offset


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"teeth": 100.5}, "belt.teeth = 100.5 must be a whole number"),
        ({"teeth": 10**400}, "must be at most 10000"),
        ({"teeth": None}, "teeth is missing: the belt has teeth of a pitch of 8 mm"),
        ({"length": 0.85}, "length = 850 mm is 106.25 pitches of 8 mm, but teeth = 100"),
        ({"crossed": True}, "crossed = true is incompatible with teeth"),
        ({"nominal_length": 0.8}, "teeth and nominal_length exclude each other"),
        ({"toothing": {"pitch": "5 mm"}}, 'toothing.pitch = 5 mm, but profile "HTD 8M" has a pitch of 8 mm'),
        ({"toothing": {"backlash": "4 mm"}}, "backlash = 4 mm must be below half of the pitch of 8 mm"),
        ({"wedge_angle": 0.7}, "wedge_angle is incompatible with teeth"),
        ({"profile": "flat-aramid"}, "teeth = 100 needs the pitch and stiffness of the teeth. Give a toothed profile"),
    ],
)
def test_belts_that_do_not_fit_their_teeth(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(ModelError, match=message.replace("[", r"\[")):
        bd.Belt(**{key: value for key, value in (BELT | changes).items() if value is not None})


@pytest.mark.parametrize(
    ("driver", "message"),
    [
        ({"teeth": 24.5}, "teeth = 24.5 must be a whole number"),
        ({"teeth": 10**400}, "must be at most 10000"),
        ({"teeth": 24, "pitch_error": -1.0, "diameter": 0.06}, "pitch_error = -1.0 must be greater than -0.02"),
        ({"side": "outside"}, 'incompatible with side = "outside": the back of the belt has no teeth'),
        (
            {"diameter": "50 mm"},
            "24 teeth on an outside diameter of 50 mm, a pitch of .* but the belt has a pitch of 8 mm",
        ),
        ({"pitch_error": 0.1}, "pitch_error = 0.1 must be less than 0.02"),
        ({"surface": {"kind": "eccentric", "eccentricity": 1e-4}}, "is incompatible with teeth, whose grooves"),
    ],
)
def test_pulleys_that_do_not_fit_the_belt(driver: dict[str, Any], message: str) -> None:
    with pytest.raises(ModelError, match=message):
        drive(**driver)


def test_pulleys_with_teeth_need_a_belt_with_teeth() -> None:
    with pytest.raises(ModelError, match='"driver" has 24 teeth, but the belt has none'):
        bd.Drive(
            belt={"profile": "flat-aramid", "width": 0.02, "length": 0.8},
            pulley=[{"name": "driver", "center": [0, 0], "teeth": 24, "speed": 1.0}],
            simulation={"duration": 1.0},
        )


def test_sizes_of_teeth_are_checked() -> None:
    with pytest.raises(ModelError, match="tooth_stiffness"):
        Toothing(pitch=8e-3)  # type: ignore[call-arg]
    with pytest.raises(ModelError, match="land_radius = 1 mm needs discrete teeth"):
        Toothing(pitch=8e-3, tooth_stiffness=1e6, land_radius=1e-3)
    assert Toothing(pitch=8e-3, tooth_stiffness=1e6).times(2.0).tooth_stiffness == 2e6


def test_profiles_state_their_pitch_and_source() -> None:
    pitches = {name: 1e3 * one.toothing.pitch for name, one in read_catalogue().items() if one.toothing}
    assert pitches == pytest.approx(
        {"MXL": 2.032, "XL": 5.08, "L": 9.525, "H": 12.7, "XH": 22.225}
        | {"T2.5": 2.5, "T5": 5, "T10": 10, "AT5": 5, "AT10": 10}
        | {f"HTD {size}M": size for size in (3, 5, 8, 14)}
        | {f"STD {size}M": size for size in (3, 5, 8, 14)}
        | {f"GT {size}M": size for size in (2, 3, 5, 8)}
    )
    assert all(one.toothing.source for one in read_catalogue().values() if one.toothing)
