"""A drive step by step: the same motion as in one run, inputs between, and states to go back to."""

import pickle
from collections.abc import Iterator
from copy import deepcopy

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.solvers.trajectory import Chunk
from beltdyn.transient.simulate import simulate
from beltdyn.transient.simulator import Simulator, SimulatorState, _same_sizes, output_names
from tests.unit.vibration.test_small_motions import loose


@pytest.fixture(scope="module")
def short(drive: Drive) -> Drive:
    """From the belt as it is laid; the driver speeds up from the beginning."""
    speed = {"kind": "ramp", "start": 0.0, "end": 0.02, "value": 2.0}
    return drive.with_({"simulation.duration": 0.03, "pulley[driver].speed": speed})


@pytest.fixture
def simulator(short: Drive) -> Simulator:
    return Simulator(short)


@pytest.mark.slow
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


STORED = ("kinetic_energy", "strain_energy", "penalty_energy", "spring_energy", "potential_energy")
LOSSES = ("friction_loss", "damping_loss", "stretch_loss", "bending_loss", "numerical_loss")


@pytest.mark.parametrize("frame", ["travelling", "staying"])
def test_work_of_a_moved_center_is_stored_or_lost(drive: Drive, frame: str) -> None:
    """A belt at rest without friction is tightened by 0.5 mm in 20 ms; the energy account closes to 1 % of the work."""
    changes = {"simulation.frame": frame, "simulation.start": "equilibrium", "contact.friction": 0.0}
    still = {"kind": "constant", "value": 0.0}
    simulator = Simulator(drive.with_(changes | {"pulley[driver].speed": still}))
    (x, y), before = simulator.center("driven"), simulator.outputs()
    for number in range(1, 11):
        simulator.set_center("driven", (x + 0.5e-4 * number, y))
        simulator.step(number * 2e-3)
    after = simulator.outputs()
    assert simulator.center("driven") == pytest.approx((x + 0.5e-3, y), abs=1e-12)
    assert after["span_tension[driver-driven]"] > 1.05 * before["span_tension[driver-driven]"]
    work = after["driver_work"]
    loads = before["hub_load[driven]"], after["hub_load[driven]"]
    assert 0.5 * min(loads) * 0.5e-3 < work < 2.0 * max(loads) * 0.5e-3
    stored = sum(after[name] - before[name] for name in STORED)
    assert stored + sum(after[name] for name in LOSSES) == pytest.approx(work, rel=0.01)
    simulator.step(0.021)
    assert simulator.center("driven") == pytest.approx((x + 0.5e-3, y), abs=1e-12)
    assert simulator.outputs()["driver_work"] == pytest.approx(work, rel=1e-12)


def test_going_back_takes_a_moved_center_back(simulator: Simulator) -> None:
    simulator.step(0.002)
    saved, (x, y) = simulator.save(), simulator.center("driven")
    simulator.set_center("driven", (f"{1e3 * x + 0.1} mm", y))
    simulator.step(0.004)
    first = simulator.outputs()
    assert simulator.center("driven") == pytest.approx((x + 1e-4, y))
    simulator.restore(saved)
    assert simulator.center("driven") == (x, y)
    simulator.set_center("driven", (f"{1e3 * x + 0.1} mm", y))
    simulator.step(0.004)
    assert simulator.outputs() == first


def test_a_tensioner_moves_its_own_pulley_alone() -> None:
    """And a state that is restored forgets the inputs that were set for the next step."""
    centers = {"left": (0.0, 0.0), "right": (0.4, 0.0), "idler": (0.2, 0.25)}
    slide = {"kind": "sliding", "pulley": "idler", "direction": [0.0, 1.0], "mass": 0.5, "preload": 400.0, "rate": 2e4}
    belt = {"width": 0.02, "thickness": 2e-3, "axial_stiffness": 1e5, "bending_stiffness": 0.02, "mass_per_length": 0.1}
    drive = Drive(
        belt=belt | {"installed_tension": 230.0, "elements": 40},
        pulley=[{"name": name, "center": at, "radius": 0.06, "inertia": 2e-3} for name, at in centers.items()],
        tensioner=[slide],
        contact={"friction": 0.8, "stiffness": 1e8, "creep_ratio": 0.01},
        simulation={"duration": 1e-3, "frame": "travelling", "start": "laid"},
    )
    simulator = Simulator(drive)
    with pytest.raises(ModelError, match="'idler' is carried by a tensioner"):
        simulator.set_center("idler", (0.2, 0.26))
    saved = simulator.save()
    simulator.set_center("right", (0.41, 0.0))
    simulator.restore(saved)
    simulator.step(1e-5)
    assert simulator.center("right") == centers["right"]
    outputs, (x, y) = simulator.outputs(), simulator.center("idler")
    assert (x, y) == pytest.approx((0.2, 0.25 + outputs["tensioner_position[idler]"]), abs=1e-12)
    assert outputs["tensioner_position[idler]"] != 0.0


def test_what_cannot_be_set_is_told(simulator: Simulator, short: Drive) -> None:
    with pytest.raises(ModelError, match="turns freely"):
        simulator.set_speed("driven", 1.0)
    with pytest.raises(ModelError, match="has a prescribed speed"):
        simulator.set_torque("driver", 1.0)
    with pytest.raises(ModelError, match="must be in units of rad/s"):
        simulator.set_speed("driver", "1 kg")
    with pytest.raises(ModelError, match="must be a finite number"):
        simulator.set_torque("driven", float("nan"))
    with pytest.raises(ModelError, match="must be two lengths"):
        simulator.set_center("driven", (0.1, 0.0, 0.0))
    with pytest.raises(ModelError, match="must be in units of m"):
        simulator.set_center("driven", ("1 s", 0.0))
    with pytest.raises(ModelError, match="is not after the current time"):
        simulator.step(0.0)
    with pytest.raises(ModelError, match="supports only generalized_alpha"):
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


@pytest.fixture(scope="module")
def sprung() -> Drive:
    """Three pulleys of their own speeds, one of them on a slide; the belt as laid."""
    settings = {"duration": 1e-3, "frame": "travelling", "start": "laid"}
    left, right, slide = loose().pulleys
    belt = loose().belt.replace(installed_tension=None, length=1.416, elements=20)
    pulleys = [left.replace(speed=5.0), right.replace(torque=-0.5), slide]
    return loose().replace(pulley=pulleys, belt=belt, simulation=settings)


def test_outputs_are_those_of_the_state(sprung: Drive) -> None:
    """Each in its place: speeds and angles of pulleys and shafts, torques, and the place of the tensioner."""
    simulator = Simulator(sprung)
    for number in (1, 2):
        simulator.step(number * 1e-4)
    outputs, state = simulator.outputs(), simulator._integration.state
    first = simulator._integration.system.first_body
    for number, pulley in enumerate(sprung.pulleys):
        for kind in ("pulley", "shaft"):
            assert outputs[f"{kind}_speed[{pulley.name}]"] == state.velocity[first + number]
            assert outputs[f"{kind}_angle[{pulley.name}]"] == state.position[first + number]
    assert outputs["pulley_speed[left]"] == pytest.approx(5.0)
    assert outputs["pulley_angle[left]"] == pytest.approx(5.0 * 2e-4)
    assert outputs["shaft_torque[right]"] == pytest.approx(-0.5)
    assert outputs["tensioner_position[slide]"] == state.position[-1] != 0.0
    assert list(outputs) == output_names(sprung)
    tensions = [value for name, value in outputs.items() if name.startswith("span_tension")]
    assert len(set(tensions)) == 3
    assert all(0.0 < outputs[f"wrap_angle[{pulley.name}]"] < np.pi for pulley in sprung.pulleys)


def test_a_state_travels_with_inputs_that_are_under_way(sprung: Drive) -> None:
    """To a simulator of the same drive elsewhere, which goes on to the bit."""
    simulator, elsewhere = Simulator(sprung), Simulator(sprung)
    simulator.set_torque("right", 0.3)
    simulator.set_center("right", (0.4001, 0.0))
    simulator.step(1e-4)
    saved = pickle.loads(pickle.dumps(simulator.save()))
    elsewhere.set_torque("right", 9.0)  # forgotten
    elsewhere.restore(saved)
    assert elsewhere.time == 1e-4
    assert elsewhere.center("right") == pytest.approx((0.4001, 0.0))
    assert elsewhere._pulleys == simulator._pulleys
    for each in (simulator, elsewhere):
        each.step(2e-4)
    assert elsewhere.outputs() == simulator.outputs()
    assert elsewhere.outputs()["shaft_torque[right]"] == pytest.approx(0.3)


@pytest.mark.parametrize(
    "changes",
    [
        {"belt.elements": 22},
        {"pulley[right].load": [{"kind": "resistance", "constant": 1.0}], "pulley[right].harmonics": ()},
        {"pulley[left].speed": {"kind": "ramp", "start": 0.0, "end": 1.0, "value": 5.0}},
        {"simulation.frame": "staying", "simulation.start": "equilibrium"},
    ],
    ids=["elements", "loads", "speed", "mesh"],
)
def test_states_of_other_drives(sprung: Drive, changes: dict[str, object]) -> None:
    """A state with other arrays is refused; one that differs in values alone fits."""
    saved = Simulator(sprung.with_(changes)).save()
    simulator = Simulator(sprung)
    if "pulley[right].load" in changes or "pulley[left].speed" in changes:
        simulator.restore(saved)
        simulator.step(1e-4)
        return
    before = simulator.outputs()
    with pytest.raises(ModelError, match="the state belongs to another drive"):
        simulator.restore(saved)
    assert simulator.outputs() == before


def damaged(saved: SimulatorState, name: str) -> SimulatorState:
    """A state whose profiles refer to rows that are not there, or which has other arrays."""
    changed = deepcopy(saved.changed)
    profiles = changed["profiles"]
    table = profiles.table.copy()
    if name == "falls":
        table["segment"][1] = table["segment"][-1] + 1
    elif name == "begins below":
        table["segment"][0] = -1
    elif name == "ends behind":
        table["segment"][-1] += 1
    elif name == "harmonics":
        table["harmonic"][-1] += 1
    elif name == "fewer profiles":
        table = table[1:]
    elif name == "pulleys":
        changed["pulleys"] = changed["pulleys"][:-1]
    elif name == "bodies":
        changed["bodies"] = changed["bodies"][:-1]
    elif name == "tensioners":
        changed["tensioners"] = np.resize(changed["tensioners"], 4).view(np.recarray)
        changed["bodies"] = np.resize(changed["bodies"], 7).view(np.recarray)
    changed["profiles"] = profiles._replace(table=table)
    return SimulatorState(saved.integrator, changed, saved.pulleys, saved.anew, saved.moves)


def test_a_state_refers_to_rows_that_are_there(sprung: Drive) -> None:
    """What a kernel would read beyond its arrays is refused."""
    simulator = Simulator(sprung)
    saved = simulator.save()
    for name in (
        *("falls", "begins below", "ends behind", "harmonics", "fewer profiles", "pulleys", "bodies", "tensioners"),
    ):
        with pytest.raises(ModelError, match="the state belongs to another drive"):
            simulator.restore(damaged(saved, name))
        assert not _same_sizes(damaged(saved, name).changed, saved.changed), name
    simulator.restore(damaged(saved, "not at all"))
    tables = saved.changed | {"tensioners": np.zeros(saved.changed["tensioners"].size)}
    position = saved.integrator.position
    for vector, changed in ((position[:-1], {}), (position.astype("f4"), {}), (position, tables)):
        state = saved.integrator._replace(position=vector)
        with pytest.raises(ModelError, match="the state belongs to another drive"):
            simulator.restore(SimulatorState(state, changed or saved.changed, saved.pulleys, saved.anew, saved.moves))


def test_kinks_of_what_is_prescribed_are_instants_of_steps(sprung: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    """The integration begins anew at each of them, and where inputs were set."""
    ramp = {"kind": "ramp", "start": 1e-4, "end": 2e-4, "value": 6.0}
    simulator = Simulator(sprung.with_({"pulley[left].speed": ramp}))
    integration, begun = simulator._integration, list[float]()
    restart, until, stops = integration.restart, integration.until, list[float]()

    def restarted() -> None:
        begun.append(simulator.time)
        restart()

    def integrated(stop: float) -> Iterator[Chunk]:
        stops.append(stop)
        return until(stop)

    monkeypatch.setattr(integration, "restart", restarted)
    monkeypatch.setattr(integration, "until", integrated)
    simulator.step(2.5e-4)
    assert stops == [1e-4, 2e-4, 2.5e-4]
    assert begun == [0.0, 1e-4, 2e-4]
    simulator.step(3e-4)
    simulator.set_torque("right", 1.0)
    simulator.step(3.5e-4)
    assert begun == [0.0, 1e-4, 2e-4, 3e-4]
    assert simulator.outputs()["pulley_speed[left]"] == pytest.approx(6.0)


def test_a_center_moves_evenly_and_stops(sprung: Drive) -> None:
    """Also of a pulley that was moved before, and beside another one."""
    simulator = Simulator(sprung)
    simulator.set_center("right", (0.4002, 0.0))
    simulator.step(1e-4)
    simulator.step(2e-4)
    assert simulator.center("right") == pytest.approx((0.4002, 0.0), abs=1e-12)
    simulator.set_center("right", (0.4, 0.0001))
    simulator.set_center("left", (0.0, 0.0002))
    simulator.step(3e-4)
    assert simulator.center("right") == pytest.approx((0.4, 0.0001), abs=1e-12)
    assert simulator.center("left") == pytest.approx((0.0, 0.0002), abs=1e-12)
    assert simulator._moves
    simulator.step(4e-4)
    assert not simulator._moves  # the integration goes on without a new beginning
    assert simulator.center("left") == pytest.approx((0.0, 0.0002), abs=1e-12)
    assert list(simulator.outputs()) == output_names(sprung)
