"""Worked examples that makers and textbooks publish, and two measurements, against the formulas and the solver.

| source | example |
|---|---|
| Optibelt, Technical Manual for V-Belt Drives, worked example | 8 SPB, 280/500 mm, 1485 rpm, 132 kW, factor 1.3 |
| Optibelt, the same, standard range | mass of classical V-belts |
| github.com/ScottMcCormack/conveyance, tests (ISO 5048, computed) | flat conveyor of 143 m, 2300 t/h of coal |
| community.carbide3d.com, thread 18480 (measured by a ruler, within 10 %) | GT2 of 9 mm under 169 N on 500 mm |
| github.com/prusa3d/Prusa-Firmware-Buddy, constants (measured) | GT2 of 6 mm: mass, frequency of a span |
| exercise script on a flat belt, 224/355 mm | 5.5 kW at 2900 rpm at the edge of slip |
| Scilab textbook companion, theory of machines, chapter belts | open flat belt, 1.0/1.5 m, 53.7 kW |

Not to be met: the V-belts 21-1 of the companion on machine design (T1 = 483 N), which leave out the wedge and take the
larger wrap angle.
"""

from math import asin, degrees, exp, log, pi

import numpy as np
import pytest
from scipy.optimize import brentq

import beltdyn as bd
from beltdyn.model import Drive, install, read_catalogue
from beltdyn.model.demand import required_tension
from beltdyn.model.rating import RatedBelt
from beltdyn.theory.creep import capstan_ratio
from beltdyn.theory.rating import TENSION_FORMULAS, least_tension
from beltdyn.theory.span import lowest_frequency, open_belt, sag_ratio

G = 9.81


@pytest.fixture(scope="module")
def fan() -> Drive:
    speed = 2.0 * pi * 1485.0 / 60.0
    return bd.Drive(
        belt={"profile": "SPB", "ribs": 8, "installed_tension": 8 * 593.0},
        pulley=[
            {"name": "motor", "center": [0.0, 0.0], "diameter": "280 mm", "speed": speed},
            {
                "name": "fan",
                "center": [1.3835, 0.0],
                "diameter": "500 mm",
                "inertia": 1.0,
                "torque": -132e3 / (speed * 280.0 / 500.0),
            },
        ],
        limits={"service_factor": 1.3},
        simulation={"duration": 1.0, "start": "steady"},
    )


def test_v_belts_of_a_fan_geometry(fan: Drive) -> None:
    assert pi * 0.28 * 1485.0 / 60.0 == pytest.approx(21.76, rel=1e-3)
    assert degrees(float(fan.path.wrap_angles[0])) == pytest.approx(170.9, abs=0.05)
    assert fan.path.span_lengths[0] == pytest.approx(1.378, rel=1e-3)
    assert fan.belt.nominal_length_of(fan.belt_length) == pytest.approx(4.0, rel=2e-3)


def test_v_belts_of_a_fan_tension(fan: Drive) -> None:
    """593 N a belt with the wrap factor 1.0 of Optibelt's table; ISO 5292 has 0.979 for 170.9 degrees, 3.6 % more."""
    speed, mass = 21.76, 0.19
    pull = 1.3 * 132e3 / speed
    published = least_tension(pull, pi, 8.0 * mass, speed, TENSION_FORMULAS["Optibelt"])
    assert published / 8.0 == pytest.approx(593.0, abs=0.5)
    needed = required_tension(fan, install(fan))
    assert needed is not None
    assert needed.by_formula["Optibelt"] / 8.0 == pytest.approx(593.0, rel=0.045)  # mass 0.194 kg/m: 0.3 %
    assert needed.by_formula["GB/T 13575.1"] / needed.by_formula["Optibelt"] == pytest.approx(1.4, abs=0.05)
    hub = np.hypot(*install(fan).hub_loads.T)
    np.testing.assert_allclose(hub, 9452.0, rtol=1e-3)


def test_v_belts_of_a_fan_rating(fan: Drive) -> None:
    """Megadyne's belt, whose table ours is, carries 17 % more than Optibelt's; ratio and length agree."""
    belt = fan.rated_belt
    assert isinstance(belt, RatedBelt)
    rated = belt.on(2.0 * np.abs(fan.path.radii), fan.path.wrap_angles, 21.76, np.ones(2, dtype=bool))
    assert rated.basic[0] == pytest.approx(1.17 * 20.63e3, rel=0.01)
    assert rated.ratio[0] == pytest.approx(1.23e3, rel=0.02)
    assert belt.rating.length_factor(4.0) == pytest.approx(1.02, abs=0.01)
    # 7.70 of them; fewer by their power, more by the factor 0.90 of belts side by side, which Optibelt does not take
    assert belt.belts_needed(1.3 * 132e3 / float(rated.power[0]), 2) == 8


@pytest.mark.parametrize(("name", "mass"), {"A": 0.109, "B": 0.196, "C": 0.324, "D": 0.668, "E": 0.958}.items())
def test_mass_of_classical_v_belts(name: str, mass: float) -> None:
    """Means over makers, whose belts differ by 10 %."""
    assert read_catalogue()[name].mass_per_length == pytest.approx(mass, rel=0.07)


BELT, GOODS, PULL = 16.44, 133.1, 13232.32


def test_a_flat_conveyor_by_hand() -> None:
    """Tensions by Euler without m v^2, and least tensions by sag: closed forms of the package."""
    slack = PULL / (capstan_ratio(0.3, pi) - 1.0)
    assert slack == pytest.approx(8447.96, rel=1e-4)
    assert slack + PULL == pytest.approx(21680.28, rel=1e-4)
    assert sag_ratio((BELT + GOODS) * G, 1.2, 22005.0) == pytest.approx(0.01, rel=1e-3)
    assert sag_ratio(BELT * G, 3.0, 3024.0) == pytest.approx(0.02, rel=1e-3)
    assert pytest.approx(66.71e3, rel=1e-3) == 12806.0 * 4.8 / (0.95 * 0.97)


@pytest.mark.slow
def test_main_resistance_of_a_flat_conveyor() -> None:
    """f L g (2 m_B + m_G + m_R) of both strands, at the drum of a conveyor without secondary resistances."""
    idlers = {"kind": "idlers", "friction": 0.02}
    drive = bd.Drive(
        gravity=[0.0, -G],
        belt={
            "width": 1.2,
            "thickness": 0.0125,
            "axial_stiffness": 6e6,
            "bending_stiffness": 10.0,
            "mass_per_length": BELT,
            "length": 287.7,
            "friction": 0.3,
        },
        pulley=[
            {"name": "drive", "center": [0.0, 0.0], "diameter": 0.6, "speed": 16.0},
            {"name": "tail", "center": [143.0, 0.05], "diameter": 0.5, "inertia": 50.0, "mass": 800.0},
        ],
        tensioner=[{"kind": "sliding", "pulley": "tail", "direction": [1, 0], "mass": 100.0, "preload": 44e3}],
        support=[
            idlers | {"span": ["tail", "drive"], "spacing": 1.2, "idler_mass": 15.5},
            idlers | {"span": ["drive", "tail"], "spacing": 3.0, "idler_mass": 13.2},
        ],
        goods=[{"span": ["tail", "drive"], "mass_per_length": GOODS}],
        simulation={"duration": 1.0},
    )
    pull = float(bd.steady_state(drive).dataset.shaft_torque.values[-1, 0]) / 0.3
    assert pull == pytest.approx(5142.73, rel=0.005)


def test_a_belt_of_printers_as_measured() -> None:
    """Glass cords: measured 1.6 times as stiff as the catalogue has them, of a profile whose products differ by two."""
    entry = read_catalogue()["GT 2M"]
    measured = 169.03 * 0.5 / 2.9e-3
    assert 0.5 < 0.9 * entry.axial_stiffness / measured < 1.0
    mass = 0.6 * entry.mass_per_length
    assert mass == pytest.approx(7.569e-3, rel=0.05)
    assert lowest_frequency(0.395, 18.0, 7.569e-3) == pytest.approx(61.7, abs=0.05)
    assert lowest_frequency(0.395, 18.0, mass) == pytest.approx(61.7, rel=0.025)


def flat(tension: float, friction: float) -> Drive:
    """A flat belt of 5.5 kW."""
    speed = 2.0 * pi * 2900.0 / 60.0
    return bd.Drive(
        belt={
            "installed_tension": tension,
            "width": 0.03,
            "thickness": 0.0014,
            "axial_stiffness": 16380.0,
            "bending_stiffness": 1e-5,
            "mass_per_length": 0.0504,
            "friction": friction,
        },
        pulley=[
            {"name": "motor", "center": [0.0, 0.0], "diameter": 0.224, "speed": speed},
            {
                "name": "driven",
                "center": [0.4, 0.0],
                "diameter": 0.355,
                "inertia": 0.1,
                "torque": -5500.0 / (speed * 0.224 / 0.355),
            },
        ],
        simulation={"duration": 1.0, "start": "steady"},
    )


def test_a_flat_belt_at_the_edge_of_slip() -> None:
    """Tensions and preload by Euler's equation with m v^2, taken as the mean of the strands."""
    path = open_belt(0.4, (0.112, 0.1775))
    wrap, speed = pi - 2.0 * asin(0.0655 / 0.4), pi * 0.224 * 2900.0 / 60.0
    assert 2.0 * path.span + 0.112 * path.wrap[0] + 0.1775 * path.wrap[1] == pytest.approx(1.72024, rel=1e-5)
    hoop, pull = 0.0504 * speed**2, 5500.0 / speed
    slack = hoop + pull / (exp(0.33 * wrap) - 1.0)
    assert (speed, hoop, slack, slack + pull) == pytest.approx((34.013, 58.31, 164.01, 325.71), rel=1e-3)
    assert slack + 0.5 * pull == pytest.approx(244.86, rel=1e-3)


def strands(preload: float, friction: float) -> tuple[float, float]:
    """Tensions of the strands of `flat`, N: belt enters arcs with that of its strand and slides before it leaves them.

    The belt keeps its length: over that, its tension has the mean of the preload.
    """
    path, speed = open_belt(0.4, (0.112, 0.1775)), pi * 0.224 * 2900.0 / 60.0
    hoop, pull = 0.0504 * speed**2, 5500.0 / speed

    def mean(slack: float) -> float:
        ratio = (slack + pull - hoop) / (slack - hoop)
        sliding = log(ratio) / friction
        slid = hoop * sliding + pull / friction  # integral of the tension over that angle
        arcs = ((0.112, path.wrap[0], slack + pull), (0.1775, path.wrap[1], slack))
        total = path.span * (2.0 * slack + pull) + sum(R * ((wrap - sliding) * T + slid) for R, wrap, T in arcs)
        return total / (2.0 * path.span + sum(R * wrap for R, wrap, _ in arcs))

    slack = float(brentq(lambda tension: mean(tension) - preload, 150.0, 250.0))
    return slack, slack + pull


@pytest.mark.slow
def test_a_flat_belt_as_simulated() -> None:
    """The strands' mean is 5 % above the preload: the larger pulley holds its belt at the tension of the slack one."""
    run = bd.steady_state(flat(244.86, 0.6)).dataset
    assert np.sort(run.span_tension.values[-1]) == pytest.approx(strands(244.86, 0.6), rel=0.005)
    assert strands(244.86, 0.6)[0] > 1.05 * 164.01


@pytest.mark.slow
@pytest.mark.parametrize("part", [0.9, 0.85])
def test_a_flat_belt_beyond_the_edge_of_slip(part: float) -> None:
    """It slides on the motor, which slows it until m v^2 leaves it the grip that the load requires."""
    friction = 0.33 * part
    run = bd.steady_state(flat(244.86, friction))
    data, motor = run.dataset, bd.summarize(run).pulleys[0]
    hoop = 0.0504 * data.attrs["belt_parameter"] * float(data.belt_speed[-1].mean())
    slack, tight = np.sort(data.span_tension.values[-1]) - hoop
    assert tight / slack == pytest.approx(exp(friction * motor.wrap_angle), rel=0.005)
    assert any("slides on the whole arc of motor" in one for one in run.warnings)
    assert not any("impossible" in one for one in run.warnings)


def test_an_open_flat_belt_of_a_textbook() -> None:
    """4281 and 1719 N of a preload of 3 kN without m v^2, 53.7 kW; the answer rounds the wrap angle."""
    wrap, speed = pi - 2.0 * asin(0.25 / 4.8), pi * 1.0 * 400.0 / 60.0
    ratio = capstan_ratio(0.3, wrap)
    tight = 2.0 * 3000.0 * ratio / (1.0 + ratio)
    assert (tight, 6000.0 - tight) == pytest.approx((4281.0, 1719.0), rel=2e-3)
    assert (2.0 * tight - 6000.0) * speed == pytest.approx(53.67e3, rel=2e-3)
