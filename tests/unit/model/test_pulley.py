"""Rules of a pulley with what is behind its rim and on its shaft."""

from typing import Any

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Isolator, OneWayClutch, Pulley, Resistance

SPEED = {"kind": "constant", "value": "720 rpm"}
LOAD = {"kind": "resistance", "linear": 0.1}
LINK = {"kind": "isolator", "stiffness": "30 N*m/rad", "inertia": 0.1}
PLACE = {"name": "one", "center": (0, 0), "radius": 0.1}


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"speed": SPEED, "load": [LOAD]}, "speed and load exclude each other"),
        ({"inertia": 1.0, "harmonics": [{"order": 2, "amplitude": 0.1}]}, "has harmonics but no speed"),
        ({"inertia": 1.0, "hub": [LINK, LINK | {"inertia": 0}]}, "hub[2] has no inertia, but the body behind it turns"),
        ({"speed": SPEED, "inertia": 1.0, "hub": [LINK | {"inertia": 0}, LINK]}, "hub[1] has no inertia"),
        ({"speed": SPEED, "hub": [LINK]}, "has a hub chain but no inertia of its free rim"),
        ({"inertia": 1.0, "mass": -1.0}, "pulley.mass = -1.0 must be at least 0. Give the mass of the pulley"),
        ({"inertia": 1.0, "hub": [{"kind": "isolator"}]}, "pulley.hub[1].stiffness is missing. Give the torque over"),
        ({"inertia": 1.0, "hub": [{"stiffness": 1.0}]}, "has no kind"),
        ({"inertia": 1.0, "hub": [{"kind": "isolater"}]}, 'pulley.hub[1].kind = "isolater" is not a valid choice'),
        (
            {"inertia": 1.0, "load": [{"linear": 1.0}]},
            "with one of the kinds angle_speed_table, angle_table, band_brake",
        ),
        ({"inertia": 1.0, "load": LOAD}, "pulley.load = "),
        (
            {"speed": SPEED, "harmonics": [{"order": 0, "amplitude": 1}]},
            "pulley.harmonics[1].order = 0 must be greater",
        ),
    ],
)
def test_errors(given: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ModelError) as caught:
        Pulley(**PLACE, **given)
    assert sentence in str(caught.value)


def test_the_last_body_of_a_chain_may_be_prescribed() -> None:
    pulley = Pulley(**PLACE, inertia=0.2, speed=SPEED, hub=[LINK, LINK | {"inertia": 0}])
    assert pulley.prescribed
    assert [link.kind for link in pulley.hub] == ["isolator", "isolator"]


def test_chains_and_loads_are_accepted_as_objects() -> None:
    link = OneWayClutch(kind="one_way_clutch", locking_damping=3.0, inertia=0.1)
    load = Resistance(kind="resistance", constant="120 N mm")
    pulley = Pulley(**PLACE, inertia=0.2, hub=[link], load=[load])
    assert pulley.hub == (link,)
    assert pulley.load[0].arguments["constant"] == pytest.approx(0.12)
    with pytest.raises(ModelError, match="must be greater than 0"):
        Isolator(kind="isolator", stiffness=0.0)


def test_everything_prescribed_over_time_is_listed() -> None:
    schedule = {"kind": "step", "time": 0.3, "value": 1.0}
    clutch = {"kind": "friction_clutch", "capacity": 1.0, "locking_damping": 1.0, "inertia": 1.0}
    pulley = Pulley(
        **PLACE,
        inertia=0.2,
        torque={"kind": "ramp", "start": 0.1, "end": 0.2, "value": 1.0},
        load=[LOAD, LOAD | {"schedule": schedule}],
        hub=[LINK, clutch | {"schedule": schedule | {"time": 0.4}}],
    )
    assert [profile.breakpoints() for profile in pulley.profiles] == [(0.1, 0.2), (0.3,), (0.4,)]
    assert [item is None for item in pulley.switching] == [True, True, False, True, True, False]


def test_a_pulley_may_be_given_by_its_diameter() -> None:
    place = {key: value for key, value in PLACE.items() if key != "radius"}
    pulley = Pulley.model_validate({**place, "diameter": "224 mm", "inertia": 1.0})
    assert pulley == Pulley(**place, radius=0.112, inertia=1.0)
    assert pulley.replace(diameter=0.3).radius == 0.15
    assert pulley.replace(diameter=None) == pulley


def test_schema_knows_the_diameter() -> None:
    schema = Pulley.model_json_schema()
    assert {"radius", "diameter"} <= set(schema["properties"])
    assert schema["anyOf"] == [{"required": [key]} for key in ("radius", "diameter", "teeth")]
    assert "radius" not in schema["required"]


def test_a_pulley_lies_in_the_plane() -> None:
    with pytest.raises(ModelError) as caught:
        Pulley(name="turned", center=(0.0, 0.0, 0.1), radius=0.1, inertia=1.0)
    assert "three coordinates, but drives are planar, with parallel shafts" in str(caught.value)
    assert "quarter-turn" in str(caught.value)
