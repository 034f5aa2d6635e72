"""What is put beside a linear response: amplitudes of the same orders in a run-up, and measured ones."""

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.parts.messages import suggest
from beltdyn.results import Run, Variable, open_run
from beltdyn.solve.steady_running.operating_points import Axes
from beltdyn.solve.studies.headed_table import HeadedColumn, read_headed
from beltdyn.solve.vibration.excitation import Excitation
from beltdyn.solve.vibration.response_answers import RESPONSES

if TYPE_CHECKING:
    import xarray as xr

_HEADING = re.compile(r"(?P<name>\w+) (?P<of>.+) order (?P<order>\d*\.?\d+)")
_LARGEST_ORDER = 20.0
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
    """Amplitudes of orders in a run-up, at the speeds of a response.

    Parameters
    ----------
    given
        Of `sweep`, or its file.
    place
        Which amplitudes.

    Returns
    -------
    mapping
        Name ``run_up_NAME_amplitude`` -> its variable and values; NaN outside of the speeds of the run-up.

    Raises
    ------
    ModelError
        If the run is of another drive, or too short.
    """
    run = given if isinstance(given, Run) else open_run(given)
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
        angle, largest = run.dataset["shaft_angle"][:, one.pulley], max(_LARGEST_ORDER, one.order + 1.0)
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
    """Measured amplitudes at the speeds of a response, by straight lines between the measured speeds.

    Parameters
    ----------
    path
        A CSV file: a column "speed [rpm]", and others such as "span_tension crank-idler order 2 [N]".
    place
        Which amplitudes.

    Returns
    -------
    mapping
        Name ``measured_NAME_amplitude`` -> its variable and values; NaN outside of the measured speeds, and where
        nothing was measured.

    Raises
    ------
    ModelError
        If the file is no such table.
    """
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
