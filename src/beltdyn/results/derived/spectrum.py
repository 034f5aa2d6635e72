"""Spectra over frequency, over speed in a run-up, and over the orders of a pulley; transmission error."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from scipy.interpolate import CubicSpline

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.errors import ModelError
from beltdyn.model import Drive, prepare
from beltdyn.results.run import Run, labelled, pulley_number, window
from beltdyn.results.schema import PASS_BAND

if TYPE_CHECKING:
    from scipy.signal import ShortTimeFFT

_MIN_SAMPLES = 16
"""Least number of outputs of a spectrum: they give eight frequencies above zero, and fewer hardly resolve any."""
_STEPS_PER_PIECE = 4
"""Steps between pieces in the length of a piece: they overlap by three quarters, so that every output has about the
same weight despite the Hann window."""
_MIN_SPEED_CHANGE = 0.01
"""Part of a speed by which it changes at least in a run-up."""

_NOISE_BANDWIDTH = 1.5
"""Of a Hann window, in lines of its spectrum."""
_STANDING = 0.1
"""Part of the largest speed below which orders are not looked for."""


def amplitude_spectrum(values: xr.DataArray, window: str = "hann") -> xr.DataArray:
    """Amplitude spectrum of a variable.

    The mean is removed, and the amplitudes are normalized by the sum of the window: a sinusoid of amplitude A gives A
    at a frequency of the spectrum, and between two frequencies at least 0.85 A with "hann" or 0.999 A with "flattop",
    whose lines are wider.

    Parameters
    ----------
    values : DataArray
        A variable whose first dimension is time; it is interpolated if its instants are uneven.
    window : str
        Name of a window of `scipy.signal.get_window`.

    Returns
    -------
    DataArray
        In the unit of the variable, with ``frequency`` (Hz) in the place of time; twice the amplitude of the
        Fourier transform at positive frequencies.

    Raises
    ------
    ModelError
        If there are too few outputs, or values are missing.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> time = np.arange(0.0, 2.0, 1e-3)
    >>> force = 3.0 * np.sin(2.0 * np.pi * 10.0 * time)
    >>> swing = xr.DataArray(force, {"time": time}, attrs={"units": "N", "long_name": "Force"})
    >>> spectrum = bd.derived.amplitude_spectrum(swing)
    >>> spectrum.sel(frequency=10.0, method="nearest").round(2).item()  # N, of 3 N
    3.0
    """
    from scipy.signal import periodogram

    time, even = _even(instants_of(values), values.values)
    unknown = time[~np.isfinite(even.reshape(len(even), -1)).all(axis=1)]
    if unknown.size:
        raise ModelError(
            f"{_name_of(values)} is unknown from t = {unknown[0]:.4g} s to {unknown[-1]:.4g} s, for example because "
            "the belt has left a pulley; a spectrum cannot span this gap. Select a time before or after it."
        )
    rate = (len(time) - 1) / (time[-1] - time[0])
    frequency, power = periodogram(even, rate, window, detrend="constant", scaling="spectrum", axis=0)
    kept = frequency <= _highest(values, rate)
    frequency, amplitude = frequency[kept], np.sqrt(2.0 * power[kept])
    dims = ("frequency", *values.dims[1:])
    coordinates: dict[Any, Any] = {name: values[name] for name in values.dims[1:] if name in values.coords}
    coordinates["frequency"] = ("frequency", frequency, {"units": "Hz", "long_name": "Frequency"})
    return xr.DataArray(amplitude, coordinates, dims, attrs=_amplitude_of(values))


def waterfall(values: xr.DataArray, speed: xr.DataArray, pieces: int = 60) -> xr.DataArray:
    """Short-time spectra over the speed of a pulley (waterfall).

    Parameters
    ----------
    values : DataArray
        A variable over time.
    speed : DataArray
        Speed of the pulley over the same time, rad/s.
    pieces : int
        Approximate number of spectra; each covers four times the interval between two spectra and is detrended.

    Returns
    -------
    DataArray
        Amplitudes in the unit of the variable over ``speed`` (rad/s, its magnitude at the middle of each spectrum) and
        ``frequency`` (Hz). NaN where values are missing, for example because the belt has left a pulley.

    Raises
    ------
    ModelError
        If there are too few outputs, or the speed is constant.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> time = np.arange(0.0, 2.0, 1e-3)
    >>> force = 3.0 * np.sin(2.0 * np.pi * 10.0 * time)
    >>> swing = xr.DataArray(force, {"time": time}, attrs={"units": "N", "long_name": "Force"})
    >>> speed = 10.0 + 5.0 * xr.DataArray(time, {"time": time})
    >>> bd.derived.waterfall(swing, speed).dims
    ('speed', 'frequency')
    """
    time, even = _even(instants_of(values), values.values)
    transform = _transform(
        max(_MIN_SAMPLES, _STEPS_PER_PIECE * (len(time) // pieces)), (len(time) - 1) / (time[-1] - time[0])
    )
    middle, amplitude = _short_time(transform, even)
    turning = np.interp(time[0] + middle, speed["time"].values, np.abs(speed.values))
    kept = transform.f <= _highest(values, transform.fs)
    return _over_speed(values, amplitude[:, kept], turning, "frequency", transform.f[kept], "Hz", "Frequency")


def overall_level(amplitude: xr.DataArray) -> xr.DataArray:
    """Overall level (root mean square) of a waterfall, without the mean.

    Parameters
    ----------
    amplitude : DataArray
        Result of `waterfall`.

    Returns
    -------
    DataArray
        In the unit of the variable, over ``speed``; a sinusoid of amplitude A gives A over the square root of 2. Each
        spectrum's sum of squares is divided by the noise bandwidth of its window, 1.5 lines of a Hann window.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> time = np.arange(0.0, 2.0, 1e-3)
    >>> force = 3.0 * np.sin(2.0 * np.pi * 10.0 * time)
    >>> swing = xr.DataArray(force, {"time": time}, attrs={"units": "N", "long_name": "Force"})
    >>> speed = 10.0 + 5.0 * xr.DataArray(time, {"time": time})
    >>> level = bd.derived.overall_level(bd.derived.waterfall(swing, speed))
    >>> level.mean().round(1).item()  # N: 3 N over the square root of 2
    2.1
    """
    squares = 0.5 * np.sum(amplitude.values[:, 1:] ** 2, axis=1)
    attributes = {"units": amplitude.attrs.get("units", "1"), "long_name": "Overall level (RMS)"}
    return amplitude[:, 0].copy(data=np.sqrt(squares / _NOISE_BANDWIDTH)).assign_attrs(attributes)


def orders(values: xr.DataArray, angle: xr.DataArray, largest: float = 20.0, revolutions: int = 8) -> xr.DataArray:
    """Amplitudes of the orders of a pulley's rotation over its speed.

    The variable is resampled by cubic splines at equal steps of the pulley angle, no larger than the smallest recorded
    step (computed order tracking, Fyfe and Munck 1997), and spectra are computed over a number of revolutions: k cycles
    per revolution are order k at any speed. Only the longest part of the run with a speed above a tenth of the maximum
    is used.

    Parameters
    ----------
    values : DataArray
        A variable over time.
    angle : DataArray
        Angle of the pulley over the same time, rad.
    largest : float
        Largest order.
    revolutions : int
        Revolutions in each spectrum; the resolution is about two orders over this number.

    Returns
    -------
    DataArray
        Amplitudes in the unit of the variable over ``speed`` (rad/s, magnitude, mean of the revolution
        in the middle of each spectrum) and ``order``. NaN where values are missing, as in a waterfall, and above the
        pass band of the recording filter.

    Raises
    ------
    ModelError
        If the pulley makes too few turns, its speed is constant, or there are too few outputs.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> time = np.linspace(0.0, 2.0, 4001)  # s
    >>> angle = xr.DataArray(40.0 * np.pi * time + 10.0 * np.pi * time**2, {"time": time}, "time")
    >>> tension = (100.0 + 5.0 * np.cos(3.0 * angle)).assign_attrs(units="N", long_name="Tension")
    >>> found = bd.derived.orders(tension, angle)
    >>> found.mean("speed").sel(order=3.0).round(2).item()  # N
    5.0
    """
    from scipy.interpolate import CubicSpline

    instants = instants_of(values)
    highest = _highest(values, (len(instants) - 1) / np.ptp(instants)) if len(instants) > 1 else np.inf
    turned = np.interp(instants, angle["time"].values, np.abs(_turned(angle)))
    time, even = _even(instants, np.column_stack([values.values, turned]))
    turning = _longest_turning(np.gradient(even[:, 1], time))
    time, signal, turned = time[turning], even[turning, 0], even[turning, 1]
    turns = (turned[-1] - turned[0]) / (2.0 * np.pi)
    if turns < 2 * revolutions:
        raise ModelError(
            f"the pulley makes {turns:.3g} turns above a tenth of its largest speed; orders need {2 * revolutions} or "
            "more. Make the run longer (`--duration` of a sweep), or reduce `revolutions` in Python."
        )
    each = int(np.ceil(max(2.0 * np.pi / np.diff(turned).min(), 2.0 * largest)))
    steps = np.arange(turned[0], turned[-1], 2.0 * np.pi / each)
    known, filled = _filled(signal)
    laid = np.where(np.interp(steps, turned, known) < 1.0, np.nan, CubicSpline(turned, filled)(steps))
    transform = _transform(revolutions * each, float(each))
    middle, amplitude = _short_time(transform, laid)
    center = turned[0] + 2.0 * np.pi * middle
    passed = [np.interp(center + side, turned, time) for side in (-np.pi, np.pi)]
    speed = 2.0 * np.pi / (passed[1] - passed[0])
    kept = transform.f <= largest
    amplitude = np.where(transform.f * speed[:, None] / (2.0 * np.pi) <= highest, amplitude, np.nan)
    return _over_speed(values, amplitude[:, kept], speed, "order", transform.f[kept], "1", "Order")


def element_order(drive: Drive, pulley: int) -> float:
    """Order of a pulley's rotation at which elements pass: the elements per turn of the pulley.

    Peaks there and at its multiples belong to the mesh, not to the drive. On a staying mesh no element
    passes: then it is infinite.

    Parameters
    ----------
    drive : Drive
        The drive.
    pulley : int
        Number of the pulley.

    Examples
    --------
    >>> round(bd.derived.element_order(drive, 0), 2)
    8.0
    """
    prepared = prepare(drive)
    if prepared.frame.stays:
        return float("inf")
    turn = 2.0 * np.pi * float(prepared.radii[pulley])
    return prepared.elements * turn / prepared.path.length


def instants_of(values: xr.DataArray) -> FloatArray:
    """Give the instants of a variable over time, s, whichever of the times of a result it is recorded at."""
    return np.asarray(values[values.dims[0]].values)


def _highest(values: xr.DataArray, rate: float) -> float:
    """Highest valid frequency of a variable, Hz: the pass band of its filter, if it is filtered."""
    return PASS_BAND * rate if values.dims[0] == "filtered_time" else np.inf


def _longest_turning(speed: FloatArray) -> slice:
    """Find the longest stretch of instants at which the speed is above a tenth of the largest."""
    slow = np.concatenate([[True], speed < _STANDING * speed.max(), [True]])
    (ends,) = np.nonzero(slow)
    longest = int(np.argmax(np.diff(ends)))
    return slice(int(ends[longest]), int(ends[longest + 1]) - 1)


def _turned(angle: xr.DataArray) -> FloatArray:
    return np.asarray(angle.values - angle.values[0])


def _even(time: FloatArray, values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Lay a variable out in even steps of time, from the first to the last instant at which it is known.

    NaN in between spreads to the steps next to it.
    """
    flat = values.reshape(len(values), math.prod(values.shape[1:]))
    (known,) = np.nonzero(np.isfinite(flat).all(axis=1))
    if known.size < _MIN_SAMPLES:
        raise ModelError(
            f"{known.size} outputs are too few for a spectrum; {_MIN_SAMPLES} or more are needed. "
            "Simulate longer, or reduce simulation.output_interval."
        )
    inside = slice(known[0], known[-1] + 1)
    time, flat = time[inside], flat[inside]
    even = np.linspace(time[0], time[-1], len(time))
    laid = np.column_stack([np.interp(even, time, column) for column in flat.T])
    return even, laid.reshape(-1, *values.shape[1:])


def _filled(signal: FloatArray) -> tuple[BoolArray, FloatArray]:
    """Where a signal is known, and the signal with straight lines where it is not, which are for computing alone."""
    known = np.isfinite(signal)
    (places,) = np.nonzero(known)
    return known, np.interp(np.arange(len(signal)), places, signal[known])


def _transform(length: int, rate: float) -> "ShortTimeFFT":
    """Short-time transform over overlapping pieces, whose values at positive frequencies are amplitudes."""
    from scipy.signal import ShortTimeFFT
    from scipy.signal.windows import hann

    shape = hann(length, sym=False)
    return ShortTimeFFT(shape, max(1, length // _STEPS_PER_PIECE), rate, fft_mode="onesided2X", scale_to="magnitude")


def _short_time(transform: "ShortTimeFFT", values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Middles of the pieces that lie inside, and amplitudes, shape (pieces, frequencies).

    NaN of pieces in which some value is.
    """
    first, last = transform.lower_border_end[1], transform.upper_border_begin(len(values))[1]
    last = max(last, first + 1)
    known, filled = _filled(values)
    spectra = transform.stft_detrend(filled, "linear", p0=first, p1=last)
    middle: FloatArray = transform.delta_t * np.arange(first, last, dtype=float)
    unknown = np.append(0, np.cumsum(~known))
    begins = np.maximum(0, transform.hop * np.arange(first, last) - transform.m_num_mid)
    ends = np.minimum(begins + transform.m_num, len(values))
    amplitude = np.abs(spectra).T
    amplitude[unknown[ends] > unknown[begins]] = np.nan
    return middle, np.asarray(amplitude, dtype=float)


def _over_speed(
    values: xr.DataArray,
    amplitude: FloatArray,
    speed: FloatArray,
    name: str,
    along: FloatArray,
    units: str,
    long_name: str,
) -> xr.DataArray:
    kept = _records(speed)
    coordinates = {
        "speed": ("speed", speed[kept], {"units": "rad/s", "long_name": "Speed"}),
        name: (name, along, {"units": units, "long_name": long_name}),
    }
    return xr.DataArray(amplitude[kept], coordinates, ("speed", name), attrs=_amplitude_of(values))


def _records(speed: FloatArray) -> IntArray:
    """Find the pieces whose speed is higher than all before, or lower in a run-down, in ascending order of speed."""
    sign = 1.0 if speed[-1] >= speed[0] else -1.0
    highest = np.maximum.accumulate(sign * speed)
    (kept,) = np.nonzero(np.append(True, np.diff(highest) > 0.0))
    if np.ptp(speed) < _MIN_SPEED_CHANGE * speed.max() or len(kept) < 2:
        raise ModelError(f"the speed is constant at {speed.mean():.4g} rad/s: there is no run-up. Use `beltdyn sweep`.")
    return kept if sign > 0.0 else kept[::-1]


def _amplitude_of(values: xr.DataArray) -> dict[str, str]:
    return {"units": str(values.attrs.get("units", "1")), "long_name": f"Amplitude of {_name_of(values).lower()}"}


def _name_of(values: xr.DataArray) -> str:
    """A variable in words, also one that a user has computed, which loses its attributes."""
    return str(values.attrs.get("long_name") or values.name or "the variable")


_MIN_TURNS = 2
"""Least number of turns for an order spectrum: with n of them lines are 1 / n of an order apart, with one the first
order is next to the mean value."""


def transmission_error(
    run: Run, reference: str | int | None = None, start: float | None = None, end: float | None = None
) -> xr.DataArray:
    """Way at the pitch line by which each toothed pulley is ahead of where the ratio of the teeth has it.

    Parameters
    ----------
    run : Run
        A run of a belt with teeth.
    reference : str or int, optional
        Name or number of the pulley from whose angle others are expected; by default the driver, or the first pulley
        with teeth.
    start, end : float, optional
        Time range, s; the error is zero at its first output.

    Returns
    -------
    DataArray
        m, time and pulley with teeth: (z theta - z_r theta_r) p / 2 pi, less its first value, positive in the sense of
        ascending belt coordinate; z teeth, theta angle, p pitch.

    Raises
    ------
    ModelError
        If the belt has no teeth, or the reference has none.

    Examples
    --------
    >>> bd.derived.transmission_error(run)
    Traceback (most recent call last):
    beltdyn.errors.ModelError: the belt has no teeth, which a transmission error needs. Use a run of a toothed belt.
    """
    toothing, pulleys = run.prepared.belt.toothing, run.prepared.pulleys
    held = np.flatnonzero(run.prepared.toothed).tolist()
    if toothing is None or not held:
        raise ModelError("the belt has no teeth, which a transmission error needs. Use a run of a toothed belt.")
    usual = run.drive.reference if run.drive.reference in held else held[0]
    first = usual if reference is None else pulley_number(run, reference)
    if first not in held:
        raise ModelError(
            f"{pulleys[first].name} has no teeth. Choose a reference of {', '.join(pulleys[one].name for one in held)}."
        )
    angle = window(run, start, end)["pulley_angle"]
    teeth = np.array([float(pulley.teeth or 0) for pulley in pulleys])
    passed = teeth * angle.values * toothing.pitch / (2.0 * np.pi)
    ahead = passed[:, held] - passed[:, first : first + 1]
    return labelled(ahead - ahead[:1], angle[:, held], "m", "Transmission error")


def order_spectrum(values: xr.DataArray, angle: xr.DataArray, window: str = "hann") -> xr.DataArray:
    """Amplitudes of a variable over the orders of a pulley, cycles per turn, in a run at any speed that keeps its sign.

    The variable is laid out by cubic splines in equal steps of the angle, over whole turns.

    Parameters
    ----------
    values : DataArray
        A variable whose first dimension is time.
    angle : DataArray
        Angle of the pulley over the same time, rad.
    window : str
        Name of a window of `scipy.signal.get_window`; "boxcar" keeps the orders of whole turns apart.

    Returns
    -------
    DataArray
        In the unit of the variable, with ``order`` in the place of time; see `amplitude_spectrum`.

    Raises
    ------
    ModelError
        If the pulley makes less than two turns, or turns back.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> time = np.linspace(0.0, 1.0, 2001)  # s
    >>> angle = xr.DataArray(40.0 * np.pi * time, {"time": time}, "time")
    >>> error = (2e-6 * np.cos(24.0 * angle)).assign_attrs(units="m", long_name="Transmission error")
    >>> found = bd.derived.order_spectrum(error, angle)
    >>> found.sel(order=24.0, method="nearest").round(8).item()  # m
    2e-06
    """
    instants = instants_of(values)
    angles = np.interp(instants, angle["time"].values, angle.values)
    turns = np.abs(angles - angles[0]) / (2.0 * np.pi)
    whole = int(turns[-1] + 1e-9)
    if whole < _MIN_TURNS or np.any(np.diff(turns) <= 0.0):
        raise ModelError(
            f"the pulley makes {turns[-1]:.3g} turns without turning back; an order spectrum needs "
            f"{_MIN_TURNS} or more. Make the run longer, or select a part of it."
        )
    each = int(np.ceil((len(instants) - 1) / turns[-1]))
    steps = np.arange(whole * each) / each
    laid = CubicSpline(turns, values.values, axis=0)(np.minimum(steps, turns[-1]))
    coordinates: dict[Any, Any] = {name: values[name] for name in values.dims[1:] if name in values.coords}
    even = xr.DataArray(laid, {**coordinates, "turn": steps}, ("turn", *values.dims[1:]), attrs=values.attrs)
    found = amplitude_spectrum(even, window).rename(frequency="order")
    found["order"] = found["order"].assign_attrs(units="1", long_name="Order")
    return found
