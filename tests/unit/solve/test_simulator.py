"""A drive step by step: the same motion as in one run, inputs between, and states to go back to."""

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.solve import simulate
from beltdyn.solve.simulator import Simulator


@pytest.fixture(scope="module")
def short(drive: Drive) -> Drive:
    """From the belt as it is laid; the driver speeds up from the beginning."""
    speed = {"kind": "ramp", "start": 0.0, "end": 0.02, "value": 2.0}
    return drive.with_({"simulation.duration": 0.03, "pulley[driver].speed": speed})


@pytest.fixture
def simulator(short: Drive) -> Simulator:
    return Simulator(short)


def test_steps_are_those_of_a_run(short: Drive, simulator: Simulator) -> None:
    """But for where they end, to the tolerance of steps: 1e-4 of a velocity of 2 m/s over 0.03 s, some times."""
    run = simulate(short).dataset
    for time in (0.007, 0.0205, 0.03):
        simulator.step(time)
    assert simulator.time == 0.03
    outputs, last = simulator.outputs(), run.isel(time=-1)
    for name in ("driver", "driven"):
        assert outputs[f"pulley_speed[{name}]"] == pytest.approx(float(last.pulley_speed.sel(pulley=name)), rel=2e-3)
        assert outputs[f"pulley_angle[{name}]"] == pytest.approx(float(last.pulley_angle.sel(pulley=name)), rel=2e-3)
        load = float(np.hypot(*last.hub_force.sel(pulley=name)))
        assert outputs[f"hub_load[{name}]"] == pytest.approx(load, rel=0.01)
    assert outputs["span_tension[driver-driven]"] == pytest.approx(
        float(last.span_tension.sel(span="driver-driven")), rel=0.01
    )


def test_a_torque_gives_angular_momentum(simulator: Simulator) -> None:
    """A pulse of 5 N m on the driven pulley in a tenth of a millisecond: the belt has no time to answer much."""
    before = simulator.outputs()["pulley_speed[driven]"]
    simulator.set_torque("driven", "5 N m")
    simulator.step(1e-4)
    inertia = simulator.drive.pulleys[1].inertia
    assert simulator.outputs()["pulley_speed[driven]"] - before == pytest.approx(5.0 * 1e-4 / inertia, rel=0.05)


def test_a_speed_rises_linearly_and_stays(simulator: Simulator) -> None:
    simulator.step(0.005)
    begin = simulator.outputs()
    simulator.set_speed("driver", "30 rpm")
    simulator.step(0.01)
    reached = simulator.outputs()
    assert reached["pulley_speed[driver]"] == pytest.approx(np.pi)
    mean = 0.5 * (begin["pulley_speed[driver]"] + np.pi)
    turned = reached["pulley_angle[driver]"] - begin["pulley_angle[driver]"]
    assert turned == pytest.approx(0.005 * mean)
    simulator.step(0.012)
    assert simulator.outputs()["pulley_speed[driver]"] == pytest.approx(np.pi)


def test_going_back_leads_to_the_same_to_the_bit(simulator: Simulator) -> None:
    simulator.step(0.004)
    simulator.set_speed("driver", 1.0)
    simulator.step(0.006)
    saved = simulator.save()
    simulator.set_torque("driven", 1.0)
    simulator.step(0.01)
    other = simulator.outputs()
    simulator.restore(saved)
    assert simulator.time == 0.006
    simulator.set_torque("driven", 0.0)
    simulator.step(0.01)
    first = simulator.outputs()
    assert first != other
    simulator.restore(saved)
    simulator.set_torque("driven", 0.0)
    simulator.step(0.01)
    assert simulator.outputs() == first


def test_a_controller_holds_a_speed(simulator: Simulator) -> None:
    """A torque in proportion to the error brakes the driven pulley, whose belt pulls it along."""
    for number in range(1, 21):
        speed = simulator.outputs()["pulley_speed[driven]"]
        simulator.set_torque("driven", -20.0 * speed)
        simulator.step(number * 1e-3)
    held = simulator.outputs()["pulley_speed[driven]"]
    free = Simulator(simulator.drive)
    free.step(0.02)
    assert abs(held) < 0.6 * abs(free.outputs()["pulley_speed[driven]"])


def test_what_cannot_be_set_is_told(simulator: Simulator, short: Drive) -> None:
    with pytest.raises(ModelError, match="turns freely"):
        simulator.set_speed("driven", 1.0)
    with pytest.raises(ModelError, match="has a prescribed speed"):
        simulator.set_torque("driver", 1.0)
    with pytest.raises(ModelError, match="must be in units of rad/s"):
        simulator.set_speed("driver", "1 kg")
    with pytest.raises(ModelError, match="must be a finite number"):
        simulator.set_torque("driven", float("nan"))
    with pytest.raises(ModelError, match="is not after the present time"):
        simulator.step(0.0)
    with pytest.raises(ModelError, match="steps by generalized_alpha"):
        Simulator(short.with_({"simulation.integrator": "radau"}))


def test_on_the_mesh_that_stays(short: Drive) -> None:
    """From rest, with a load that is taken off."""
    simulator = Simulator(short.with_({"simulation.frame": "staying", "simulation.start": "equilibrium"}))
    simulator.set_torque("driven", -0.3)
    simulator.step(0.02)
    tight, slack = (simulator.outputs()[f"span_tension[{name}]"] for name in ("driven-driver", "driver-driven"))
    simulator.set_torque("driven", 0.0)
    simulator.step(0.03)
    assert simulator.outputs()["pulley_speed[driver]"] == pytest.approx(2.0)
    assert np.isfinite([tight, slack]).all()
