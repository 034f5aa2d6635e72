"""The tension at rest that a load requires by the rules of makers."""

from math import pi

import pytest

import beltdyn as bd
from beltdyn.model import Drive, advise, install, loads
from beltdyn.model.belt_loads import MAKERS
from beltdyn.model.demand import required_tension
from beltdyn.model.installation import tension_checks
from beltdyn.show.tables import Facts
from beltdyn.theory.rating import TENSION_FORMULAS, least_rest_tension, least_tension

TEXT = """
[belt]
profile = "SPA"
ribs = 2
installed_tension = "750 N"
[[pulley]]
name = "motor"
center = [0.0, 0.0]
diameter = "200 mm"
speed = "1450 rpm"
[[pulley]]
name = "fan"
center = [0.7, 0.0]
diameter = "400 mm"
inertia = 1.0
torque = "-197.6 N m"
[limits]
service_factor = 1.2
[simulation]
duration = 1.0
start = "steady"
"""


@pytest.fixture(scope="module")
def drive() -> Drive:
    """15 kW on two belts SPA."""
    return loads(TEXT)


def test_the_power_of_the_fan(drive: Drive) -> None:
    powers, speed = drive.belt_loads(0).powers_drawn(drive.path)
    assert powers[1] == pytest.approx(15e3, rel=1e-3)
    assert speed == pytest.approx(pi * 0.2 * 1450.0 / 60.0)


def test_both_ends_of_the_range_of_makers(drive: Drive) -> None:
    installation = install(drive)
    needed = required_tension(drive, installation)
    assert needed is not None
    assert tuple(needed.by_formula) == MAKERS
    speed, wrap = pi * 0.2 * 1450.0 / 60.0, float(installation.path.wrap_angles.min())
    assert needed.pull == pytest.approx(1.2 * 15e3 / speed, rel=1e-3)
    for name, grip in TENSION_FORMULAS.items():
        by_hand = least_tension(needed.pull, wrap, drive.belt.mass_per_length, speed, grip)
        assert needed.by_formula[name] == pytest.approx(by_hand)
    low, high = needed.by_formula.values()
    assert 1.4 < high / low < 1.9
    assert needed.tension == high


def test_a_loose_belt_is_warned_of(drive: Drive) -> None:
    told = [text for text in advise(drive, install(drive)) if "with the service factor needs" in text]
    assert len(told) == 1
    needed = required_tension(drive, install(drive))
    assert needed is not None
    assert f"{needed.tension:.4g} N (GB/T 13575.1)" in told[0]
    assert "(Optibelt)" in told[0]
    tight = drive.with_({"belt.installed_tension": 1.01 * needed.tension})
    assert not [text for text in advise(tight, install(tight)) if "with the service factor needs" in text]


def test_the_least_state_is_that_of_the_load(drive: Drive) -> None:
    installation = install(drive)
    needed = required_tension(drive, installation)
    assert needed is not None
    found = {one.state: one.tension for one in tension_checks(drive, installation, least=needed.tension)}
    assert found["least"] == pytest.approx(needed.tension)
    assert found["run in"] == pytest.approx(750.0, rel=1e-3)
    parts = bd.check(drive, equilibrium=False).sheet.parts
    facts = dict(fact for part in parts if isinstance(part, Facts) for fact in part.facts)
    assert "(Optibelt)" in facts["least tension"]
    assert "(GB/T 13575.1)" in facts["least tension"]


def test_where_the_rules_do_not_apply(drive: Drive) -> None:
    idle = drive.with_({"pulley[fan].torque": 0.0})
    assert required_tension(idle, install(idle)) is None
    slide = {"kind": "sliding", "pulley": "fan", "direction": [1.0, 0.0], "preload": "1484.6 N", "mass": 1.0}
    sprung = drive.replace(tensioner=[slide])
    assert required_tension(sprung, install(sprung)) is None


def test_a_toothed_belt_has_one_rule() -> None:
    toothed = bd.Drive(
        belt={"profile": "HTD 8M", "width": "20 mm", "teeth": 100, "installed_tension": 300.0},
        pulley=[
            {"name": "driver", "center": [0.0, 0.0], "teeth": 24, "speed": 100.0},
            {"name": "driven", "center": [0.28, 0.0], "teeth": 36, "inertia": 1e-3, "torque": -5.0},
        ],
        tensioner=[{"kind": "fixed", "pulley": "driven", "direction": [1.0, 0.0]}],
        simulation={"duration": 1.0},
    )
    needed = required_tension(toothed, install(toothed))
    assert needed is not None
    pull, speed = 5.0 / (36 * 8e-3 / (2 * pi)), 100.0 * 24 * 8e-3 / (2 * pi)
    by_hand = least_rest_tension(pull, toothed.belt.mass_per_length, speed)
    assert list(needed.by_formula.values()) == pytest.approx([by_hand])
