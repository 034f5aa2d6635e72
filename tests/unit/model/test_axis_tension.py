"""The tension that moves of a linear axis require: closed forms of an oscillator, and runs over time."""

import re

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import BeltdynError
from beltdyn.model import Drive, advise, install
from beltdyn.model.demand import required_tension

TURN = 2.0 * np.pi
RADIUS, MASS, ACCELERATION = 20 * 2e-3 / TURN, 3.0, 5.0


def axis(speed: object, **carriage: object) -> Drive:
    """A carriage between pulleys 300 mm apart, with 135 mm of belt to the driver; the belt has hardly any mass."""
    belt = {"profile": "GT 2M", "width": "6 mm", "teeth": 330, "installed_tension": "40 N", "mass_per_length": 1e-5}
    return Drive(
        belt=belt,
        carriage={"center": [0.15, RADIUS], "direction": [-1, 0], "length": 0.03, "mass": MASS} | carriage,
        pulley=[
            {"name": "motor", "center": [0.0, 0.0], "teeth": 20, "speed": speed},
            {"name": "idler", "center": [0.3, 0.0], "teeth": 20, "inertia": 1e-7},
        ],
        tensioner=[{"kind": "fixed", "pulley": "idler", "direction": [1, 0]}],
        simulation={"duration": 0.4},
    )


def moving(jerk: float, acceleration: float = ACCELERATION, way: float = 0.1) -> dict[str, object]:
    """A move of the carriage (m/s², m/s³, m)."""
    angles = {"acceleration": acceleration / RADIUS, "jerk": jerk / RADIUS}
    return {"kind": "s_curve", "times": [0.05], "angles": [way / RADIUS], "speed": 0.3 / RADIUS} | angles


def needs(drive: Drive) -> tuple[float, float]:
    """Required tension and pull, N."""
    found = required_tension(drive, install(drive))
    assert found is not None
    return found.tension, found.pull


def frequency(drive: Drive, way: float) -> float:
    """Of the carriage on its spans at a way from its center, Hz."""
    lengths = install(drive).path.span_lengths
    near, total = float(lengths[-1]) - way, float(np.sum(lengths))
    stiffness = drive.belt.local_stiffness(40.0) * (1.0 / near + 1.0 / (total - near))
    return float(np.sqrt(stiffness / MASS) / TURN)


def test_a_jump_of_the_acceleration_doubles_the_pull() -> None:
    """A carriage begins to accelerate towards the driver, to which 35 mm of belt are left in the end."""
    start = {"kind": "table", "times": [0.0, 0.2, 0.4], "values": [0.0, 0.0, 0.2 * ACCELERATION / RADIUS]}
    for guide in (0.0, 1.0):
        drive = axis(start, friction=guide)
        tension, pull = needs(drive)
        assert pull == pytest.approx(2.0 * MASS * ACCELERATION + guide, rel=0.01)
        lengths = install(drive).path.span_lengths
        share = 1.0 - (float(lengths[-1]) - 0.1) / float(np.sum(lengths))
        assert tension == pytest.approx((share + 0.1) * pull, rel=0.01)


@pytest.mark.parametrize("periods", [0.5, 1.0, 1.5, 2.5])
def test_an_acceleration_that_rises_slowly_excites_less(periods: float) -> None:
    """1 + |sin(pi n) / (pi n)| for a rise over n periods; a little is left at the places whose n is none of these."""
    level = 2.0
    slowest = frequency(axis(moving(1e3)), 0.0)
    rise = periods / slowest
    steps = np.linspace(0.0, rise, 61)
    speeds = 0.5 * level / rise * steps**2
    times = [0.0, *(0.1 + steps), 0.4]
    values = [0.0, *speeds, speeds[-1] + level * (0.3 - rise)]
    drive = axis({"kind": "table", "times": times, "values": [float(one) / RADIUS for one in values]})
    way = float(np.trapezoid(values, times))
    counts = np.array([rise * frequency(drive, place) for place in np.linspace(0.0, way, 5)])
    expected = MASS * level * (1.0 + np.abs(np.sinc(counts)).max())
    assert needs(drive)[1] == pytest.approx(expected, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("speed", "carriage"),
    [
        (moving(200.0), {}),
        ({"kind": "table", "times": [0.05, 0.11, 0.25, 0.31], "values": [0.0, 47.0, 47.0, 0.0]}, {"damping": 20.0}),
        (moving(2000.0, 20.0), {"friction": 3.0}),
    ],
)
def test_no_span_is_slack_at_that_tension_and_one_is_nearly_at_less(speed: object, carriage: dict[str, float]) -> None:
    drive = axis(speed, **carriage).with_({"belt.mass_per_length": 0.0084, "simulation.rtol": 1e-3})
    least = []
    for factor in (1.0, 0.6):
        tension, pull = needs(drive)
        run = bd.simulate(drive.with_({"belt.installed_tension": factor * tension}))
        least.append(float(run.dataset.least_span_tension.min()) / pull)
    assert 0.0 < least[0] < 0.5
    assert least[1] < 0.1
    assert least[1] < 0.6 * least[0]


def test_a_loose_axis_is_told_and_a_tight_one_is_not() -> None:
    drive = axis(moving(200.0))
    tension, _ = needs(drive)
    assert not any("moves pull" in one for one in advise(drive, install(drive)))
    loose = drive.with_({"belt.installed_tension": 0.6 * tension})
    (told,) = [one for one in advise(loose, install(loose)) if "moves pull" in one]
    advised = float(re.findall(r"at least ([\d.]+) N", told)[0])
    assert advised == pytest.approx(tension, rel=0.02)
    tight = drive.with_({"belt.installed_tension": advised})
    assert not any("moves pull" in one for one in advise(tight, install(tight)))


def test_a_loose_axis_without_teeth_is_told_by_its_own_rule_alone() -> None:
    """Rules of makers are for V-belts under power; a smooth belt is no exception."""
    toothed = axis(moving(1e4))
    stiffness = {"axial_stiffness": 1e5, "bending_stiffness": 1e-3, "mass_per_length": 1e-2}
    smooth = Drive(
        belt={"width": 6e-3, "thickness": 1e-3, "installed_tension": 20.0} | stiffness,
        carriage={"center": [0.15, RADIUS], "direction": [-1, 0], "length": 0.03, "mass": MASS},
        pulley=[
            {"name": "motor", "center": [0.0, 0.0], "radius": RADIUS, "speed": moving(1e4)},
            {"name": "idler", "center": [0.3, 0.0], "radius": RADIUS, "inertia": 1e-7},
        ],
        tensioner=[{"kind": "fixed", "pulley": "idler", "direction": [1, 0]}],
        contact={"friction": 0.5},
        simulation={"duration": 0.4},
    )
    (told,) = [one for one in advise(smooth, install(smooth)) if "the tension at rest is" in one]
    assert "moves pull" in told
    assert "the belt may slip" in told
    loose = toothed.with_({"belt.installed_tension": 5.0})
    assert any("teeth may jump" in one for one in advise(loose, install(loose)))


def test_an_axis_with_a_motor_has_no_prescribed_moves() -> None:
    drive = axis(moving(200.0))
    motor = drive.pulleys[0].replace(speed=None, inertia=1e-5, torque=0.01)
    try:
        free = drive.replace(pulley=[motor, drive.pulleys[1]])
    except BeltdynError:
        pytest.fail("an axis with a torque is a drive")
    assert required_tension(free, install(free)) is None
