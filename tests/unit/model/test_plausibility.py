"""What a supplier would ask back is said with both numbers, and nothing of a drive that is right."""

from importlib.resources import files
from typing import Any

import numpy as np
import pytest

from beltdyn import simulate
from beltdyn.errors import ModelError
from beltdyn.model import Drive, advise, install, loads, prepare
from beltdyn.model.plausibility import judge_plausibility, other_diameters

EXAMPLES = {
    name: loads(files("beltdyn").joinpath("examples", f"{name}.toml").read_text(encoding="utf-8"))
    for name in ("alternator_drive", "accessory_drive", "washing_machine")
}


LOAD = {"kind": "resistance", "constant": "10 N m"}


def told(drive: Drive) -> list[str]:
    return [str(finding) for finding in judge_plausibility(drive, install(drive))]


def two_pulleys(belt: dict[str, Any], diameter: str = "120 mm", **motor: Any) -> Drive:
    return Drive(
        belt=belt,
        pulley=[
            {"name": "motor", "center": (0, 0), "diameter": diameter, "inertia": 1.0} | motor,
            {"name": "fan", "center": (0.5, 0), "diameter": "120 mm", "inertia": 1.0},
        ],
        simulation={"duration": 1.0, "output_interval": 0.01},
    )


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_are_plausible(name: str) -> None:
    assert told(EXAMPLES[name]) == []


def test_a_rib_at_450_newton_and_more() -> None:
    belt = {"profile": "PK", "ribs": 6}
    assert told(two_pulleys(belt | {"installed_tension": 2650.0})) == []
    drive = two_pulleys(belt | {"installed_tension": 2850.0})
    (text,) = told(drive)
    assert text.startswith("the tension at rest is 2850 N (475 N per rib)")
    assert "rated for 2700 N (450 N per rib)" in text
    assert "Use at least 7 ribs" in text
    assert text in advise(drive, install(drive))
    assert told(two_pulleys(belt | {"installed_tension": 2850.0, "largest_tension": "3 kN"})) == []


def test_a_load_that_drives_is_asked_about() -> None:
    """A torque in the sense of rotation, so that the driver brakes; not one that another load outweighs."""
    belt = {"profile": "SPB", "installed_tension": "800 N"}
    drive = two_pulleys(belt, "200 mm", speed="1450 rpm").with_({"pulley[fan].diameter": "200 mm"})
    steady = drive.with_({"simulation.start": "steady"})
    for sense, rotation in ((1.0, "counter-clockwise"), (-1.0, "clockwise")):
        turned = steady.with_({"rotation": rotation})
        assert told(turned.with_({"pulley[fan].torque": -50.0})) == []
        (text,) = told(turned.with_({"pulley[fan].torque": 50.0}))
        assert text.startswith("the torque of fan, 50 N m, acts in its sense of rotation"), sense
        assert text.endswith("Give a load the opposite sign: -50 N m.")


def test_one_v_belt_where_no_number_is_said() -> None:
    belt = {"profile": "SPB", "installed_tension": "4 kN"}
    one, two = (two_pulleys(belt | ribs, "200 mm") for ribs in ({}, {"ribs": 2}))
    assert two.belt.axial_stiffness == 2.0 * one.belt.axial_stiffness
    (text,) = [each for each in told(one) if "is rated for" in each]
    assert "(4e+03 N per belt)" in text
    assert "Use at least 2 belts" in text


def test_a_drive_without_a_run() -> None:
    """A duration is needed by runs alone; analyses look at 10 s."""
    belt = {"profile": "SPB", "installed_tension": "800 N"}
    whole = two_pulleys(belt, "200 mm", speed={"kind": "ramp", "start": 0.0, "end": 5.0, "value": "1450 rpm"})
    drive = Drive(belt=whole.belt, pulley=whole.pulleys)
    assert drive.simulation.end == 10.0
    with pytest.raises(ModelError, match=r"simulation.duration is missing.*such as \"1 s\""):
        simulate(drive)


def test_the_centrifugal_tension_of_a_belt_that_a_spring_takes_up() -> None:
    """m v^2 adds to the tension; between fixed centers it only takes pressure off the pulleys."""
    drive = EXAMPLES["alternator_drive"]
    mass, crank = drive.belt.mass_per_length, drive.pulleys[0]
    limit = np.sqrt((2700.0 - 300.0) / mass)
    slow, fast = (drive.with_({"pulley[crank].speed.value": part * limit / crank.radius}) for part in (0.97, 1.05))
    assert told(slow) == []
    (text,) = told(fast)
    assert "centrifugal; the belt is rated for 2700 N (450 N per rib). " in text
    assert f"Reduce the speed below {limit:.3g} m/s" in text


def test_what_would_set_a_tension_right_is_named_where_a_length_sets_it() -> None:
    """Diameters of the tension line, given as effective ones, stretch a belt of fixed centers by 2 pi offset."""
    around = 1.0 + 0.12 * np.pi
    drive = two_pulleys({"profile": "PK", "ribs": 6, "nominal_length": around - 0.029})
    (text,) = told(drive)
    less = drive.replace(pulley=[one.replace(radius=one.radius - 0.0015) for one in drive.pulleys])
    assert f"{install(drive).tension:.4g} N" in text
    assert f"{install(less).tension:.4g} N with the diameters as those of the tension line" in text


def test_what_other_diameters_would_mean() -> None:
    """Six ribs PK on fixed centers: 2 pi times the offset more of path, told in tension or in length."""
    around = 1.0 + 0.12 * np.pi
    drive = two_pulleys({"profile": "PK", "ribs": 6, "nominal_length": around - 0.012})
    less = drive.replace(pulley=[one.replace(radius=one.radius - 0.0015) for one in drive.pulleys])
    assert (
        other_diameters(drive)
        == f"tension at rest {install(less).tension:.5g} N instead of {install(drive).tension:.5g} N"
    )
    assert install(drive).tension - install(less).tension == pytest.approx(
        120e3 * 2 * np.pi * 0.0015 / around, rel=0.05
    )
    drive = two_pulleys({"profile": "PK", "ribs": 6, "installed_tension": 300.0})
    assert drive.belt_length - 0.0094 == pytest.approx(float(other_diameters(drive).split()[2]), abs=2e-4)
    assert other_diameters(two_pulleys({"profile": "SPZ", "ribs": 2, "installed_tension": 300.0})) == ""


def test_diameters_whose_kind_is_named_bring_no_hint() -> None:
    """Flat idlers on the back among them; a pulley without a kind keeps the hint, for itself alone."""
    kinds: list[dict[str, str]] = [{"diameter_kind": "pitch"}] * 2
    third = {"name": "idler", "center": ["200 mm", "20 mm"], "diameter": "60 mm", "side": "outside", "inertia": 1e-4}
    hints = []
    for count in (2, 1, 0):
        named = [*kinds[:count], {}, {}][:2]
        pulleys = [
            {"name": "driver", "center": [0, 0], "diameter": "120 mm", "speed": 100.0} | named[0],
            {"name": "driven", "center": ["400 mm", 0], "diameter": "120 mm", "inertia": 0.01} | named[1],
            third,
        ]
        belt = {"profile": "PK", "ribs": 4, "installed_tension": "300 N"}
        hints.append(other_diameters(Drive(belt=belt, pulley=[pulleys[0], pulleys[2], pulleys[1]])))
    assert hints[0] == ""
    assert all(hints[1:])
    assert hints[1] != hints[2]


def test_a_pulley_below_the_smallest_of_the_belt() -> None:
    belt = {"profile": "PJ", "ribs": 5, "installed_tension": 200.0}
    assert told(two_pulleys(belt, "20 mm")) == []
    (text,) = told(two_pulleys(belt, "17 mm"))
    assert "the smallest recommended pulley diameter of this belt is 20 mm, but that of motor is 17 mm" in text
    assert f"life is about {(17 / 20) ** 5.6:.0%} of" in text


def test_a_tensioner_on_the_tight_side() -> None:
    """The same drive turned the other way: its loads lie between crank and tensioner then."""
    drive = EXAMPLES["alternator_drive"]
    speed = drive.pulleys[0].speed
    assert speed is not None
    backwards = speed.replace(value=-speed.value)  # type: ignore[attr-defined]
    turned = drive.with_({"pulley[crank].speed": backwards, "pulley[alternator].load": [LOAD]})
    (text,) = told(turned)
    assert text.startswith(f"the tensioner of {drive.tensioners[0].pulley} is on the tight side")
    assert f"the loads need {10.0 / drive.radii[2]:.4g} N" in text
    assert told(drive.with_({"pulley[alternator].load": [LOAD]})) == []


def test_a_contact_side_that_was_forgotten() -> None:
    """The tensioner of the accessory drive lies outside of its belt: taken as inside, the belt hardly touches it."""
    drive = EXAMPLES["accessory_drive"]
    path = drive.path
    wrong = drive.replace(
        pulley=[one.replace(side="inside") if one.name == "tensioner" else one for one in drive.pulleys]
    )
    (text,) = [one for one in told(wrong) if "wraps tensioner" in one]
    assert f"wraps tensioner by {np.degrees(wrong.path.wrap_angles[1]):.3g}°" in text
    assert f"its outside would wrap it by {np.degrees(path.wrap_angles[1]):.3g}°" in text
    assert f"{1e3 * (path.length - wrong.path.length):.3g} mm longer than {wrong.path.length:.5g} m" in text
    assert 'set side = "outside" for tensioner' in text


def test_a_start_whose_speeds_jump() -> None:
    belt = {"profile": "PJ-elastic", "ribs": 5, "installed_tension": 160.0}
    drive = two_pulleys(belt, speed="7640 rpm")
    (text,) = told(drive)
    assert "motor at 7640 rpm from the first instant, with the belt at rest" in text
    assert 'Set simulation.start = "steady"' in text
    change = np.sqrt(drive.belt.axial_stiffness * drive.belt.mass_per_length) * drive.radii[0] * 7640 * np.pi / 30
    assert f"changes by up to {change:.3g} N from 160 N" in text
    assert told(drive.with_({"simulation.start": "steady"})) == []
    rising = {"kind": "cosine_ramp", "start": 0.0, "end": 0.1, "value": "7640 rpm"}
    assert told(two_pulleys(belt, speed=rising)) == []


def test_a_center_that_is_not_that_of_the_preload() -> None:
    """The belt of another position: the arm turns until its spring balances it."""
    drive = EXAMPLES["alternator_drive"]
    wrong = drive.with_({"belt.length": 1.01 * drive.belt_length})
    (text,) = [one for one in told(wrong) if "not preload" in one]
    there = install(wrong)
    (carrier,) = prepare(wrong).carriers
    assert f"its spring gives {carrier.force(float(there.tensioner_positions[0])):.4g} N m" in text
    assert f"not {there.tension:.4g} N at rest" in text


def test_a_preload_that_is_a_tenth_of_what_the_belt_needs() -> None:
    """A spring torque is proportional to the tension at its nominal position: 300 N are half of 100 N a rib."""
    drive = EXAMPLES["alternator_drive"].with_({"belt.installed_tension": None, "tensioner[1].preload": "14.2 N m"})
    assert not [one for one in told(drive) if "preload" in one]
    light = drive.with_({"tensioner[1].preload": "1.42 N m"})
    tension = install(light).tension
    (text,) = [one for one in told(light) if "preload" in one]
    assert f"preload = 1.42 N m of the tensioner of tensioner gives {tension:.4g} N" in text
    assert "measured under 300 N" in text
    assert f"takes {1.42 * 300.0 / tension:.4g} N m" in text


def test_a_tensioner_without_the_mass_of_its_pulley() -> None:
    """A rim of the moment of inertia J and the radius R has a mass of J / R^2 or more."""
    drive = EXAMPLES["accessory_drive"].with_({"pulley[tensioner].mass": 0.0, "pulley[tensioner].inertia": "6 kg cm^2"})
    (text,) = told(drive)
    least, arm = 6e-4 / 0.035**2, 6e-4
    assert f"needs at least {least:.3g} kg at a radius of 35 mm" in text
    assert f"up to {np.sqrt(1.0 + least * 0.075**2 / arm) - 1.0:.0%} too high" in text


def test_drums_too_small_for_a_conveyor_belt_at_any_tension() -> None:
    """ST 1000 needs 400 mm where it carries little (DIN 22101); the fatigue of V-belts says nothing of it."""
    belt = {"profile": "ST 1000", "width": "0.5 m", "installed_tension": "10 kN"}
    small = two_pulleys(belt, "390 mm").with_({"pulley[fan].diameter": "400 mm", "pulley[fan].center": [3.0, 0.0]})
    (text,) = (one for one in told(small) if "diameter" in one)
    assert text.startswith("the diameter of motor is 390 mm, but at least 400 mm are recommended")
    assert not any("diameter" in one for one in told(small.with_({"pulley[motor].diameter": "400 mm"})))
