"""Audits of a run made by formulas: each speaks where it is violated, with its numbers, and is silent otherwise."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import is_internal
from beltdyn.model import Drive, loads
from beltdyn.results import Run, summarize
from beltdyn.results.checks import CHECKS
from beltdyn.results.checks.mesh import COARSE_SETTINGS, STEADY_LOSSES, STEADY_SLIPS, unresolved_by_mesh
from beltdyn.results.checks.power import unbalanced_powers
from beltdyn.results.energy_balance import LOSSES

MakeRun = Callable[..., Run]
TURN = 0.3


@pytest.fixture(autouse=True)
def _some_are_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """The mesh of 20 elements is judged in test_resolution.py; losses are made up, and do not balance."""
    others = tuple(check for check in CHECKS if check not in (unresolved_by_mesh, unbalanced_powers))
    monkeypatch.setattr("beltdyn.results.checks.CHECKS", others)


@pytest.fixture
def turning(make_run: MakeRun, run: Run) -> Callable[..., Run]:
    """A run of the drive, or of one like it, whose belt goes round in 0.3 s."""

    def make(drive: Drive = run.drive, **changed: Any) -> Run:
        speed = np.full((101, 2), drive.belt_length / TURN)
        return Run(make_run(**({"belt_speed": speed} | changed)).dataset, drive)

    return make


def with_slip(run: Run, slip: float) -> dict[str, np.ndarray]:
    """Angles and speeds of the pulleys at a slip of the driven one."""
    loss = np.array([1.0, 1.0 - slip])
    return {
        name: run.dataset[name].values[:, :1] * loss
        for name in ("pulley_angle", "pulley_speed", "shaft_speed", "shaft_angle")
    }


def said(run: Run, words: str) -> list[str]:
    return [warning for warning in run.warnings if words in warning]


def test_every_check_is_silent_on_a_sound_run(make_run: MakeRun, turning: Callable[..., Run]) -> None:
    """Elastic creep is 0.294 % of the 0.5 % slip."""
    assert make_run().warnings == []
    assert turning().warnings == []
    assert len(CHECKS) == len(set(CHECKS))


def test_a_run_too_short_for_slip_says_so(turning: Callable[..., Run], run: Run) -> None:
    """While means are taken the rim moves less than the belt stretches; a drive that comes to rest has no slip."""
    names = ("pulley_angle", "pulley_speed", "shaft_speed", "shaft_angle")
    short = turning(**{name: 1e-4 * run.dataset[name].values for name in names})
    assert np.isnan(summarize(short).pulleys[1].slip)
    assert len(said(short, "too short for slip: while means are taken the rim of driver moves")) == 1
    lost = run.dataset["span_tension"].values * [1.0, np.nan]
    half = turning(**{name: 1e-4 * run.dataset[name].values for name in names}, span_tension=lost)
    assert said(half, "too short for slip")
    assert "nan" not in " ".join(half.warnings)
    left = turning(**{name: 1e-4 * run.dataset[name].values for name in names}, span_tension=np.nan * lost)
    assert said(left, "slip has no value: while means are taken the belt has left a pulley of each span")
    ends = run.dataset["time"].values < 0.5 * float(run.dataset["time"][-1])
    stopping = {name: np.where(ends[:, None], 1.0, 1e-4) * run.dataset[name].values for name in names[1:3]}
    angles = {name: np.minimum(run.dataset[name].values, run.dataset[name].values[ends][-1]) for name in names[::3]}
    assert not said(turning(**stopping, **angles), "too short for slip")


def test_siblings_are_one_finding(turning: Callable[..., Run], run: Run) -> None:
    """Whatever is wrong with several pulleys or spans is said once, with all of their names."""
    dataset = run.dataset
    slack = turning(span_tension=np.full((101, 2), -1.0)).findings
    assert [finding.fault for finding in slack if "slack" in finding.fault] == [
        "the belt goes slack (tension zero or negative): driver-driven to -1 N at t = 0 s and "
        "driven-driver to -1 N at t = 0 s."
    ]
    lifted = said(turning(wrap_angle=np.zeros((101, 2))), "lifts off")
    assert [text.split(".")[0] for text in lifted] == ["the belt lifts off driver at t = 0 s and driven at t = 0 s"]
    sliding = said(turning(slip_velocity=np.full_like(dataset["slip_velocity"].values, 0.4)), "gross slip:")
    assert [text.split(",")[0] for text in sliding] == [
        "gross slip: the belt slides on the whole arc of driver and driven"
    ]


def test_a_belt_that_its_speed_lifts_off(turning: Callable[..., Run], run: Run) -> None:
    """m v^2 of 94 % of the tension leaves something to press with, and of 96 % next to nothing."""
    belt, tension = run.drive.belt, run.dataset["span_tension"].values
    limit = np.sqrt(tension.mean(axis=1, keepdims=True) / belt.mass_per_length) * np.ones(2)
    assert not said(turning(belt_speed=np.sqrt(0.94) * limit), "lifts the belt off")
    (warning,) = said(turning(belt_speed=np.sqrt(0.97) * limit), "lifts the belt off")
    assert warning.startswith("centrifugal force lifts the belt off driver at t = 0 s and driven at t = 0 s: at ")


def test_driven_pulley_faster_than_its_driver(turning: Callable[..., Run], run: Run) -> None:
    """The slip of -0.185 % falls short of the elastic creep of 0.294 % by 0.48 % of the speed."""
    (finding,) = turning(**with_slip(run, -0.00185)).findings
    assert finding.fault == "driven runs 0.185% faster than its driver driver, which is physically impossible."
    assert "wrong by at least 0.48% of the speed" in finding.spoils
    assert finding.remedy == "The mesh is too coarse: set belt.elements = 40 and compare."


def test_powers_that_do_not_balance(turning: Callable[..., Run], run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    """A torque of the driver that is met at its crests: 3 % too high where the energy account closes."""
    monkeypatch.setattr("beltdyn.results.checks.CHECKS", (unbalanced_powers,))
    balance = summarize(turning()).balance
    torque = run.dataset["shaft_torque"].values.copy()
    spent = balance.power_out + balance.lost + balance.stored
    torque[:, 0] *= spent / balance.power_in
    assert turning(shaft_torque=torque).warnings == []
    torque[:, 0] *= 1.03
    (warning,) = turning(shaft_torque=torque).warnings
    assert "(2.9%) of " in warning
    assert "because a torque ripple is in step with the outputs" in warning
    assert warning.endswith("Set simulation.output_interval = 0.0007.")


def test_less_slip_than_elastic_creep(turning: Callable[..., Run], run: Run) -> None:
    (warning,) = turning(**with_slip(run, 0.001)).warnings
    assert warning.startswith("the slip of driven behind driver is 0.100%, less than its elastic creep of 0.294%")
    assert not said(turning(**with_slip(run, 0.0026)), "less than its elastic creep")


def test_the_driver_need_not_come_first(turning: Callable[..., Run], run: Run) -> None:
    """Torques reversed, the second pulley drives: it must be the faster one, here by 0.5 %."""
    dataset = run.dataset
    changed = {name: -dataset[name].values for name in ("shaft_torque", "pulley_torque")}
    changed |= {"span_tension": dataset["span_tension"].values[:, ::-1]}
    assert said(turning(**changed), "driver runs 0.503% faster than its driver driven")
    assert not said(turning(**changed, **with_slip(run, -0.005)), "faster")


LAW = 'friction_law = "force_slope"\ncreep_rate_factor = 1e5'
LEAVE_OUT = "omit contact.friction_law and contact."


@pytest.mark.parametrize(
    ("change", "remedy"),
    [
        (LAW, f"{LEAVE_OUT}creep_rate_factor:"),
        ('friction_law = "coefficient_slope"\ncreep_velocity = 0.1', f"{LEAVE_OUT}creep_velocity:"),
        ("creep_ratio = 0.05", "reduce contact.creep_ratio from 5.0e-02 to 5e-03"),
    ],
)
def test_slip_of_the_friction_law(
    turning: Callable[..., Run], run: Run, drive_text: str, change: str, remedy: str
) -> None:
    """Of a slip of 20 % stretch makes 0.29 %, bending takes 0.02 %, and the slope makes the rest."""
    assert LAW in drive_text
    drive = loads(drive_text.replace(LAW, change))
    (finding,) = turning(drive, **with_slip(run, 0.2)).findings
    assert finding.fault.endswith("causes more slip than elastic creep, 19.73% of 20.00% on driven.")
    assert "friction losses by about 5.8 W" in finding.spoils  # of 29.25 W put in
    assert remedy in finding.remedy


def test_slip_of_the_friction_law_within_a_part_of_a_turn(make_run: MakeRun, run: Run) -> None:
    """At a constant tension no slip is stretch; 2 % of 98 mm may be where a tension rises by 17 N, and 20 % are not.

    With EA = 10 kN a belt of 1.27 m gets longer by 2.2 mm.
    """
    assert said(make_run(**with_slip(run, 0.02)), "builds up too slowly")
    rising = run.dataset["span_tension"].values + np.linspace(0.0, 170.0, 101)[:, None]
    assert said(make_run(span_tension=rising, **with_slip(run, 0.2)), "builds up too slowly")
    assert not said(make_run(span_tension=rising, **with_slip(run, 0.02)), "builds up too slowly")


def test_load_that_drives(turning: Callable[..., Run], run: Run) -> None:
    torque = run.dataset["shaft_torque"].values * np.array([1.0, -1.0])
    (warning,) = said(turning(shaft_torque=torque), "drives")
    assert warning.startswith(
        "a load drives the belt because its torque has the sign of its speed: driven, 2.438 N m at 114 rpm, 29.1 W."
    )
    assert "a load is negative on a shaft that turns counter-clockwise" in warning


def test_a_drive_by_torques_alone_has_no_load_that_drives(
    turning: Callable[..., Run], run: Run, drive_text: str
) -> None:
    speed = 'speed = { kind = "ramp", start = 0.05, end = 0.6, value = 12.0 }'
    assert speed in drive_text
    motor = 'inertia = 0.1\ntorque = { kind = "constant", value = 2.0 }'
    torque = run.dataset["shaft_torque"].values
    assert not said(turning(loads(drive_text.replace(speed, motor)), shaft_torque=torque), "drives")


def test_vibrations_that_grow_are_said_to_take_the_power_of_contact_damping(
    turning: Callable[..., Run], run: Run
) -> None:
    """Their growth is below the limit where they are large already; to lower the damping would make them worse."""
    angle = run.dataset["pulley_angle"].values[:, 0]
    damped = turning(damping_loss=0.4 * angle)
    fluttering = Run(damped.dataset.assign_attrs(flutter_growth=2.8, flutter_frequency=1577.0), damped.drive)
    (finding,) = fluttering.findings
    assert finding.fault.startswith("the belt flutters where it slides")
    assert "dissipate 16.4% of the power" in finding.fault
    assert finding.remedy == "Increase contact.damping from 10 to 1e+03 N s/m^2, half of critical."


def test_power_of_a_damping_beyond_half_of_critical_is_not_laid_to_vibrations(
    turning: Callable[..., Run], run: Run
) -> None:
    """Any growth, such as that of a start, would hide it; and more damping would not steady anything."""
    damped = turning(damping_loss=0.4 * run.dataset["pulley_angle"].values[:, 0])
    drive = damped.drive.replace(contact=damped.drive.contact.arguments | {"damping": 1e5})
    started = Run(damped.dataset.assign_attrs(flutter_growth=2.9e-4, flutter_frequency=1216.0), drive)
    (finding,) = started.findings
    assert finding.fault.startswith("contact damping dissipates")


def test_contact_damping_that_takes_power(turning: Callable[..., Run], run: Run) -> None:
    """Of 29.25 W put in 12 * 0.4 = 4.8 W, 16.4 %: a hundred and sixty times what the remedy leaves."""
    angle = run.dataset["pulley_angle"].values[:, 0]
    (finding,) = turning(damping_loss=0.4 * angle).findings
    assert finding.fault.startswith("contact damping dissipates 4.8 W, 16.4% of the power input")
    assert finding.spoils == "Without it the efficiency would be 96.42% instead of 83.19%."
    assert finding.remedy == "Reduce contact.damping from 10 to 0.06 N s/m^2 or less."


@pytest.mark.parametrize("name", ["friction_loss", "damping_loss", "bending_loss", "coupling_loss"])
def test_negative_losses(turning: Callable[..., Run], run: Run, name: str) -> None:
    angle = run.dataset["pulley_angle"].values[:, 0]
    (warning,) = said(turning(**{name: -0.05 * angle}), "loss is negative")
    assert "loss is negative (numerical error): -0.6 W in " in warning
    assert ("moment_arm" in warning) == (name == "friction_loss")


def test_belt_that_sinks_in_too_far(make_run: MakeRun, run: Run) -> None:
    """In the end by 6 mm, of 81 mm of radius and 10 mm of belt; the places of the made run lie on the rims."""
    dataset, center = run.dataset, np.array(run.drive.pulleys[1].center)
    place, on = dataset["contact_position"].values, dataset["contact_pulley"].values == 1
    part = 0.006 / 0.08125 * np.linspace(0.0, 1.0, 101)[:, None, None]
    sunk = np.where(on[..., None], center + (1.0 - part) * (place - center), place)
    (warning,) = said(make_run(contact_position=sunk), "sinks")
    assert warning.startswith("the belt sinks 6 mm into driven at t = 1 s (7.4% of its radius, 60% of the belt's")
    assert warning.endswith("Increase contact.stiffness from 1e+07 N/m^2 to 1.2e+07.")


def test_belt_that_stretches_too_far(make_run: MakeRun) -> None:
    """EA is 10 kN: 900 N are 8 % by Green's law, and 300 N 2.9 %."""
    tension = np.full((101, 2), 300.0)
    assert not said(make_run(span_tension=tension), "stretched")
    tension[40, 1] = 900.0
    (warning,) = said(make_run(span_tension=tension), "stretched")
    assert warning.startswith("the span driven-driver at t = 0.4 s is stretched by 8.0%, more than the 5%")


def test_belt_that_stretches_beyond_its_measured_curve(turning: Callable[..., Run], drive: Drive) -> None:
    """300 N are 3 % on the straight line by which the curve goes on."""
    curve = {"strains": [0.02], "tensions": [200.0]}
    curved = drive.replace(belt=drive.belt.replace(stretch_curve=curve))
    (warning,) = said(turning(curved, span_tension=np.full((101, 2), 300.0)), "stretch_curve ends")
    assert "is stretched by 3.00%, but belt.stretch_curve ends at 2.00%" in warning
    assert not said(turning(curved, span_tension=np.full((101, 2), 190.0)), "stretch_curve ends")


def test_noise_is_no_slip_and_no_slip_safety(make_run: MakeRun, run: Run) -> None:
    """A drive at rest, but for rounding: the belt would go as far as it is stretched in a million years."""
    noise = np.random.default_rng(5).normal(scale=1e-16, size=(101, 2))
    still = {"pulley_speed": noise, "pulley_angle": np.cumsum(noise, axis=0), "belt_speed": noise}
    still |= {"span_tension": 30.0 + 1e3 * noise, "shaft_speed": noise}
    still |= {name: np.zeros(101) for name in ("friction_loss", "damping_loss", "driver_work", "torque_work")}
    made = make_run(**still)
    summary = summarize(made)
    assert all(np.isnan([one.slip, one.elastic_creep, one.slip_safety]).all() for one in summary.pulleys)
    assert made.warnings == []


def test_losses_of_milliwatts_are_not_told_of(turning: Callable[..., Run], run: Run) -> None:
    """4.8 mW are much of what an idle drive is given, and nothing beside the 150 W that its belt could carry."""
    angle, idle = run.dataset["pulley_angle"].values[:, 0], 1e-3
    torques = {name: idle * run.dataset[name].values for name in ("shaft_torque", "pulley_torque")}
    assert not said(turning(**torques, damping_loss=0.4e-3 * angle), "contact damping dissipates")
    assert not said(turning(**torques, friction_loss=-0.05e-3 * angle), "loss is negative")
    assert said(turning(damping_loss=0.4 * angle), "contact damping dissipates 4.8 W")


def test_a_span_beyond_the_tension_of_its_belt(turning: Callable[..., Run], run: Run) -> None:
    rated = run.drive.with_({"belt.largest_tension": 100.0})
    tension = run.dataset["span_tension"].values.copy()
    assert not said(turning(rated, span_tension=tension), "is rated for")
    tension[40, 0] = 120.0
    (text,) = said(turning(rated, span_tension=tension), "is rated for 100 N")
    assert text.startswith("the span driver-driven carries 120 N at t = ")
    assert "1.2 times as wide" in text


def test_losses_and_slip_off_those_of_steady_running(turning: Callable[..., Run]) -> None:
    """Losses of the run are 3 % more in friction, and its slip is a tenth less; less than a percent is not said."""

    def beside(losses: float, slip: float) -> Run:
        run = turning()
        found = summarize(run)
        steady = {cause: abs(power) + 1.0 for cause, power in found.balance.losses.items()}
        parts = {name: steady[cause] for name, cause in LOSSES.items()}
        lost = sum(steady.values())
        window = run.dataset["time"].values
        for name, power in parts.items():
            run.dataset[name][:] = window * (power + (losses * lost if name == "friction_loss" else 0.0))
        run.dataset.attrs |= {
            STEADY_LOSSES: list(parts.values()),
            STEADY_SLIPS: [0.0, found.pulleys[1].slip / (1.0 + slip)],
            COARSE_SETTINGS: "simulation.rtol = 0.01",
        }
        return Run(run.dataset, run.drive)

    assert said(beside(0.009, 0.01), "steady running") == []
    (warning,) = said(beside(0.012, 0.01), "steady running")
    assert "losses are off by +1.2%" in warning
    (warning,) = said(beside(0.03, -0.1), "steady running")
    assert "losses are off by +3.0% (friction +3.0% of the losses)" in warning
    assert "the slip of driven is off by -10.0% of the largest slip" in warning
    assert "Omit simulation.rtol = 0.01" in warning


@pytest.mark.provokes_internal_errors
def test_a_check_with_a_fault_leaves_the_others(turning: Callable[..., Run], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("beltdyn.results.checks.creep.SHORTEST", None)
    names = ("pulley_angle", "pulley_speed", "shaft_speed", "shaft_angle")
    run = turning()
    short = turning(**{name: 1e-4 * run.dataset[name].values for name in names})
    (told,) = (one for one in short.findings if one.kind == "unknown_slip")
    assert is_internal(str(told))
    assert "internal error in results/checks/creep.py:" in told.fault
    assert len(short.findings) > 1
