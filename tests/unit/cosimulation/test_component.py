"""A drive in the hands of a host: its clock, inputs that change and that do not, steps that fail."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from beltdyn.cosimulation.component import Component, ComponentState, Interface, choose_inputs, choose_outputs
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive
from beltdyn.results.energy_balance import LOSSES, STORED
from beltdyn.transient.simulator import Simulator, SimulatorState

SPEED, TORQUE = "pulley[driver].speed", "pulley[driven].torque"
X, Y = "pulley[driven].center[1]", "pulley[driven].center[2]"


def component_of(drive: Drive, inputs: Sequence[str] | None = None) -> Component:
    chosen = choose_inputs(drive, inputs), choose_outputs(drive, None)
    return Component(drive, Interface("Drive", "drive", 0.0, 0.03, 1e-3, 1e-4, *chosen))


@pytest.fixture
def component(short: Drive) -> Component:
    made = component_of(short)
    made.begin()
    return made


def outputs(component: Component) -> list[float]:
    return [component.get(one.name) for one in component.interface.outputs]


def test_it_steps_as_a_simulator_does(short: Drive, component: Component) -> None:
    """To the bit, on the schedule of the file while nothing is set, whenever the clock of the host begins."""
    simulator = Simulator(short)
    for number in range(3):
        component.step(100.0 + number * 0.002, 0.002)
        simulator.step((100.0 + number * 0.002 + 0.002) - 100.0)
    assert outputs(component) == list(simulator.outputs().values())
    assert component.time == pytest.approx(100.006, abs=1e-12)


def test_inputs_that_do_not_change_cost_nothing(short: Drive) -> None:
    """To set the same again is as if it had been set once: no new accelerations, no short steps."""
    once, always = component_of(short), component_of(short)
    for one in (once, always):
        one.begin()
    for number in range(4):
        for one in (once, always) if number == 0 else (always,):
            one.set(SPEED, 1.5)
            one.set(TORQUE, -0.2)
        for one in (once, always):
            one.step(number * 1e-3, 1e-3)
    assert outputs(once) == outputs(always)
    assert once.get("pulley_speed[driver]") == pytest.approx(1.5)
    assert once.get("shaft_torque[driven]") == -0.2


@pytest.mark.parametrize("set_both", [False, True])
def test_a_center_moves_as_a_simulator_moves_it(short: Drive, set_both: bool) -> None:
    """To the bit, whether both coordinates are set or one; what the host does on the belt is stored or lost."""
    still = {"pulley[driver].speed": {"kind": "constant", "value": 0.0}, "contact.friction": 0.0}
    drive = short.with_(still | {"pulley[driven].torque": None, "simulation.start": "equilibrium"})
    component, simulator = component_of(drive, [X, Y]), Simulator(drive)
    component.begin()
    (x, y), before = simulator.center("driven"), {name: component.get(name) for name in STORED}
    for number in range(10):
        component.set(X, x + 0.5e-4 * (number + 1))
        if set_both:
            component.set(Y, y)
        simulator.set_center("driven", (x + 0.5e-4 * (number + 1), y))
        component.step(number * 2e-3, 2e-3)
        simulator.step(number * 2e-3 + 2e-3)
    assert outputs(component) == list(simulator.outputs().values())
    assert simulator.center("driven") == pytest.approx((x + 0.5e-3, y), abs=1e-12)
    work = component.get("driver_work")
    stored = sum(component.get(name) - before[name] for name in STORED)
    assert stored + sum(component.get(name) for name in LOSSES) == pytest.approx(work, rel=0.01)
    assert work > 0.25e-3 * component.get("hub_load[driven]")


def test_states_go_to_another_component(short: Drive, component: Component) -> None:
    """As bytes, with inputs that wait for the next step, and the clock; what follows is the same to the bit."""
    component.step(5.0, 0.002)
    component.set(TORQUE, -0.7)
    kept = component.state().to_bytes()
    component.step(5.002, 0.003)
    other = component_of(short)
    other.restore(ComponentState.from_bytes(kept))
    assert other.time == 5.002
    other.step(5.002, 0.003)
    assert outputs(other) == outputs(component)
    other.restore(component_of(short).state())
    assert np.isnan(outputs(other)).all()


def forged(state: SimulatorState, part: str) -> SimulatorState:
    """A state of which a part has another size or type."""
    integrator: Any = state.integrator
    profiles = state.changed["profiles"]
    if part in profiles._fields:
        fewer = profiles._replace(**{part: getattr(profiles, part)[:-1]})
        return replace(state, changed=state.changed | {"profiles": fewer})
    if part in state.changed:
        return replace(state, changed=state.changed | {part: state.changed[part][:-1]})
    wrong: Any = {
        "nothing": {"changed": {}},
        "record": {"integrator": integrator[:3]},
        "position": {"integrator": integrator._replace(position=np.zeros(3))},
        "text": {"integrator": integrator._replace(velocity="fast")},
    }
    return replace(state, **wrong[part])


@pytest.mark.parametrize("part", ["pulleys", "bodies", "table", "segment", "nothing", "record", "position", "text"])
def test_forged_states_change_nothing(part: str, short: Drive, component: Component) -> None:
    """Their checksum is right, but kernels would read beyond the ends of arrays."""
    component.step(0.0, 0.002)
    state = component.state()
    assert state.simulator is not None
    data = state._replace(simulator=forged(state.simulator, part), wanted={TORQUE: 5.0}).to_bytes()
    with pytest.raises(ModelError, match="belongs to another drive"):
        component.restore(ComponentState.from_bytes(data))
    component.step(0.002, 0.001)
    undisturbed = component_of(short)
    undisturbed.begin()
    undisturbed.step(0.0, 0.002)
    undisturbed.step(0.002, 0.001)
    assert outputs(component) == outputs(undisturbed)


@pytest.mark.parametrize(
    ("time", "size", "sentence"),
    [
        (0.5, 0.001, "a step is requested from t = 0.5 s, but the drive is at t = 0.001 s"),
        (0.001, 0.0, "is not after the current time"),
        (0.001, -0.001, "is not after the current time"),
        (0.001, float("nan"), "a step is requested from"),
        (0.001, 0.5, "a step would end at t = 0.501 s, after the stop time 0.03 s"),
    ],
)
def test_wrong_steps_change_nothing(component: Component, time: float, size: float, sentence: str) -> None:
    component.stop = 0.03
    component.step(0.0, 0.001)
    before = outputs(component)
    with pytest.raises(ModelError, match=sentence):
        component.step(time, size)
    assert outputs(component) == before
    component.step(0.001, 0.029)


def test_a_step_that_cannot_go_on_changes_nothing(light: Drive) -> None:
    """With another torque it succeeds then."""
    component = component_of(light)
    component.begin()
    component.step(0.0, 0.001)
    before = outputs(component)
    component.set(TORQUE, 1e15)
    with pytest.raises(ConvergenceError, match="the simulation fails"):
        component.step(0.001, 0.001)
    assert outputs(component) == before
    component.set(TORQUE, float("nan"))
    with pytest.raises(ModelError, match="must be a finite number"):
        component.step(0.001, 0.001)
    component.set(TORQUE, -0.1)
    component.step(0.001, 0.001)
    assert component.time == 0.002


def test_before_the_beginning(short: Drive) -> None:
    component = component_of(short)
    assert np.isnan(outputs(component)).all()
    assert (component.time, component.get(SPEED), component.get(TORQUE)) == (0.0, 0.0, -0.1)
    with pytest.raises(ModelError, match="the drive is not initialized"):
        component.step(0.0, 0.001)
    component.tolerance = -1.0
    with pytest.raises(ModelError, match=r"simulation\.rtol"):
        component.begin()
