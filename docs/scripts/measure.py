"""Measure the tables of docs/deviations.md and docs/tutorial.md again: `python docs/scripts/measure.py [NAME...]`.

Without a name all are measured, one after another, in about five minutes; `--list` names them.  Each is printed
as a table in Markdown.  Computing times are those of this machine, and counts of steps vary by a few per cent between
machines.
"""

import argparse
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from importlib.resources import files
from typing import Any

import numpy as np
from random_drives import SEEDS, Judged, judge

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.model import ERROR_LIMITS, layer_lengths, prepare
from beltdyn.solvers.trajectory import Chunk, Statistics, drive_task
from beltdyn.state.installation import drawn_in
from beltdyn.state.static import find_equilibrium
from beltdyn.system.build import drive_system
from beltdyn.system.observe import observe
from beltdyn.system.state import at_rest
from beltdyn.transient.simulate import choose_integrator
from validation.paper.distribution import distribution, find_peak, fit_line
from validation.published import RISE, better, loaded_two_pulley, two_pulley

Row = Sequence[str]
Changes = Mapping[str, Any]

DRIVER, DRIVEN = 0, 1
RULES = (("zone", 5), ("zone", 8), ("fixed", 5), ("fixed", 7), ("fixed", 11), ("fixed", 21), ("fixed", 31))
COARSE_RULES = (("fixed", 5), ("fixed", 11), ("fixed", 21))
MEASUREMENTS: dict[str, Callable[[], Iterator[Row]]] = {}


def measurement(name: str) -> Callable[[Callable[[], Iterator[Row]]], Callable[[], Iterator[Row]]]:
    """Register a function that gives the rows of a table, the headings first; an empty row starts another table."""

    def register(rows: Callable[[], Iterator[Row]]) -> Callable[[], Iterator[Row]]:
        MEASUREMENTS[name] = rows
        return rows

    return register


# Drives


def changed(
    drive: bd.Drive,
    *,
    belt: Changes | None = None,
    driver: Changes | None = None,
    driven: Changes | None = None,
    contact: Changes | None = None,
    **simulation: Any,
) -> bd.Drive:
    """A drive of two pulleys with some values changed."""
    first, second = drive.pulleys
    return drive.replace(
        belt=drive.belt.replace(**belt or {}),
        pulley=[first.replace(**driver or {}), second.replace(**driven or {})],
        contact=drive.contact.replace(**contact or {}),
        simulation=drive.simulation.replace(**simulation),
    )


def case_1(elements: int = 20, *, contact: Changes | None = None, **simulation: Any) -> bd.Drive:
    """The two-pulley drive of Table 1 and Eq. 28, contact by default, from equilibrium."""
    return changed(better(two_pulley(elements)), contact=contact, **simulation)


def case_2(*, contact: Changes | None = None, **simulation: Any) -> bd.Drive:
    """The drive of the paper's force distributions (Eq. 29), contact on the zone, from equilibrium."""
    return changed(better(loaded_two_pulley()), contact=contact, **simulation)


def tutorial(**changes: Any) -> bd.Drive:
    """The drive that `beltdyn new` writes."""
    text = files("beltdyn.cli").joinpath("new_drive.toml").read_text(encoding="utf-8")
    return changed(bd.loads(text), **changes)


# What is read from runs


def driven_speed(run: bd.Run) -> FloatArray:
    """Speed of the driven pulley over time, rad/s."""
    return np.asarray(run.dataset["pulley_speed"])[:, DRIVEN]


def rms(values: FloatArray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def speed_difference(one: bd.Run, other: bd.Run) -> FloatArray:
    """Difference of two runs' driven speed over time, rad/s."""
    return driven_speed(one) - driven_speed(other)


def torque_ripple(run: bd.Run, since: float) -> float:
    """Standard deviation of the belt's torque on the driven pulley from an instant on, N m."""
    return float(run.dataset["pulley_torque"][:, DRIVEN].sel(time=slice(since, None)).std())


def mean(run: bd.Run, name: str, duration: float) -> FloatArray:
    """Mean of a variable over the last while, s."""
    values = run.dataset[name]
    time = run.dataset[values.dims[0]].values
    return np.asarray(values.values[time > time[-1] - duration].mean(axis=0))


def steps(run: bd.Run) -> str:
    """Steps taken and rejected."""
    return f"{run.dataset.attrs['steps']}, {run.dataset.attrs['rejected_steps']}"


def seconds(run: bd.Run) -> str:
    """Computing time without compilation."""
    return f"{run.dataset.attrs['wall_time']:.1f} s"


def at(run: bd.Run, name: str, time: float) -> float:
    """Value of a variable without other dimensions at an instant."""
    return float(run.dataset[name].sel(time=time, method="nearest"))


# docs/deviations.md


@measurement("contact-integration-1")
def contact_integration_1() -> Iterator[Row]:
    """Case 1 over 3 s with Gauss points on the zone and over whole elements."""
    yield "points", "steps, rejected", "Newton", "time", "difference, 0–1 s", "0–3 s", "torque ripple, last 0.5 s"
    runs = {rule: bd.simulate(case_1(contact=integration(*rule), duration=3.0)) for rule in RULES}
    for rule, run in runs.items():
        error = speed_difference(run, runs["zone", 8])
        newton = run.dataset.attrs["newton_iterations"]
        differences = f"{rms(error[:1001]):.1e} rad/s", f"{rms(error):.1e}"
        yield label(*rule), steps(run), f"{newton}", seconds(run), *differences, f"{torque_ripple(run, 2.5):.3f} N m"


@measurement("contact-integration-2")
def contact_integration_2() -> Iterator[Row]:
    """Case 2 with Gauss points on the zone and over whole elements, for two creep-rate factors."""
    yield "points", "creep-rate factor", "steps, rejected", "ripple, last 0.2 s", "difference to zone 8"
    for factor in (1e4, 1e5):
        contacts = {rule: integration(*rule) | {"creep_rate_factor": factor} for rule in RULES[:-1]}
        runs = {rule: bd.simulate(case_2(contact=contact)) for rule, contact in contacts.items()}
        for rule, run in runs.items():
            difference = f"{rms(speed_difference(run, runs['zone', 8])):.1e} rad/s"
            yield label(*rule), f"{factor:.0e}", steps(run), f"{torque_ripple(run, 0.8) / 45.0:.2%}", difference


def integration(rule: str, points: int) -> dict[str, Any]:
    """Keys of the contact's integration."""
    return {"integration": rule, "quadrature_points": points}


def label(rule: str, points: int) -> str:
    """Name of a rule in a table."""
    return f"{rule} {points}"


@measurement("contact-integration-tolerance")
def contact_integration_tolerance() -> Iterator[Row]:
    """Case 2 with three tolerances: what the rule of integration changes, and what the tolerance does."""
    yield (
        "creep-rate factor",
        "rtol",
        "zone 8 against rtol 1e-4",
        *(f"{label(*rule)} to zone 8" for rule in COARSE_RULES),
    )
    for factor in (1e4, 1e5):
        contacts = [integration(*rule) | {"creep_rate_factor": factor} for rule in (("zone", 8), *COARSE_RULES)]
        finest = bd.simulate(case_2(contact=contacts[0], rtol=1e-4))
        for rtol in (1e-3, 3e-4, 1e-4):
            zone, *fixed = (bd.simulate(case_2(contact=contact, rtol=rtol)) for contact in contacts)
            errors = [speed_difference(zone, finest), *(speed_difference(run, zone) for run in fixed)]
            yield f"{factor:.0e}", f"{rtol:.0e}", *(f"{rms(error):.1e} rad/s" for error in errors)


@measurement("energy-floor")
def energy_floor() -> Iterator[Row]:
    """Energy that case 1 loses or wins on a driver at rest within 0.3 s of a laid start."""
    tolerances = (1e-3, 1e-4, 1e-5)
    yield "error of the account / initial energy", *(f"rtol {rtol:.0e}" for rtol in tolerances)
    for elements in (10, 20):
        for points in (5, 8):
            errors = [account_error(elements, points, rtol) for rtol in tolerances]
            yield f"{elements} elements, {points} points", *(f"{error:.1e}" for error in errors)


def account_error(elements: int, points: int, rtol: float) -> float:
    """Error of the energy account after 0.3 s over the initial energy."""
    laid = case_1(elements, contact={"quadrature_points": points}, start="laid", rtol=rtol, duration=0.3)
    data = bd.simulate(changed(laid, driver={"speed": {"kind": "constant", "value": 0.0}})).dataset
    stored = np.asarray(data["kinetic_energy"] + data["strain_energy"] + data["penalty_energy"])
    lost = np.asarray(data["friction_loss"] + data["damping_loss"] - data["driver_work"] - data["torque_work"])
    return float((stored[-1] + lost[-1] - stored[0]) / stored[0])


@measurement("start")
def start() -> Iterator[Row]:
    """Both cases from the laid and the equilibrium start."""
    kinds = ("laid", "equilibrium")
    yield "", *kinds
    fine = [bd.simulate(case_1(start=kind, rtol=1e-4)) for kind in kinds]
    yield "case 1: span tension at t = 0", *(f"{float(run.dataset['span_tension'][0, 0]):.1f} N" for run in fine)
    before = [run.dataset.sel(time=slice(0.0, 0.05)) for run in fine]
    yield "case 1: largest hub force", *(f"{float(abs(data['hub_force']).max()):.1f} N" for data in before)
    yield "case 1: lost in damping, friction", *map(early_losses, fine)
    coarse = [bd.simulate(case_1(start=kind)) for kind in kinds]
    yield "case 1: steps, rejected", *map(steps, coarse)
    second = [bd.simulate(case_2(start=kind)) for kind in kinds]
    yield "case 2: strain energy at t = 0", *(f"{at(run, 'strain_energy', 0.0):.1f} J" for run in second)
    yield "case 2: lost in damping, friction", *map(early_losses, second)
    yield "case 2: steps, rejected", *map(steps, second)
    yield ()
    yield "difference of the driven speed", "rms", "largest", "rms after 0.1 s"
    yield "case 1, laid to equilibrium", *differences(*fine)
    yield "case 2, laid to equilibrium", *differences(*second)
    published = bd.simulate(two_pulley())
    yield "case 1, published settings to equilibrium, zone", *differences(published, fine[1])


def early_losses(run: bd.Run) -> str:
    """Energy lost in contact before the driver starts."""
    return f"{at(run, 'damping_loss', 0.05):.1e} J, {at(run, 'friction_loss', 0.05):.1e} J"


def differences(one: bd.Run, other: bd.Run) -> Row:
    """Difference of two runs' driven speed: root mean square, largest, root mean square after 0.1 s."""
    error = speed_difference(one, other)
    return [f"{value:.1e} rad/s" for value in (rms(error), float(abs(error).max()), rms(error[100:]))]


@measurement("torque-profile")
def torque_profile() -> Iterator[Row]:
    """Case 2 with the torque of Eq. 29 as printed and without its jump."""
    printed = case_2(rtol=1e-4)
    smooth = changed(printed, driven={"torque": {"kind": "cosine_ramp", "value": -45.0, **RISE}})
    profiles = [drive.pulleys[DRIVEN].torque for drive in (printed, smooth)]
    times = np.linspace(0.0, 1.0, 100001)
    torques = [profile.at(times) for profile in profiles if profile is not None]
    jump = float(torques[0][times > RISE["start"]][0])
    apart = abs(torques[0] - torques[1])
    runs = [bd.simulate(drive) for drive in (printed, smooth)]
    error = speed_difference(*runs)
    yield "printed to smooth", ""
    yield "jump at 0.05 s", f"{-jump:.2f} N m, {jump / torques[0][-1]:.2%}"
    yield "largest difference of the torque", f"{apart.max():.1f} N m at {times[apart.argmax()]:.2f} s"
    yield "difference of the driven speed", f"{rms(error):.2f} rad/s rms, {abs(error).max():.2f} largest"
    yield "in the last 0.2 s", f"{rms(error[800:]):.1e} rad/s rms"
    yield "lowest driven speed, printed and smooth", ", ".join(f"{driven_speed(run).min():.1e} rad/s" for run in runs)


@measurement("normal-force")
def normal_force() -> Iterator[Row]:
    """What the published normal force, which may pull, changes at `rtol` 1e-4."""
    yield "case", "speed [rad/s]", "driven torque [N m]", "span tension [N]", "strongest pull [N/m]"
    drives: dict[str, Callable[..., bd.Drive]] = {
        "1, equilibrium": lambda **law: case_1(contact=law, rtol=1e-4),
        "1, laid": lambda **law: case_1(contact=law, rtol=1e-4, start="laid"),
        "2, 1e4": lambda **law: case_2(contact=law, rtol=1e-4),
        "2, 1e5": lambda **law: case_2(contact={"creep_rate_factor": 1e5, **law}, rtol=1e-4),
        "2, 1e5, c_p = 1000": lambda **law: case_2(
            contact={"creep_rate_factor": 1e5, "damping": 1e3, **law}, rtol=1e-4
        ),
    }
    for name, drive in drives.items():
        one, other = bd.simulate(drive(normal_law="no_pull")), bd.simulate(drive(normal_law="published"))
        yield (
            name,
            *(
                f"{rms(np.asarray(one.dataset[key] - other.dataset[key])[:, -1]):.0e}"
                for key in ("pulley_speed", "pulley_torque", "span_tension")
            ),
            f"{max(0.0, -float(other.dataset['normal_force'].min())):.3g}",
        )


@measurement("shear-correction")
def shear_correction() -> Iterator[Row]:
    """Case 1 with other shear corrections than that of a rectangle."""
    yield from belt_effects({f"{factor:.3f}": {"shear_correction": factor} for factor in (5 / 6, 1.0)})


@measurement("elastic-points")
def elastic_points() -> Iterator[Row]:
    """Case 1 with other numbers of Gauss points for the elastic forces than four."""
    yield from belt_effects({f"{points} points": {"quadrature_points": points} for points in (2, 3, 5, 6, 8)})


def belt_effects(changes: Mapping[str, Changes]) -> Iterator[Row]:
    """Difference of case 1 with changed belts to case 1."""
    reference = bd.simulate(case_1(rtol=1e-4))
    yield "", "difference of the driven speed, rms", "of a span's tension, rms"
    for name, change in changes.items():
        run = bd.simulate(changed(case_1(rtol=1e-4), belt=change))
        tension = np.asarray(run.dataset["span_tension"] - reference.dataset["span_tension"])[:, 0]
        yield name, f"{rms(speed_difference(run, reference)):.1e} rad/s", f"{rms(tension):.2f} N"


@measurement("reduced-integration")
def reduced_integration() -> Iterator[Row]:
    """Driven speed, tension and normal force of case 1, and of case 2, with full and with reduced integration."""
    rules = ("full", "reduced")
    yield (
        "",
        "elements",
        *(f"{what}, {rule}" for what in ("speed error, rms", "mean tension", "ripple") for rule in rules),
    )
    cases = {"case 1": (two_pulley(), (20, 30, 40, 60)), "case 2": (loaded_two_pulley(1e5), (20, 30, 40))}
    for name, (published, meshes) in cases.items():
        converged = bd.simulate(better(published, 240, rtol=1e-4))
        for elements in meshes:
            runs = [
                bd.simulate(changed(better(published, elements, rtol=1e-4), belt={"integration": rule}))
                for rule in rules
            ]
            yield (
                name,
                f"{elements}",
                *(f"{rms(speed_difference(run, converged)):.1e} rad/s" for run in runs),
                *(f"{float(run.dataset['belt_tension'][-100:].mean()):.5g} N" for run in runs),
                *(f"{ripple_of_force(run):.2g}" for run in runs),
            )


@measurement("coarse-meshes")
def coarse_meshes() -> Iterator[Row]:
    """Case 1 on meshes from coarse to fine: tension at rest and in motion, driven speed and its ripple."""
    parts = (0.0, 0.25, 0.5, 0.75)
    shifts = [f"shifted by {part} elements" for part in parts[1:]]
    yield "elements", "tension at rest", *shifts, "driven speed by half an element, rms"
    for elements in (20, 30, 60):
        tensions, speeds = zip(*(from_shift(elements, part) for part in parts), strict=True)
        yield f"{elements}", *(f"{tension:.2f} N" for tension in tensions), f"{rms(speeds[2] - speeds[0]):.1e} rad/s"
    yield ()
    yield "elements", "mean tension", "error, rms", "largest"
    runs = {count: bd.simulate(case_1(count, rtol=1e-4)) for count in (240, 120, 60, 30, 20, 16, 12)}
    for count, run in runs.items():
        error = speed_difference(run, runs[240])
        tension = float(mean(run, "belt_tension", 0.2).mean())
        yield f"{count}", f"{tension:.2f} N", f"{rms(error):.3g} rad/s", f"{abs(error).max():.2g} rad/s"


def from_shift(elements: int, part: float) -> tuple[float, FloatArray]:
    """Case 1 from the rest of a belt shifted by part of an element: span tension at rest, driven speed over time."""
    drive = case_1(elements, rtol=1e-4)
    system, path = drive_system(prepare(drive)), drawn_in(prepare(drive), 1.0)
    stretch = path.length / float(np.sum(system.length))
    along = stretch * (np.concatenate([[0.0], np.cumsum(system.length)])[: system.nodes] + part * system.length[0])
    tangent = path.tangent(along)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    laid = at_rest(system, np.hstack([path.position(along), stretch * tangent, normal]))
    state = find_equilibrium(system, laid).state
    seen = observe(system, np.zeros(1), state.position[None], state.velocity[None])
    task = drive_task(prepare(drive), system, state, Statistics())
    states = Chunk.join(list(choose_integrator(drive)(task)))
    speed = states.at(task.instants[np.arange(task.instants.count)])[1][:, -1]
    return float(seen.span_tension[0, 0]), speed


@measurement("ripple")
def ripple() -> Iterator[Row]:
    """How the driven speed of case 1 swings about 12 rad/s after the ramp, and dies out on meshes that resolve it."""
    run = bd.simulate(case_1(60, rtol=1e-4, duration=2.0))
    times, swing = np.asarray(run.dataset["time"]), driven_speed(run) - 12.0
    crossings = times[:-1][(np.diff(np.sign(swing)) != 0) & (times[:-1] > 0.62)]
    yield "60 elements", ""
    yield "frequency", f"{0.5 / np.diff(crossings[:8]).mean():.1f} Hz"
    for since, until in ((0.6, 0.75), (0.75, 1.0), (1.0, 1.25), (1.25, 1.5), (1.5, 1.75), (1.75, 2.0)):
        yield f"largest from {since} to {until} s", f"{abs(swing[(times >= since) & (times < until)]).max():.3f} rad/s"
    yield ()
    yield "elements", "standard deviation, 2.5 to 3 s", "frequency"
    for elements in (20, 30, 60):
        speed = driven_speed(bd.simulate(case_1(elements, duration=3.0)))[-500:]
        spectrum = abs(np.fft.rfft(speed - speed.mean()))
        frequency = np.fft.rfftfreq(500, 1e-3)[spectrum.argmax()]
        yield f"{elements}", f"{speed.std():.1e} rad/s", f"{frequency:.0f} Hz"


@measurement("contact-force-spread")
def contact_force_spread() -> Iterator[Row]:
    """Normal force over the middle 90 degrees of the driver's arc, mean over the last ten outputs of fields."""
    yield "elements", "(largest − smallest) / mean", "standard deviation / mean", "mean", "share of zeros", "misses by"
    for elements in (20, 30, 60, 120):
        run = bd.simulate(case_1(elements, duration=3.0, output_interval=2e-3))
        angle = run.drive.belt_length / (elements * run.drive.pulleys[DRIVER].radius)
        yield f"{elements}", *force_spread(run), f"{run.drive.pulleys[DRIVER].radius * angle**4 / 384:.1e} m"
    yield "case 2, 30", *force_spread(bd.simulate(case_2())), ""


@measurement("resolution")
def resolution() -> Iterator[Row]:
    """What runs of random drives estimate of the errors of their meshes, in %, and what these are."""
    judged = list[Judged]()
    yield "drive", "elements", *(f"{name}, estimated / true" for name in ERROR_LIMITS)
    for seed in SEEDS:
        judged += judge(seed)
        for one in judged[-3:]:
            errors = (f"{100 * one.estimated[name]:.2g} / {100 * one.true[name]:.2g}" for name in ERROR_LIMITS)
            yield f"{seed}, {one.mesh}", f"{one.elements}", *errors
    yield ()
    yield (
        "",
        "limit",
        "true error at most twice the estimate",
        "largest true error over its estimate",
        "estimate above the limit: at most ten times the true error",
        "median of the true error over the estimate there",
        "on the named mesh within the limit",
        "largest there",
    )
    for name, limit in ERROR_LIMITS.items():
        ratios = np.array([one.true[name] / one.estimated[name] for one in judged])
        above = ratios[[one.estimated[name] > limit for one in judged]]
        mesh = "for the tension" if name == "tension" else "for all"
        named = np.array([one.true[name] for one in judged if one.mesh == mesh])
        yield (
            name,
            f"{limit:.0%}",
            f"{np.mean(ratios <= 2.0):.0%}",
            f"{ratios.max():.2g}",
            f"{np.mean(above >= 0.1):.0%}",
            f"{np.median(above):.2g}",
            f"{np.mean(named <= limit):.0%}",
            f"{named.max():.2%}",
        )


def ripple_of_force(run: bd.Run) -> float:
    """Normal force less a cubic along the middle of an arc, root mean square over the mean; the worst pulley's."""
    ripples = []
    for pulley in range(len(run.drive.pulleys)):
        angle, force = normal_forces(run, pulley)
        trend = np.polynomial.Polynomial.fit(angle, force, 3)
        ripples.append(rms(force - trend(angle)) / float(np.mean(force)))
    return max(ripples)


def normal_forces(run: bd.Run, pulley: int) -> tuple[FloatArray, FloatArray]:
    """Angles and normal forces within 60 degrees of the middle of an arc, at the last ten outputs of fields."""
    last = run.fields.isel(time=slice(-10, None))
    center = np.array(run.drive.pulleys[pulley].center)
    arm = last["contact_position"].values - center
    outwards = np.angle(np.exp(1j * (np.arctan2(arm[..., 1], arm[..., 0]) - (0.0 if center[0] > 0 else np.pi))))
    chosen = (last["contact_pulley"].values == pulley) & (np.abs(outwards) < np.pi / 3)
    return outwards[chosen], last["normal_force"].values[chosen]


def force_spread(run: bd.Run) -> Row:
    """Spread, standard deviation, mean and share of zeros of the normal force in the middle of the driver's arc."""
    pulley = run.drive.pulleys[DRIVER]
    rows = []
    fields = run.fields
    for k in range(-10, 0):
        data = fields.isel(time=k)
        place = np.asarray(data["contact_position"]) - np.array(pulley.center)
        inside = np.hypot(*place.T) < 1.1 * pulley.radius
        middle = inside & (abs(np.arctan2(place[:, 1], -place[:, 0])) < np.pi / 4)
        force = np.asarray(data["normal_force"])[middle]
        rows.append((np.ptp(force) / force.mean(), force.std() / force.mean(), force.mean(), np.mean(force <= 0.0)))
    spread, deviation, average, zeros = np.mean(rows, axis=0)
    return f"{spread:.2g}", f"{deviation:.2g}", f"{average:.0f} N/m", f"{zeros:.1%}"


@measurement("friction-peaks")
def friction_peaks() -> Iterator[Row]:
    """Rise of friction on the driver of case 2 above its straight line at the ends of contact, for two penalties."""
    yield "penalty stiffness [N/m^2]", "level in the middle", "rise at the inlet", "at the exit", "by hand at most"
    for stiffness in (1e7, 4e7):
        drive = changed(better(loaded_two_pulley(), 90), contact={"stiffness": stiffness})
        run = bd.simulate(drive)
        forces = distribution(bd.Run(run.fields_at(), drive), DRIVER)
        level = fit_line(forces, "friction").level
        rises = [find_peak(forces, at_exit).excess * level for at_exit in (False, True)]
        _, layer = layer_lengths(drive, float(mean(run, "span_tension", 0.2).mean()))
        speed = float(mean(run, "belt_speed", 0.2).mean())
        by_hand = 0.5 * 1e4 * speed * (layer / drive.pulleys[DRIVER].radius) ** 2
        yield f"{stiffness:.0e}", *(f"{value:.0f} N/m" for value in (level, *rises, by_hand))


# docs/tutorial.md and docs/accuracy.md


@measurement("tutorial-loads")
def tutorial_loads() -> Iterator[Row]:
    """The drive of `beltdyn new` under several loads, means over the last hundred outputs."""
    yield "load [N m]", "driven speed [rad/s]", "slack span [N]", "tight span [N]"
    for load in (0.0, 0.5, 1.0, 1.5, 2.0):
        run = bd.simulate(tutorial(driven={"torque": {"kind": "cosine_ramp", "value": -load, **RISE}}))
        slack, tight = mean(run, "span_tension", 0.1)
        yield f"{load:g}", f"{mean(run, 'pulley_speed', 0.1)[DRIVEN]:.4f}", f"{slack:.1f}", f"{tight:.1f}"


@measurement("tutorial-elements")
def tutorial_elements() -> Iterator[Row]:
    """The drive of `beltdyn new` for 2 s on travelling meshes, means over the last 0.5 s."""
    yield "elements", "angle of an element", "slip", "tight span", "hub load"
    for elements in (20, 30, 60, 120):
        run = bd.simulate(tutorial(belt={"elements": elements}, frame="travelling", duration=2.0))
        angle = np.degrees(run.drive.belt_length / (elements * run.drive.pulleys[DRIVER].radius))
        speed = mean(run, "pulley_speed", 0.5)
        tight, hub = mean(run, "span_tension", 0.5)[1], abs(mean(run, "hub_force", 0.5)[:, 0]).mean()
        slip = 1.0 - speed[DRIVEN] / speed[DRIVER]
        yield f"{elements}", f"{angle:.1f}°", f"{100 * slip:.4f} %", f"{tight:.2f} N", f"{hub:.2f} N"


# Output


def write(rows: Iterable[Row]) -> None:
    """Write tables in Markdown as their rows come."""
    width = 0
    for row in rows:
        cells = [*row, *[""] * (width - len(row))] if row else []
        sys.stdout.write(f"| {' | '.join(cells)} |\n" if row else "\n")
        if row and not width:
            sys.stdout.write("|" + "---|" * len(row) + "\n")
        width = len(cells)
        sys.stdout.flush()


def main() -> None:
    """Measure what the command line names."""
    parser = argparse.ArgumentParser(description="Measure the tables of docs/deviations.md and docs/tutorial.md again.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="the tables; all without a name")
    parser.add_argument("--list", action="store_true", help="list the names")
    asked = parser.parse_args()
    if unknown := [name for name in asked.names if name not in MEASUREMENTS]:
        parser.error(f"no table {', '.join(unknown)}. There are {', '.join(MEASUREMENTS)}")
    if asked.list:
        sys.stdout.write("\n".join(MEASUREMENTS) + "\n")
        return
    for rule in ("zone", "fixed"):  # compiles before anything is timed
        bd.simulate(case_1(contact={"integration": rule}, duration=0.01))
    for name in asked.names or MEASUREMENTS:
        sys.stdout.write(f"\n{name}: {MEASUREMENTS[name].__doc__}\n\n")
        write(MEASUREMENTS[name]())


if __name__ == "__main__":
    main()
