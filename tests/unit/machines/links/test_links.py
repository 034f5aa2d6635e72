"""Links of hub chains: exact derivatives, passivity, the sense of one-way clutches, capacities."""

from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import Records
from beltdyn.machines.links import link_torque, torque_of_kind
from beltdyn.machines.links.link import LinkTorque
from beltdyn.machines.profiles.functions import Profiles
from beltdyn.model import Pulley
from beltdyn.system.build_machines import machine_arrays

ENGAGE = {"kind": "step", "time": 0.5, "value": 1.0}
LINKS: dict[str, dict[str, Any]] = {
    "isolator": {"kind": "isolator", "stiffness": 30.0, "damping": 0.4},
    "one_way": {"kind": "one_way_clutch", "locking_damping": 5.0, "drag_torque": 0.3},
    "backward": {"kind": "one_way_clutch", "locking_damping": 5.0, "drag_torque": 0.3, "drives": "backward"},
    "no_drag": {"kind": "one_way_clutch", "locking_damping": 5.0},
    "clutch": {"kind": "friction_clutch", "locking_damping": 5.0, "capacity": 2.0},
    "engaging": {"kind": "friction_clutch", "locking_damping": 5.0, "capacity": 2.0, "schedule": ENGAGE},
}
NUMBER = {name: number for number, name in enumerate(LINKS)}
RATES = [-3.0, -0.41, -0.05, 0.03, 0.39, 2.0]  # none at a kink
STEP = 1e-5
FLOOR = 1e-9  # of central differences of numbers of order one


Chain = tuple[Profiles, Records]


def torque_of(chain: Chain, name: str, time: float, twist: float, rate: float) -> LinkTorque:
    profiles, links = chain
    return link_torque(profiles, links[NUMBER[name]], time, twist, rate)


@pytest.fixture(scope="module")
def chain() -> Chain:
    hub = [link | {"inertia": 0.1} for link in LINKS.values()]
    found = machine_arrays([Pulley(name="driven", center=(0, 0), radius=1, inertia=1, hub=hub)])
    return found.profiles, found.links


@pytest.mark.parametrize("name", LINKS)
@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("time", [0.2, 0.7])
def test_derivatives(chain: Chain, name: str, rate: float, time: float) -> None:
    def torque(twist: float, speed: float) -> float:
        return torque_of(chain, name, time, twist, speed)[0]

    _, by_twist, by_rate, *_ = torque_of(chain, name, time, 0.2, rate)
    numeric = (torque(0.2 + STEP, rate) - torque(0.2 - STEP, rate)) / (2 * STEP)
    assert by_twist == pytest.approx(numeric, abs=10 * FLOOR)
    numeric = (torque(0.2, rate + STEP) - torque(0.2, rate - STEP)) / (2 * STEP)
    assert by_rate == pytest.approx(numeric, abs=10 * FLOOR)


@pytest.mark.parametrize("name", LINKS)
@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("scale", [0.03, 0.6])
def test_derivative_by_the_value_of_the_schedule(chain: Chain, name: str, rate: float, scale: float) -> None:
    """What a clutch transmits as it slips follows its schedule; nothing else does."""
    link = chain[1][NUMBER[name]]
    larger, smaller = (torque_of_kind(link, scale + h, 0.2, rate).torque for h in (STEP, -STEP))
    found = torque_of_kind(link, scale, 0.2, rate).by_schedule
    assert found == pytest.approx((larger - smaller) / (2 * STEP), abs=10 * FLOOR)


@pytest.mark.parametrize("name", LINKS)
@pytest.mark.parametrize("rate", [*RATES, 0.0])
@pytest.mark.parametrize("time", [0.2, 0.7])
def test_power_goes_into_the_spring_or_is_lost(chain: Chain, name: str, rate: float, time: float) -> None:
    """What the front body gives and the back one does not take: torque times rate of twist."""
    torque, _, _, _, energy, loss = torque_of(chain, name, time, 0.2, rate)
    after, before = (torque_of(chain, name, time, 0.2 + h, rate).energy for h in (STEP, -STEP))
    stored = (after - before) / (2 * STEP) * rate
    assert loss >= 0.0
    assert energy >= 0.0
    assert torque * rate == pytest.approx(stored + loss, abs=100 * FLOOR)


@pytest.mark.parametrize("rate", [*RATES, 0.0])
def test_only_a_spring_stores_energy(chain: Chain, rate: float) -> None:
    """k twist^2 / 2, whatever the rate; clutches have no spring."""
    energies = {name: torque_of(chain, name, 0.7, 0.2, rate).energy for name in LINKS}
    assert energies.pop("isolator") == pytest.approx(0.5 * 30.0 * 0.2**2, rel=1e-15)
    assert set(energies.values()) == {0.0}


@pytest.mark.parametrize(("name", "sense"), [("one_way", 1.0), ("backward", -1.0), ("no_drag", 1.0)])
def test_a_one_way_clutch_drives_in_one_sense_only(chain: Chain, name: str, sense: float) -> None:
    torques = np.array([torque_of(chain, name, 0.0, 0.0, sense * rate)[0] for rate in (-9, -0.1, 0.2)])
    drag = 0.0 if name == "no_drag" else 0.3
    assert sense * torques == pytest.approx([-drag, -drag, 1.0])


def test_a_friction_clutch_slips_at_its_capacity(chain: Chain) -> None:
    torques = [torque_of(chain, "clutch", 0.0, 0.0, rate)[0] for rate in (-9.0, -0.2, 0.3, 0.5)]
    assert torques == pytest.approx([-2.0, -1.0, 1.5, 2.0])


def test_a_friction_clutch_engages(chain: Chain) -> None:
    torques = [torque_of(chain, "engaging", time, 0.0, 9.0)[0] for time in (0.5, 0.6)]
    assert torques == [0.0, 2.0]


@pytest.mark.parametrize(("rate", "sign"), [(0.2, 0.0), (0.41, 1.0), (-0.41, -1.0)])
def test_the_schedule_of_a_friction_clutch_acts_while_it_slips(chain: Chain, rate: float, sign: float) -> None:
    """By its capacity of 2 N m in the sense of the torque; a clutch that sticks does not feel it."""
    assert torque_of(chain, "clutch", 0.0, 0.0, rate).by_schedule == 2.0 * sign
