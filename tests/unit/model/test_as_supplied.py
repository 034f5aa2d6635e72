"""Diameters by kind, and tensioner arms by angles, become radii, centers, preloads and stops."""

from math import atan2, degrees, hypot, pi, radians
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, Pulley, RotaryTensioner, dumps, example, loads, prepare

PK_PITCH, SPA_GROOVE = 1.5e-3, 2.75e-3
"""Offset of the cords of PK from the effective line, and groove of SPA above the datum line (ISO 4183), m."""


ALONE: dict[str, Any] = {"kind": "rotary", "pulley": "idler", "pivot": [0, 0], "preload": 1.0, "arm_angle": 1.0}
IDLER: dict[str, Any] = {"name": "idler", "center": [0.0, 0.0], "inertia": 1e-4}


def belted(profile: str, **driver: Any) -> Drive:
    pulleys = [
        {"name": "driver", "center": [0.0, 0.0], "speed": 100.0} | driver,
        {"name": "driven", "center": [0.5, 0.0], "radius": 0.06, "inertia": 0.01},
    ]
    belt = {"profile": profile, "ribs": 2, "installed_tension": 400.0}
    return Drive(belt=belt, pulley=pulleys, simulation={"duration": 1.0})


@pytest.mark.parametrize(
    ("profile", "kind", "radius"),
    [
        ("PK", "effective", 0.08),
        ("PK", "outside", 0.08),
        ("PK", "pitch", 0.08 - PK_PITCH),
        ("SPA", "datum", 0.08),
        ("SPA", "outside", 0.08 - SPA_GROOVE),
        ("SPA", "pitch", 0.08),
    ],
)
def test_a_diameter_of_a_kind_gives_the_radius_of_the_surface(profile: str, kind: str, radius: float) -> None:
    drive = belted(profile, diameter="160 mm", diameter_kind=kind)
    assert drive.pulleys[0].radius == pytest.approx(radius, abs=1e-9)
    if kind == "pitch":
        assert drive.radii[0] == pytest.approx(0.08)
    assert loads(dumps(drive)).pulleys[0] == drive.pulleys[0]
    larger = drive.with_({"pulley[driver].diameter": "170 mm"})
    assert larger.pulleys[0].radius == pytest.approx(radius + 0.005, abs=1e-9)


def test_a_flat_runs_on_the_back() -> None:
    pulley = Pulley(**(IDLER | {"diameter": "70 mm", "diameter_kind": "flat"}))
    assert (pulley.radius, pulley.side) == (0.035, "outside")
    with pytest.raises(ModelError, match=r'back of the belt, but side = "inside"\. Set side'):
        Pulley(**(IDLER | {"diameter": 0.07, "diameter_kind": "flat", "side": "ribs"}))


@pytest.mark.parametrize(("profile", "kind", "other"), [("PK", "datum", "effective"), ("SPA", "effective", "datum")])
def test_a_kind_of_other_belts_is_refused_with_that_of_this_one(profile: str, kind: str, other: str) -> None:
    with pytest.raises(ModelError, match=rf'"{kind}" of "driver" is incompatible .*Set diameter_kind = "{other}"'):
        belted(profile, diameter="160 mm", diameter_kind=kind)


def test_a_pulley_alone_knows_no_belt() -> None:
    with pytest.raises(ModelError, match=r'"pitch" depends on the belt.* mapping to Drive'):
        Pulley(**(IDLER | {"diameter": 0.1, "diameter_kind": "pitch"}))


NOMINAL, LENGTH, WOUND = degrees(atan2(0.06, -0.045)), 0.075, 29.5
"""Of the arm of the example, whose spring turns it counter-clockwise: degrees, m, and 11.8 N m over 0.4 N m/deg."""


def armed(*gone: str, center: bool = True, **keys: Any) -> Drive:
    """The accessory drive with other keys of its tensioner."""
    data = example("accessory_drive").data
    tensioner = {key: value for key, value in data["tensioner"][0].items() if key not in gone} | keys
    pulleys = [
        {key: value for key, value in one.items() if center or key != "center" or one["name"] != "tensioner"}
        for one in data["pulley"]
    ]
    return Drive(**(data | {"tensioner": [tensioner], "pulley": pulleys}))


STOPS = ("stops", "stop_stiffness", "stop_damping")


def test_an_arm_by_its_free_angle_has_the_preload_and_stops_of_its_angles() -> None:
    drive = armed("preload", *STOPS, free_angle=f"{NOMINAL + WOUND} deg", load_stop_angle=f"{NOMINAL - 15.0} deg")
    (arm,) = drive.moving_tensioners
    assert arm.spring["preload"] == pytest.approx(11.8)
    assert arm.stops == pytest.approx((radians(-15.0), radians(WOUND)))
    assert arm.arguments["sense"] == "counter-clockwise"
    assert arm.stop_stiffness == pytest.approx(11.8 * 4.0 * 180.0 / pi)
    assert loads(dumps(drive)).moving_tensioners == (arm,)
    assert drive.with_({"tensioner[tensioner].preload": 12.0}).moving_tensioners[0].spring["preload"] == 12.0
    softer = drive.with_({"tensioner[tensioner].free_angle": radians(NOMINAL + 20.0)}).moving_tensioners[0]
    assert softer.spring["preload"] == pytest.approx(8.0)


def test_free_angle_preload_and_rate_place_the_arm() -> None:
    free = {"free_angle": f"{NOMINAL + WOUND} deg", "sense": "counter-clockwise", "arm_length": "75 mm"}
    drive = armed(center=False, **free)
    np.testing.assert_allclose(drive.pulleys[1].center, [0.085, 0.140], atol=1e-12)
    by_angle = armed(center=False, arm_length=LENGTH, arm_angle=radians(NOMINAL))
    np.testing.assert_allclose(by_angle.pulleys[1].center, drive.pulleys[1].center, atol=1e-12)
    assert hypot(*np.subtract(drive.pulleys[1].center, drive.moving_tensioners[0].anchor or (0, 0))) == pytest.approx(
        LENGTH
    )


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({"free_angle": radians(NOMINAL + 40.0)}, r"preload = 11\.8 N m .* contradicts .*: 40° .* give 16 N m"),
        ({"sense": "clockwise"}, r"would slacken the belt, whose path lengthens by 0\.0399 m per rad .* counter-clock"),
        ({"arm_length": "80 mm"}, r"5 mm away from the given center: .* 75 mm at 126\.9°, .* 80 mm at 126\.9°"),
        ({"sense": "clockwise", "free_angle": radians(NOMINAL + WOUND)}, r"the spring turns the arm counter-clockwise"),
        ({"load_stop_angle": radians(NOMINAL - 15.0)}, r"sense of the tensioner of .* is missing"),
        (
            {"load_stop_angle": radians(NOMINAL + 15.0), "sense": "counter-clockwise"},
            r"lies on the side to which its spring turns",
        ),
        ({"arm_length": "abc"}, r'arm_length = "abc" must be a number in m'),
    ],
)
def test_what_contradicts_is_refused_with_both_numbers(keys: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        armed(**keys)


def test_an_arm_without_a_place_says_what_is_missing() -> None:
    with pytest.raises(ModelError, match=r"nominal position .* is open: free_angle and sense missing"):
        armed(center=False, arm_length=LENGTH)
    with pytest.raises(ModelError, match="arm_angle depends on the pulley"):
        RotaryTensioner(**ALONE)


def test_a_belt_without_length_sets_the_tensioner_to_its_nominal_position() -> None:
    given = example("accessory_drive")
    drive = given.with_({"belt.installed_tension": None})
    prepared = prepare(drive)
    (carrier,) = prepared.carriers
    tension = 11.8 / float(prepared.path.gradient(carrier.pulley) @ carrier.place(0.0)[1])
    assert prepared.installed_tension == pytest.approx(tension)
    assert prepared.installation.tension == pytest.approx(tension)
    assert abs(prepared.installation.tensioner_positions[0]) < 1e-9
    assert "nominal position" in next(one.reason for one in prepared.choices if one.key == "belt.length")
    assert f"belt of {drive.belt_length:.5g} m" in str(drive)
    stronger = drive.with_({"tensioner[tensioner].preload": "13 N m"})
    assert prepare(stronger).installed_tension == pytest.approx(tension * 13.0 / 11.8)


@pytest.mark.parametrize("name", ["accessory_drive", "alternator_drive", "washing_machine", "timing_drive"])
def test_a_list_in_clockwise_order_is_the_same_drive(name: str) -> None:
    """Pulleys on both sides of the belt, arms and teeth; the first pulley stays the first.

    A list of which both orders fit, as of `tensioner_stop` with its idler near the middle, is taken as it is.
    """
    drive = example(name)
    first, *others = drive.data["pulley"]
    turned = Drive.model_validate(drive.data | {"pulley": [first, *others[::-1]]})
    assert [one.name for one in turned.pulleys] == [one.name for one in drive.pulleys]
    assert turned.path.length == pytest.approx(drive.path.length, rel=1e-12)
    assert dumps(turned) == dumps(drive)


def test_a_list_that_fits_neither_way_round_is_refused() -> None:
    centers = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
    pulleys = [{"name": f"p{k}", "center": center, "radius": 0.1, "inertia": 0.01} for k, center in enumerate(centers)]
    for order in (pulleys, pulleys[::-1]):
        with pytest.raises(ModelError, match="List them as"):
            Drive(belt={"profile": "PK", "ribs": 2, "installed_tension": 400.0}, pulley=order)
