"""A run-up of a drive."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError, SlipError
from beltdyn.machines import FunctionLoad
from beltdyn.model import Drive
from beltdyn.results import open_run
from beltdyn.results.summary import FAILURE, VALUES
from beltdyn.transient.sweep import run_up, sweep, without_schedules
from tests.unit.model.test_carrying import conveyor


def test_the_speed_rises_linearly(drive: Drive) -> None:
    up = run_up(drive, "driver", 70.0, 600.0, 5.0)
    profile = up.pulleys[0].speed
    assert profile is not None
    np.testing.assert_allclose(profile.at([0.0, 2.5, 5.0]), [70.0, 335.0, 600.0])
    assert up.simulation.duration == 5.0
    assert (up.pulleys[1], up.belt, up.contact) == (drive.pulleys[1], drive.belt, drive.contact)


def test_what_changes_over_time_keeps_its_final_value(drive: Drive) -> None:
    first, last = drive.pulleys
    schedule = {"kind": "step", "time": 0.5, "value": 0.7}
    loads = [{"kind": "resistance", "constant": 2.0, "schedule": schedule}, {"kind": "resistance", "constant": 1.0}]
    loaded = drive.replace(pulley=[first, last.replace(torque=None, load=loads)])
    steady, held = without_schedules(loaded)
    assert [value for value in held if value.startswith("driven")] == ["driven.load[1].schedule = 0.7"]
    late, plain = steady.pulleys[1].load
    assert late.schedule is not None
    np.testing.assert_array_equal(late.schedule.at([0.0, 9.0]), 0.7)
    assert plain == loaded.pulleys[1].load[1]


def test_a_motor_runs_in_delta_and_a_function_is_named(drive: Drive) -> None:
    first, last = drive.pulleys
    motor = {
        "kind": "induction_motor",
        "rated_power": "1.5 kW",
        "rated_speed": "1430 rpm",
        "locked_rotor_ratio": 2.0,
        "breakdown_ratio": 2.5,
        "star_until": "1 s",
    }
    fan = FunctionLoad(function=lambda time, angle, speed: -1e-3 * speed * abs(speed))
    steady, held = without_schedules(drive.replace(pulley=[first, last.replace(torque=None, load=[motor, fan])]))
    delta, same = steady.pulleys[1].load
    assert "star_until" in motor.keys() - delta.arguments.keys()
    assert same == fan
    assert held[:2] == [
        "driven.load[1] without star_until",
        "driven.load[2] not held (a function of time)",
    ]


def test_a_motor_in_star_stays_there(drive: Drive) -> None:
    """At an instant before it changes to delta it has a third of its torque, as by a schedule."""
    first, last = drive.pulleys
    motor = {
        "kind": "induction_motor",
        "rated_power": "1.5 kW",
        "rated_speed": "1430 rpm",
        "locked_rotor_ratio": 2.0,
        "breakdown_ratio": 2.5,
        "star_until": "1 s",
    }
    started = drive.replace(pulley=[first, last.replace(torque=None, load=[motor])])
    for at, factor in ((0.5, 1.0 / 3.0), (1.0, 1.0)):
        steady, held = without_schedules(started, at)
        load = steady.pulleys[1].load[0]
        assert "driven.load[1] without star_until" in held
        assert (1.0 if load.factor is None else load.factor.at([9.0])[0]) == pytest.approx(factor)


def test_a_drive_without_a_prescribed_speed_cannot_be_swept(drive: Drive) -> None:
    free = drive.replace(pulley=[one.replace(speed=None, torque=None, inertia=0.1) for one in drive.pulleys])
    with pytest.raises(ModelError, match="Give it a speed in the drive file"):
        run_up(free, "driver", 1.0, 2.0, 1.0)


def test_a_sweep_is_a_run_that_names_its_pulley(drive: Drive) -> None:
    """Numbers are in SI units, texts have theirs."""
    run = sweep(drive, pulley="driver", from_="600 rpm", to=40.0 * np.pi, duration="10 ms", settling=0.02)
    assert run.kind == "run"
    assert run.dataset.attrs["swept_pulley"] == "driver"
    assert run.drive_as_given == drive.text
    assert float(run.dataset.pulley_speed.sel(pulley="driver")[-1]) == pytest.approx(40.0 * np.pi)
    assert float(run.dataset.time[-1]) == pytest.approx(0.01)
    assert not {VALUES, FAILURE} & run.dataset.attrs.keys()  # it is not compared with steady running


@pytest.mark.parametrize(("rotation", "sense"), [("counter-clockwise", 1.0), ("clockwise", -1.0)])
@pytest.mark.parametrize(("start", "rate"), [("0 rpm", 0.0), ("3 rpm clockwise", -0.1 * np.pi)])
def test_it_begins_where_the_settling_ends_or_at_standstill(
    drive: Drive, monkeypatch: pytest.MonkeyPatch, rotation: str, sense: float, start: str, rate: float
) -> None:
    """Texts tell their sense of rotation, whichever the drive counts as positive."""
    begun: dict[str, Any] = {}
    monkeypatch.setattr("beltdyn.transient.sweep.record_run", lambda *_, **options: begun.update(options))
    sweep(drive.with_({"rotation": rotation}), pulley="driver", from_=start, to="6 rpm clockwise", duration=0.1)
    assert begun["begin"] is None if rate == 0.0 else begun["begin"].speed == pytest.approx(sense * rate)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("frame", "closure"), [("travelling", 1e-3), pytest.param("staying", 5e-3, marks=pytest.mark.slow)]
)
def test_a_sweep_begins_at_its_first_speed_where_the_settling_ended(drive: Drive, frame: str, closure: float) -> None:
    """Angles go on from the settling; the account of energy begins anew.

    On 20 elements that stay it closes as well as their mesh follows the waves of a start within 2 ms.
    """
    drive = drive.replace(simulation=drive.simulation.replace(frame=frame, start="equilibrium"))
    run = sweep(drive, pulley="driver", from_=20.0, to=30.0, duration="20 ms", settling="30 ms")
    data = run.dataset
    assert float(data.pulley_speed[0, 0]) == pytest.approx(20.0)
    lead = 0.1 * 0.02
    settled = float(data.attrs["settling_time"])
    assert lead < settled <= lead + 0.03 + 2 * lead
    assert float(data.pulley_angle[0, 0]) == pytest.approx(20.0 * (settled - 0.5 * lead))
    assert float(data.pulley_angle[-1, 0] - data.pulley_angle[0, 0]) == pytest.approx(25.0 * 0.02)
    assert float(abs(data.energy_closure).max()) < closure
    assert float(data.driver_work[0]) == 0.0
    assert run.warnings[0].startswith(
        "the drive had not settled at the first speed when the run-up began: a transient of unknown size remains. It "
        "distorts the spectra at the lowest speeds. Set a settling time of 3.1 s or more"
    )


@pytest.mark.slow
def test_a_pulley_that_slips_through_ends_the_sweep_with_one_warning(drive: Drive, tmp_path: Path) -> None:
    slippery = drive.replace(contact=drive.contact.replace(friction=0.02))
    file = tmp_path / "slips.nc"
    with pytest.raises(SlipError, match=r"driver is in gross slip. Since .* rpm its whole arc has been sliding"):
        sweep(slippery, pulley="driver", from_=20.0, to=60.0, duration="1 s", settling="0.05 s", output=file)
    (warning,) = open_run(file).warnings
    assert "is in gross slip" in warning


def test_the_swept_speed_is_not_called_constant(drive: Drive) -> None:
    """Without time for ten turns of the driver nobody knows what is left of the start: a warning names it."""
    run = sweep(drive, pulley="driver", from_=20.0, to=30.0, duration="5 ms", settling="10 ms")
    assert "driver.speed" not in run.dataset.attrs["held"]
    assert "Set a settling time of 3.1 s or more" in " ".join(run.warnings)


@pytest.mark.parametrize(
    ("start", "end", "refused"),
    [(1.0, 2.0, False), (0.5, 1.0, False), (2.0, 0.0, False), (0.0, -2.0, False), (-1.0, 2.0, True), (2.0, 2.0, True)],
)
def test_speeds_of_a_run_up_differ_and_have_one_sense(drive: Drive, start: float, end: float, refused: bool) -> None:
    if refused:
        with pytest.raises(ModelError, match=rf"from {start:g} to {end:g} rad/s is not a run-up"):
            run_up(drive, "driver", start, end, 1.0)
    else:
        profile = run_up(drive, "driver", start, end, 1.0).pulleys[0].speed
        assert profile is not None
        np.testing.assert_allclose(profile.at([0.0, 1.0]), [start, end])


@pytest.mark.parametrize("driven", ["laid", "equilibrium", "steady"])
def test_a_run_up_begins_at_rest_or_laid(drive: Drive, driven: str) -> None:
    """It settles from there, whatever the drive says of its own runs."""
    begun = drive.with_({"simulation.start": driven, "simulation.frame": "travelling"})
    expected = "laid" if driven == "laid" else "equilibrium"
    assert run_up(begun, "driver", 1.0, 2.0, 1.0).simulation.start == expected


def test_times_of_a_run_up_are_above_zero(drive: Drive) -> None:
    with pytest.raises(ModelError, match=r"duration = 0 s must be above zero"):
        sweep(drive, pulley="driver", from_=1.0, to=2.0, duration=0.0)
    with pytest.raises(ModelError, match=r"settling = 0 s must be above zero"):
        sweep(drive, pulley="driver", from_=1.0, to=2.0, settling="0 s")
    with pytest.raises(ModelError, match=r"'driven' turns freely, .* Choose one of driver"):
        sweep(drive, pulley="driven", from_=1.0, to=2.0)


@pytest.mark.parametrize(("settling", "longest"), [(None, 4.0), ("0.5 s", 0.5)])
def test_a_drive_settles_behind_a_tenth_of_the_run_up(
    drive: Drive, settling: str | None, longest: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In which it reaches its speed, for as long as the run-up takes, unless it is told."""
    begun: dict[str, Any] = {}
    monkeypatch.setattr("beltdyn.transient.sweep.record_run", lambda *_, **options: begun.update(options))
    sweep(drive, pulley="driver", from_=3.0, to=9.0, duration="4 s", settling=settling)
    begin = begun["begin"]
    assert (begin.pulley, begin.speed, begin.lead, begin.longest) == (0, 3.0, pytest.approx(0.4), longest)
    assert begun["watch"] is not None
    assert begun["drive_as_given"] == drive.text


def test_quantities_that_are_held_are_named(drive: Drive, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of other pulleys, hubs and goods too, but not the speed that is swept; constants need no word."""
    begun: dict[str, Any] = {}
    monkeypatch.setattr("beltdyn.transient.sweep.record_run", lambda *_, **options: begun.update(options))
    ramp = {"kind": "ramp", "start": 0.0, "end": 1.0, "value": -0.25}
    driven = drive.with_({"pulley[driven].torque": ramp})
    sweep(driven, pulley="driver", from_=3.0, to=9.0)
    assert begun["held"] == "driven.torque = -0.25"
    sweep(drive.with_({"pulley[driven].torque": -0.25}), pulley="driver", from_=3.0, to=9.0)
    assert begun["held"] == ""


def test_goods_that_come_keep_their_final_mass() -> None:
    """Each by its number."""
    schedule = {"kind": "ramp", "start": 0.0, "end": 1.0, "value": 0.5}
    load: dict[str, Any] = {"span": ["tail", "head"], "mass_per_length": 30.0}
    goods = [load | {"start": 2.0, "end": 7.0}, load | {"start": 10.0, "end": 15.0, "schedule": schedule}]
    steady, held = without_schedules(conveyor(goods=goods))
    assert held == ["goods[2].schedule = 0.5"]
    assert steady.goods[0].schedule is None
    assert steady.goods[1].schedule is not None
    np.testing.assert_array_equal(steady.goods[1].schedule.at([0.0, 9.0]), 0.5)
