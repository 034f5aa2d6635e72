"""Web lines that cannot run: one clear error each; unwinder and winder hold the ends in running order."""

from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, Roll, dumps, loads, prepare

ROLLER = {"name": "roller", "center": [0.5, 0.0], "radius": 0.05, "speed": 40.0}
IDLER = {"name": "idler", "center": [1.0, 0.3], "radius": 0.05, "side": "outside", "inertia": 1e-3}
BELT = {
    "axial_stiffness": 2e4,
    "bending_stiffness": 1e-4,
    "mass_per_length": 0.05,
    "thickness": 1e-4,
    "width": 0.2,
}

END = {"point": [0.0, 0.3], "tension": 100.0}
BRAKED = {"point": [0.0, 0.3], "torque": 9.0, "roll": {"core_radius": 0.05, "radius": 0.1}}


def line(**changes: Any) -> Drive:
    given: dict[str, Any] = {
        "belt": BELT,
        "unwinder": {"point": [0.0, 0.3], "tension": 100.0},
        "winder": {"point": [1.5, 0.0], "tension": 150.0},
        "pulley": [ROLLER, IDLER],
        "contact": {"friction": 0.4},
        "simulation": {"duration": 1.0},
    }
    return Drive(**(given | changes))


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"winder": None}, r"\[winder\] is missing: a web line has an unwinder and a winder"),
        ({"unwinder": None}, r"\[unwinder\] is missing"),
        (
            {"pulley": [ROLLER | {"speed": None, "inertia": 1e-3}, IDLER]},
            "nothing moves the web: no roller has a speed or a motor",
        ),
        (
            {"pulley": [ROLLER | {"speed": -40.0}, IDLER]},
            'the speed of "roller" moves the web from the winder to the unwinder',
        ),
        ({"pulley": [ROLLER, IDLER | {"side": "inside"}]}, 'would cross itself: .* Set side = "outside" for "idler"'),
        (
            {"belt": BELT | {"crossed": True}, "pulley": [ROLLER, IDLER | {"side": "inside"}]},
            r"belt\.crossed = true is incompatible with \[unwinder\]",
        ),
        ({"pulley": [ROLLER, IDLER | {"center": [0.55, 0.05]}]}, 'pulleys "roller" and "idler" overlap'),
        (
            {"end": [{"name": "a", "kind": "fixed", "point": [0, 1]}, {"name": "b", "kind": "fixed", "point": [1, 1]}]},
            r"\[unwinder\] and \[winder\] exclude \[\[end\]\] and \[carriage\]",
        ),
        ({"unwinder": END | {"roll": {"core_radius": 0.1}}}, "needs one of radius and length"),
        (
            {"winder": END | {"roll": {"core_radius": 0.1, "radius": 0.3, "length": 9.0}}},
            "needs one of radius and length",
        ),
        ({"unwinder": END | {"roll": {"core_radius": 0.1, "radius": 0.05}}}, r"radius = 0\.05 m is below core_radius"),
        ({"unwinder": {"point": [0.0, 0.3]}}, "needs one of tension, which a drive keeps, and torque, on the roll"),
        ({"unwinder": END | {"torque": 9.0}}, "needs one of tension, which a drive keeps, and torque, on the roll"),
        ({"unwinder": BRAKED | {"roll": None}}, "torque acts on a roll, which is missing"),
        ({"unwinder": BRAKED | {"torque": -9.0}}, r"torque = -9 N m must be positive: it tightens the web"),
        (
            {"unwinder": BRAKED | {"torque": {"kind": "table", "times": [0, 1, 2], "values": [9, 0, 9]}}},
            "torque = 0 N m must be positive",
        ),
        ({"belt": BELT | {"stretch_loss_factor": 0.05}}, "loss factors of the belt are incompatible with"),
    ],
)
def test_what_cannot_run_is_told(changes: dict[str, Any], told: str) -> None:
    with pytest.raises(ModelError, match=told):
        line(**changes)


def test_a_web_runs_from_the_unwinder_to_the_winder() -> None:
    drive = line()
    assert drive.is_web
    assert drive.spans == (("roller", "idler"), ("idler", "winder"), ("unwinder", "roller"))
    assert drive.path.ends is not None
    assert drive.path.ends.tolist() == [[0.0, 0.3], [1.5, 0.0]]


def test_a_web_at_rest_has_the_tension_of_the_unwinder() -> None:
    assert prepare(line()).installation.tension == pytest.approx(100.0, rel=1e-9)


def test_a_web_at_rest_has_the_torque_of_a_brake_over_the_radius() -> None:
    rising = {"kind": "step", "time": 0.5, "before": 9.0, "value": 12.0}
    drive = line(unwinder=BRAKED | {"torque": rising})
    assert prepare(drive).installation.tension == pytest.approx(90.0, rel=1e-9)
    assert drive.breakpoints == (0.5,)
    assert drive.web_ends[0].tension_at(0.75, 1e-4) == pytest.approx(120.0, rel=1e-12)


def test_a_file_keeps_both_ends() -> None:
    for drive in (line(), line(unwinder=BRAKED)):
        again = loads(dumps(drive))
        assert (again.unwinder, again.winder) == (drive.unwinder, drive.winder)


def test_a_given_length_serves_as_it_is() -> None:
    prepared = prepare(line())
    longer = prepared.with_length(1.001 * prepared.belt_length)
    assert longer.belt_length == pytest.approx(1.001 * prepared.belt_length, rel=1e-12)
    assert longer.contact == prepared.contact


def test_the_size_of_a_roll_follows_from_its_web() -> None:
    """R^2 = R_c^2 + h l / pi, and the inertia of a ring, m (R^2 + R_c^2) / 2, beside that of the core."""
    roll = Roll(core_radius=0.05, radius=0.3, core_inertia=0.2)
    length = roll.length_of(1e-4)
    assert length == pytest.approx(np.pi * (0.3**2 - 0.05**2) / 1e-4, rel=1e-12)
    assert roll.radius_at(np.array([0.0, length, -1.0]), 1e-4) == pytest.approx([0.05, 0.3, 0.05])
    assert roll.inertia_at(np.array([length]), 1e-4, 0.02)[0] == pytest.approx(0.2 + 0.02 * length * 0.0925 / 2.0)
    assert Roll(core_radius=0.05, length=7.0).length_of(1e-4) == 7.0
    drive = line(unwinder=END | {"roll": {"core_radius": 0.1, "radius": 0.3}})
    assert loads(dumps(drive)) == drive
    assert [one.name for one in drive.rolls] == ["unwinder"]
