"""The filter for spectra: its closed form, what it keeps, and what it leaves of what would fold back."""

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.observation.band_limit import BandLimit, transfer
from beltdyn.results.schema import FILTER_REACH, PASS_BAND, STOP_BAND

INTERVAL = 2e-3
OUTPUTS = INTERVAL * np.arange(20, 120, dtype=np.float64)
GAIN = float(transfer(np.zeros(1))[0])


def steps_of(kind: str) -> FloatArray:
    """Ends of steps over 150 intervals: even ones, and those of a solver that halves and stretches them."""
    if kind == "even":
        return np.arange(150 * 40 + 1) * INTERVAL / 40
    lengths = INTERVAL / 30 * np.exp(np.random.default_rng(3).uniform(-0.7, 0.7, 6000))
    times = np.append(0.0, np.cumsum(lengths))
    return times[times <= 150 * INTERVAL]


def filtered(values: FloatArray, times: FloatArray, outputs: FloatArray = OUTPUTS, room: int = 500) -> FloatArray:
    """As states come, some at a time."""
    band, found, done = BandLimit(INTERVAL), [], 0
    for first in range(0, len(times), room):
        band.take(times[first : first + room], values[first : first + room])
        known = int(np.searchsorted(outputs, band.known_until()))
        found.append(band.at(outputs[done:known]))
        done = known
    assert done == len(outputs)
    return np.concatenate(found)


def test_closed_form_of_the_transfer() -> None:
    """Against the integral of the kernel times a cosine, by the trapezoidal rule."""
    t = np.linspace(-FILTER_REACH, FILTER_REACH, 200_001)
    window = 0.42 + 0.5 * np.cos(np.pi * t / FILTER_REACH) + 0.08 * np.cos(2.0 * np.pi * t / FILTER_REACH)
    frequencies = np.linspace(0.0, 3.0, 61)
    integrals = [np.trapezoid(np.sinc(t) * window * np.cos(2.0 * np.pi * f * t), t) for f in frequencies]
    np.testing.assert_allclose(transfer(frequencies), integrals, atol=1e-8)


def test_it_keeps_the_pass_band_and_suppresses_what_would_fold_into_it() -> None:
    kept = transfer(np.linspace(0.0, PASS_BAND, 1001)) / GAIN
    left = transfer(np.linspace(STOP_BAND, 20.0, 20_001)) / GAIN
    np.testing.assert_allclose(kept, 1.0, atol=2e-4)
    assert np.abs(left).max() < 10.0 ** (-75.0 / 20.0)


@pytest.mark.parametrize("kind", ["even", "uneven"])
@pytest.mark.parametrize("frequency", [0.0, 0.1, 0.3, 0.375, 0.5, 0.625, 0.8, 1.0, 1.458, 2.3, 4.7])
def test_sinusoids_are_multiplied_by_the_transfer(kind: str, frequency: float) -> None:
    """Cubics between 30 steps in an interval err by (2 pi f h)^4 / 384 and less; those of a slope by its square."""
    times = steps_of(kind)
    phase = 2.0 * np.pi * frequency / INTERVAL
    signal = np.stack([np.cos(phase * times), np.sin(phase * times)], axis=1)
    expected = np.stack([np.cos(phase * OUTPUTS), np.sin(phase * OUTPUTS)], axis=1)
    expected *= float(transfer(np.array([frequency]))[0]) / GAIN
    longest = np.diff(times).max() / INTERVAL
    allowed = 1e-5 + 0.1 * (2.0 * np.pi * frequency * longest) ** 3
    np.testing.assert_allclose(filtered(signal, times), expected, atol=allowed)


def test_what_would_fold_back_is_gone() -> None:
    """729 Hz in outputs at 1 kHz would be seen at 271 Hz: 75 dB less of it is left."""
    interval, rate = 1e-3, 40_000.0
    times = np.arange(0.0, 1.0, 1.0 / rate)
    band = BandLimit(interval)
    band.take(times, np.cos(2.0 * np.pi * 729.0 * times)[:, None])
    outputs = interval * np.arange(20, 970, dtype=np.float64)
    assert np.abs(band.at(outputs)).max() < 10.0 ** (-75.0 / 20.0)


def test_steps_as_long_as_intervals_and_longer_ones_are_interpolated() -> None:
    """A line is kept whatever the steps: it is its own interpolation, and the kernel is even."""
    for length in (1.0, 3.7):
        times = np.arange(0.0, 150.0, length) * INTERVAL
        values = np.stack([np.ones_like(times), times], axis=1)
        found = filtered(values, times, room=1000)
        np.testing.assert_allclose(found[:, 0], 1.0, rtol=1e-6)
        np.testing.assert_allclose(found[:, 1], OUTPUTS, rtol=1e-6)


def test_how_states_are_handed_over_makes_no_difference() -> None:
    times = steps_of("uneven")
    values = np.sin(300.0 * times)[:, None]
    np.testing.assert_allclose(filtered(values, times, room=37), filtered(values, times, room=5000), atol=1e-9)
