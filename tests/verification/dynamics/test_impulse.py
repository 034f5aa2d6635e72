"""What is prescribed acts whatever the step: impulses against momenta in closed form, for every kind of excitation.

A pulley far from the belt, with 0.1 m and 0.4 kg m^2, of which everything is known.  Local errors of 0.01 m/s are
allowed, and steps grow to tenths of a second unless something shortens them.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

from beltdyn import simulate
from beltdyn.model import Drive
from beltdyn.solvers.standard import StandardIntegrator
from beltdyn.system.arrays import DRIVER_WORK, POWERS

INERTIA, RTOL = 0.4, 1e-3
ALLOWED = RTOL * 10.0 / 0.1
"""Speed that the tolerance allows to be wrong, rad/s."""
WIDTHS = [1e-4, 1e-3, 1e-2, 0.1, 1.0]
ROUNDING = 1e-8
"""Shortest pulses of some thousand segments are sums of large numbers."""
TORQUE_WORK, COUPLING_LOSS = POWERS.index("torque_work"), POWERS.index("coupling_loss")


Follow = Callable[..., Any]
Measured = Callable[..., None]


def pulse(width: float, number: int, height: float) -> dict[str, Any]:
    """A triangle anywhere between two outputs."""
    start = float(np.random.default_rng(number).uniform(0.0, 2.0 - width))
    return {"kind": "table", "times": [start, start + 0.3 * width, start + width], "values": [0.0, height, 0.0]}


@pytest.mark.parametrize("impulse", [0.4, 40.0, -4000.0])
@pytest.mark.parametrize("width", WIDTHS)
def test_pulse_of_a_torque(follow: Follow, measured: Measured, width: float, impulse: float) -> None:
    """The momentum is the impulse, and the work is the kinetic energy."""
    for number in range(3):
        end = follow(torque=pulse(width, number, 2.0 * impulse / width))
        energy = 0.5 * INERTIA * end.speeds[0] ** 2
        measured(
            momentum=INERTIA * end.speeds[0] / impulse - 1, work=end.work[TORQUE_WORK] / energy - 1, steps=end.steps
        )
        assert INERTIA * end.speeds[0] == pytest.approx(impulse, rel=ROUNDING)
        assert end.work[TORQUE_WORK] == pytest.approx(0.5 * INERTIA * end.speeds[0] ** 2, rel=1e-3)
        assert end.steps < 1000


@pytest.mark.parametrize("share", [0.02, 0.2, 0.9])
@pytest.mark.parametrize("height", [1.0, 1e3])
def test_pulses_in_step_with_the_outputs(follow: Follow, measured: Measured, share: float, height: float) -> None:
    """What steps miss of one pulse would add up with a thousand that all come at the same instant of an output."""
    begin = 0.3e-3 + 2e-3 * np.arange(999)
    times = (begin[:, None] + share * 2e-3 * np.array([0.0, 0.5, 1.0])).ravel()
    end = follow(torque={"kind": "table", "times": list(times), "values": [0.0, height, 0.0] * 999})
    impulse = 999 * 0.5 * height * share * 2e-3
    measured(momentum=INERTIA * end.speeds[0] / impulse - 1, steps=end.steps)
    assert INERTIA * end.speeds[0] == pytest.approx(impulse, rel=ROUNDING)
    assert end.work[TORQUE_WORK] == pytest.approx(0.5 * INERTIA * end.speeds[0] ** 2, rel=1e-4)


@pytest.mark.slow
def test_a_measured_signal_of_100_000_points_is_quick(follow: Follow) -> None:
    """Noise that the tolerance need not follow costs no steps, and its impulse is exact."""
    times = np.linspace(0.0, 2.0, 100_001)
    values = np.random.default_rng(0).normal(0.5, 1.0, times.size)
    end = follow(torque={"kind": "table", "times": list(times), "values": list(values)})
    assert INERTIA * end.speeds[0] == pytest.approx(float(np.trapezoid(values, times)), rel=ROUNDING)
    assert end.steps < 1000


@pytest.mark.parametrize("width", WIDTHS)
def test_pulse_of_a_schedule(follow: Follow, width: float) -> None:
    """A load of dry friction, switched on by a pulse while the pulley turns at 100 rad/s."""
    load = {"kind": "resistance", "constant": 20.0, "schedule": pulse(width, 1, 1.0)}
    end = follow((100.0,), load=[load])
    assert INERTIA * (100.0 - end.speeds[0]) == pytest.approx(20.0 * 0.5 * width, rel=ROUNDING)
    assert -end.work[TORQUE_WORK] == pytest.approx(0.5 * INERTIA * (100.0**2 - end.speeds[0] ** 2), rel=1e-3)


@pytest.mark.parametrize("width", WIDTHS[:-1])
def test_pulse_of_a_clutch(follow: Follow, width: float) -> None:
    """It takes momentum from the rim to the body behind, and loses the rest of the energy."""
    clutch = {"kind": "friction_clutch", "capacity": 20.0, "locking_damping": 5.0, "inertia": 0.1}
    end = follow((100.0, 0.0), hub=[clutch | {"schedule": pulse(width, 2, 1.0)}])
    assert INERTIA * (100.0 - end.speeds[0]) == pytest.approx(20.0 * 0.5 * width, rel=1e-6)
    assert 0.1 * end.speeds[1] == pytest.approx(20.0 * 0.5 * width, rel=1e-6)
    lost = 0.5 * INERTIA * (100.0**2 - end.speeds[0] ** 2) - 0.5 * 0.1 * end.speeds[1] ** 2
    assert end.work[COUPLING_LOSS] == pytest.approx(lost, rel=1e-2)


@pytest.mark.parametrize("turns", [10.0, 100.0, 333.3])
def test_wave_of_a_load_over_the_angle(follow: Follow, turns: float) -> None:
    """The work over the angle is the kinetic energy, also with whole turns between outputs."""
    torque, order, amplitude, start = 2.0, 3.0, 0.8, 2.0 * np.pi * turns
    load = {"kind": "table", "speeds": [-1e4, 1e4], "torques": [torque, torque]}
    end = follow((start,), load=[load | {"harmonics": [{"order": order, "amplitude": amplitude, "phase": 0.4}]}])
    swing = np.sin(order * end.angles[0] + 0.4) - np.sin(0.4)
    work = torque * (end.angles[0] + amplitude / order * swing)
    speed = np.sqrt(start**2 + 2.0 * work / INERTIA)
    assert end.speeds[0] == pytest.approx(speed, abs=ALLOWED)
    assert end.speeds[0] > start + 5.0
    assert end.work[TORQUE_WORK] == pytest.approx(work, rel=2e-3)


@pytest.mark.parametrize("spike", [400.0, -0.95 * 40.0])
def test_spike_of_a_torque_over_the_speed(follow: Follow, spike: float) -> None:
    """Crossed within a few steps: the time for each piece of the speed is known."""
    base, low, width = 40.0, 50.0, 2.0
    load = {"kind": "table", "torques": [0.0, spike, spike, 0.0]}
    load["speeds"] = [low, low + 1e-6, low + width, low + width + 1e-6]
    end = follow(torque={"kind": "constant", "value": base}, load=[load])
    left = 2.0 - INERTIA * low / base - INERTIA * width / (base + spike)
    assert end.speeds[0] == pytest.approx(low + width + base / INERTIA * left, abs=ALLOWED)
    assert abs(end.speeds[0] - base / INERTIA * 2.0) > 10 * ALLOWED


def damped(speed: dict[str, Any], **keys: Any) -> dict[str, Any]:
    """A shaft of prescribed speed that drags the rim along by a damper of 0.4 N m s/rad."""
    damper = {"kind": "isolator", "stiffness": 1e-9, "damping": INERTIA, "inertia": 0.3}
    return {"speed": speed, "hub": [damper]} | keys


@pytest.mark.parametrize("width", WIDTHS[:-1])
def test_pulse_of_a_speed(follow: Follow, width: float) -> None:
    """The rim answers the angle of the pulse, with a time constant of 1 s; the driver's work is stored or lost."""
    height = 20.0 / width
    table = pulse(width, 3, height)
    end = follow((0.0, 0.0), **damped(table))
    rise, fall = (np.diff(table["values"]) / np.diff(table["times"])).tolist()
    bends = zip(table["times"], (rise, fall - rise, -fall), strict=True)
    speed = sum(bend * (2.0 - time - 1.0 + np.exp(time - 2.0)) for time, bend in bends)
    assert end.speeds[0] == pytest.approx(float(speed), abs=ALLOWED)
    assert end.angles[1] == pytest.approx(0.5 * width * height)
    gained = 0.5 * INERTIA * end.speeds[0] ** 2
    assert end.work[DRIVER_WORK] - end.work[COUPLING_LOSS] == pytest.approx(gained, abs=0.01 * end.work[DRIVER_WORK])


@pytest.mark.parametrize("rate", [100.0, 200.0])
def test_harmonics_of_a_speed_in_step_with_the_outputs(follow: Follow, rate: float) -> None:
    """Seen at the outputs alone, the speed would be the largest of its wave."""
    mean = 2.0 * np.pi * rate
    end = follow(
        (0.0, mean), **damped({"kind": "constant", "value": mean}, harmonics=[{"order": 1.0, "amplitude": 0.2}])
    )
    assert end.speeds[0] == pytest.approx(mean * (1.0 - np.exp(-2.0)), abs=ALLOWED)


def test_work_where_a_prescribed_speed_bends_and_jumps(follow: Follow) -> None:
    """The driver of a body alone does what its kinetic energy changes by."""
    zigzag = {"kind": "table", "times": [0.1003, 0.2111, 0.7123], "values": [0.0, 30.0, -12.0]}
    assert follow((0.0,), speed=zigzag).work[DRIVER_WORK] == pytest.approx(0.5 * INERTIA * 12.0**2, rel=1e-9)
    jump = {"kind": "step", "time": 0.7003, "before": 5.0, "value": 30.0}
    for integrator in (None, StandardIntegrator("bdf", RTOL)):
        end = follow((0.0,), integrator, speed=jump)
        assert end.work[DRIVER_WORK] == pytest.approx(0.5 * INERTIA * 30.0**2, rel=1e-9)


@pytest.mark.parametrize("name", ["cvode", "ida", "bdf", "radau"])
@pytest.mark.parametrize("width", [1e-4, 1e-2])
def test_standard_integrators_see_pulses(follow: Follow, name: Any, width: float) -> None:
    if name in ("cvode", "ida"):
        pytest.importorskip("sksundae")
    integrator = StandardIntegrator(name, RTOL)
    torque = follow((0.0,), integrator, torque=pulse(width, 4, 2.0 * 40.0 / width))
    assert torque.speeds[0] == pytest.approx(40.0 / INERTIA, abs=ALLOWED)
    speed = follow((0.0, 0.0), integrator, **damped(pulse(width, 4, 20.0 / width)))
    exact = follow((0.0, 0.0), **damped(pulse(width, 4, 20.0 / width)))
    assert speed.speeds[0] == pytest.approx(exact.speeds[0], abs=ALLOWED)


@pytest.fixture(scope="module")
def quiet(drive: Drive) -> xr.Dataset:
    """A run without a pulse."""
    return _run(drive, {"kind": "constant", "value": 0.0})


@pytest.mark.slow
@pytest.mark.parametrize("place", [0.9002, 0.9005])
@pytest.mark.parametrize(
    ("width", "height"), [(1e-4, 400.0), (5e-4, 400.0), pytest.param(2e-3, 100.0, marks=pytest.mark.slow)]
)
def test_pulse_of_a_load_on_a_running_drive(
    drive: Drive, quiet: xr.Dataset, measured: Measured, width: float, height: float, place: float
) -> None:
    """Within the pulse the belt takes up to a hundredth of its impulse: it swings at 9 Hz, and creeps."""
    table = {"kind": "table", "times": [place, place + 0.5 * width, place + width], "values": [0.0, -height, 0.0]}
    struck = _run(drive, table)
    loss = 0.5 * width * height / drive.pulleys[1].inertia
    after = float(np.ceil(1e3 * (place + width)) / 1e3)
    change = struck.pulley_speed[:, 1].sel(time=after) - quiet.pulley_speed[:, 1].sel(time=after)
    work = 0.5 * width * height * (float(quiet.pulley_speed[:, 1].sel(time=0.9)) - 0.5 * loss)
    closure = float(np.abs(struck.energy_closure).max() - np.abs(quiet.energy_closure).max())
    measured(change=float(change) / loss + 1, work=float(struck.torque_work[-1]) / work + 1, closure=closure)
    assert float(change) == pytest.approx(-loss, rel=0.012)
    assert float(struck.torque_work[-1]) == pytest.approx(-work, rel=2e-3)
    assert closure < 1e-4
    assert struck.attrs["steps"] < 1.1 * quiet.attrs["steps"]


def _run(drive: Drive, torque: dict[str, Any]) -> xr.Dataset:
    """The example drive with a torque on its driven pulley, in steps of up to a millisecond."""
    data = drive.model_dump(by_alias=True, exclude_none=True)
    data["pulley"][1]["torque"] = torque
    data["simulation"]["duration"] = 0.92
    return simulate(Drive(**data)).dataset
