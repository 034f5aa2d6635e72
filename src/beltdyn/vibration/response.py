"""Forced response: linear response of steady running to harmonics of speeds and loads, over speed."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.parts.messages import suggest
from beltdyn.parts.options import ForceTolerance, RangeCount, takes_options
from beltdyn.parts.quantity import Numbers, numbers_in
from beltdyn.parts.table_file import HeadedColumn, read_headed
from beltdyn.points.changed_drive import at_instant, at_speed, driver_of, held_at, sense_of
from beltdyn.points.operating_points import Axes, OperatingPoints, labels_of
from beltdyn.results import Result, Run, Variable
from beltdyn.results.run import run_of
from beltdyn.solvers.run_progress import Report
from beltdyn.vibration.excitation import Excitation, averaged
from beltdyn.vibration.modes import SLIDING, STUCK
from beltdyn.vibration.response_answers import RESPONSES, SMALL_ERROR, Answers, ForcedMotion
from beltdyn.vibration.small_motions import require_closed

if TYPE_CHECKING:
    import xarray as xr

# What is put beside a linear response: amplitudes of the same orders in a run-up, and measured ones

_HEADING = re.compile(r"(?P<name>\w+) (?P<of>.+) order (?P<order>\d*\.?\d+)")
_ORDER_LIMIT = 20.0
"""Order, per turn of the pulley, up to which spectra of a run-up go at least; an excitation above 19 extends them to
one order beyond its own."""
_SPEED = "speed"


class Place(NamedTuple):
    """Where amplitudes of a response are."""

    speeds: FloatArray
    """Magnitudes of the speed of the pulley, rad/s, shape (n,)."""
    pulley: int
    """Its number."""
    excitations: Sequence[Excitation]
    labels: Mapping[str, Sequence[str]]
    """Names of spans, pulleys and tensioners."""

    def blank(self, name: str, words: str) -> tuple[Variable, FloatArray]:
        """A variable of amplitudes of a result, and its values, not known yet."""
        one = RESPONSES[name]
        about = Variable(("speed", "excitation", *one.dims), one.units, f"{one.long_name}, {words}")
        return about, np.full((self.speeds.size, len(self.excitations), len(self.labels[one.dims[0]])), np.nan)


def run_up_amplitudes(given: Run | Path | str, place: Place) -> Axes:
    """Amplitudes of orders in a run-up, at the speeds of a response."""
    run = run_of("compare", given)
    own = [str(one) for one in run.dataset["pulley"].values]
    if own != list(place.labels["pulley"]):
        raise ModelError(
            f"the run given by compare has the pulleys {', '.join(own)}, but the drive has "
            f"{', '.join(place.labels['pulley'])}. Give a run-up of the same drive."
        )
    found = dict[str, tuple[Variable, FloatArray]]()
    for name in RESPONSES:
        about, values = place.blank(name, "amplitude in the run-up")
        if values.size and (name in run.dataset or name == "hub_load"):
            for number in range(values.shape[2]):
                values[:, :, number] = _orders_of(run, name, number, place)
            found[f"run_up_{name}_amplitude"] = about, values
    return found


def _orders_of(run: Run, name: str, number: int, place: Place) -> FloatArray:
    """Amplitudes of the excitations' orders in a result, over the speed of the pulley, shape (n, excitations)."""
    from beltdyn.results import derived  # xarray, which other analyses do without

    speeds, recorded = np.abs(run.dataset["shaft_speed"].values), _recorded(run, name, number)
    found = np.empty((place.speeds.size, len(place.excitations)))
    for column, one in enumerate(place.excitations):
        angle, largest = run.dataset["shaft_angle"][:, one.pulley], max(_ORDER_LIMIT, one.order + 1.0)
        amplitude = derived.orders(recorded, angle, largest).interp(order=one.order)
        rising = np.argsort(speeds[:, one.pulley])
        at = np.interp(amplitude["speed"].values, speeds[rising, one.pulley], speeds[rising, place.pulley])
        found[:, column] = np.interp(place.speeds, at, amplitude.values, np.nan, np.nan)
    return found


def _recorded(run: Run, name: str, number: int) -> "xr.DataArray":
    """A result over time, filtered if it was recorded so."""
    recorded = "hub_force" if name == "hub_load" else name
    values = run.dataset[f"filtered_{recorded}" if f"filtered_{recorded}" in run.dataset else recorded][:, number]
    if name == "hub_load":
        values = values.isel(axis=0, drop=True).copy(data=np.hypot(*values.values.T))
    return values


def measured_amplitudes(path: Path, place: Place) -> Axes:
    """Measured amplitudes at the speeds of a response, by straight lines between the measured speeds."""
    columns = read_headed("measured", path)
    at = [one.values("rad/s") for one in columns if one.what == _SPEED]
    if len(at) != 1 or np.any(np.diff(at[0]) <= 0.0):
        raise ModelError(f'{path} needs one column "speed [rpm]" of ascending numbers.')
    found = dict[str, tuple[Variable, FloatArray]]()
    for column in columns:
        if column.what != _SPEED:
            name, exciting, number = _named(column, place)
            _, values = found.setdefault(f"measured_{name}_amplitude", place.blank(name, "measured amplitude"))
            amplitudes = column.values(RESPONSES[name].units)
            values[:, exciting, number] = np.interp(place.speeds, at[0], amplitudes, np.nan, np.nan)
    return found


def _named(column: HeadedColumn, place: Place) -> tuple[str, int, int]:
    """Name of the result, and numbers of the excitation and of the pulley, span or tensioner, that a heading names."""
    match = _HEADING.fullmatch(column.what)
    if match is None:
        raise ModelError(
            f'{column.path}: the heading "{column.what}" must be of the form "speed [rpm]" or "span_tension '
            'crank-idler order 2 [N]".'
        )
    name, of, order = match["name"], match["of"], float(match["order"])
    if name not in RESPONSES:
        raise ModelError(f"{column.path}: {name} is not a result of a response. {suggest(name, list(RESPONSES))}")
    known = list(place.labels[RESPONSES[name].dims[0]])
    if of not in known:
        raise ModelError(f"{column.path}: {of} is not in this drive. {suggest(of, known)}")
    orders = [one.order if one.pulley == place.pulley else None for one in place.excitations]
    if order not in orders:
        there = ", ".join(f"{one:g}" for one in orders if one is not None)
        raise ModelError(
            f"{column.path}: order {order:g} does not excite the drive. Orders of this pulley: {there or 'none'}."
        )
    return name, orders.index(order), known.index(of)


_KEPT = (
    *("belt_speed", "largest_tension", "least_slip_safety"),
    *("pulley_speed", "span_tension", "hub_load", "tensioner_position", "failure"),
)
"""Variables of operating points that are kept: what responses swing about."""


@takes_options
def response(
    drive: Drive,
    *,
    speed: Numbers,
    pulley: str | None = None,
    points: RangeCount = 40,
    dry_tensioners: str = SLIDING,
    compare: Path | str | Run | None = None,
    measured: Path | str | None = None,
    at: float | str | None = None,
    force_tolerance: ForceTolerance | None = None,
    output: Path | str | None = None,
    progress: Report | None = None,
    overwrite: bool = False,
) -> Result:
    """Compute the forced response to harmonics of speeds and loads over speed (order cuts) by linear analysis.

    Small vibrations about steady running at each speed, at the frequencies of the orders. Loads are those of the drive
    file at one instant; speed-dependent loads follow the speed. Speeds without steady running are marked as failed.

    Parameters
    ----------
    drive
        The drive, with harmonics of a prescribed speed or of loads, or with torques over the shaft angle.
    speed
        Speeds of the pulley: a range such as "700..6000 rpm", a list "700, 1500, 3000 rpm", or an array in rad/s;
        positive in its sense of rotation.
    pulley
        The pulley whose speed is prescribed; by default the driver.
    points
        Number of speeds of a range.
    dry_tensioners
        "sliding" for tensioners without dry friction, as in large vibrations, or "stuck" for tensioners held by it, as
        in small ones.
    compare
        A result file of `sweep`, or its result: adds the amplitudes of the same orders in the run-up.
    measured
        A CSV file of measured amplitudes to add: a column "speed [rpm]", and columns such as "span_tension crank-idler
        order 2 [N]".
    at
        Instant at which loads and schedules are evaluated, such as "0.5 s", or in s; by default the end of the
        simulation.
    force_tolerance
        Tolerance of contact forces, relative to the largest on each pulley, to which the mesh is refined; by default
        that of the drive, 0.01.
    output
        Result file (NetCDF4), updated point by point; without it the results stay in memory.
    progress
        Called repeatedly with a `Progress`.
    overwrite
        Overwrite any regular file, not only earlier results.

    Returns
    -------
    Result
        Along ``speed`` (rad/s, of the pulley in the attribute ``pulley``), ``excitation`` and pulley, span or tensioner
        amplitudes ``NAME_amplitude`` and phases ``NAME_phase``: NAME is its mean, and amplitude times
        cos(order times the angle of the exciting shaft + phase) beside. Along ``speed`` also the range of the linear
        response: ``tension_ripple``, ``largest_friction_used``, ``stop_used``, ``friction_change``, and
        ``amplitude_error``, the estimated error of amplitudes over the largest one, with a warning above 5 %.

    Raises
    ------
    ModelError
        If nothing excites the drive, options are invalid, or the drive cannot run steadily.
    ConvergenceError
        If no speed has steady running.

    Examples
    --------
    >>> waves = [{"order": 2, "amplitude": 0.02}]
    >>> shaking = drive.replace(pulley=[drive.pulleys[0].replace(harmonics=waves), drive.pulleys[1]])
    >>> found = bd.response(shaking, speed="80, 120 rpm")
    >>> found.dataset.span_tension_amplitude.dims
    ('speed', 'excitation', 'span')
    """
    if dry_tensioners not in (SLIDING, STUCK):
        raise ModelError(f'dry_tensioners = {dry_tensioners!r} must be "{SLIDING}" or "{STUCK}".')
    require_closed(drive, web=True)
    text, drive = drive.text, drive.with_slides()
    given, exciting = held_at(averaged(drive), at), at_instant(drive, at)
    number = driver_of(given) if pulley is None else given.number_of(pulley)
    name, sense = given.pulleys[number].name, sense_of(given, number)
    speeds = numbers_in("speed", speed, "rad/s", points)
    if speeds[0] < 0.0:
        raise ModelError(
            f"speed = {speed!r} must not be negative: speeds are positive in the pulley's sense of rotation."
        )
    answers = Answers(exciting, number, speeds, stuck=dry_tensioners == STUCK)
    place, beside = Place(speeds, number, answers.excitations, labels_of(given)), dict[str, Any]()
    if compare is not None:
        beside |= run_up_amplitudes(compare, place)
    if measured is not None:
        beside |= measured_amplitudes(Path(measured), place)
    axes: Axes = {"speed": (Variable(("speed",), "rad/s", f"Speed of {name}"), speeds)}
    with OperatingPoints("response", given, axes, output, progress, overwrite, names=_KEPT) as table:
        title = f"Response of {drive.title} over the speed of {name}"
        table.attributes = {"title": title, "drive_as_given": text, "pulley": name}
        table.attributes |= {"dry_tensioners": dry_tensioners, "linear_range": str(SMALL_ERROR)}
        table.more, table.derive = answers.coordinates, lambda arrays: {**answers.variables(), **beside}

        def take(index: tuple[int, ...], run: Run | None) -> None:
            if run is not None:
                answers.take(index[0], run, ForcedMotion(run, dry_tensioners == STUCK))
                table.notes = answers.warnings(table.arrays)

        def drive_at(value: float) -> Drive:
            return at_speed(given, number, sense * value)

        table.each(drive_at, force_tolerance, then=take, found_then="response")
    return table.result()
