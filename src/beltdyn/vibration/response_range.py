"""The range of a linear response: where what it leaves out counts, and by how much amplitudes may err.

A linear response has no bounds: spans push, arcs transmit any torque, tensioners slide without dry friction and pass
their stops. In the equations of motion

- spans go slack, and before that arcs and spans are no longer linear in the tension. Runs over time of six drives with
  fixed centers and with spring-loaded arms, idle to fully loaded, near and off resonance, differ from the linear
  response by up to 0.4 q^3, with q the amplitude of a span tension over its mean (`docs/verification/vibrations.md`);
- the whole arc of a pulley slides where the tensions on its sides meet Euler's ratio, which bounds the torque. The
  amplitude is between that at which this begins and that of the linear response; a pulley counts with its share of the
  largest tension amplitude;
- dry friction f damps a tensioner with the velocity amplitude V as a dashpot 4 f / (pi V) does, of the same work in a
  period (Den Hartog 1931), or holds it;
- a stop ends the motion of a tensioner.
"""

from collections.abc import Sequence
from math import ceil, tau
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import ComplexArray, FloatArray
from beltdyn.model import Prepared
from beltdyn.results.mechanics import across
from beltdyn.results.slip_safety import friction_used

RIPPLE_ERROR = 0.4
"""Error of amplitudes over q^3."""
SMALL_ERROR = 0.05
"""Estimated error of amplitudes up to which a linear response is within its range."""
_SCALES = np.linspace(0.0, 1.0, 41)[1:]
"""Parts of the vibration at which the friction used is computed."""
_SLIDES = 0.99
"""Friction used in steady running from which on an arc slides as a whole already."""
_PERIODS = 12
"""Periods of the slowest vibration in which several that never meet alike are followed."""
_PER_PERIOD, _MOST_INSTANTS = 24, 192
"""Instants in a period of the fastest vibration, and in all."""
_MEET = 1e-4
"""Relative difference of frequencies in ratios of whole numbers."""
_GOLDEN = 0.5 * (5.0**0.5 - 1.0)
"""Step between instants over their time, which spreads them evenly and never aligns with periods."""


class SteadyValues(NamedTuple):
    """What vibrations are about."""

    tension: FloatArray
    """Of spans, N."""
    speed: FloatArray
    """Of the belt in spans, m/s."""
    centers: FloatArray
    """Of pulleys, m, shape (P, 2)."""
    positions: FloatArray
    """Of tensioners, m or rad."""


class Range(NamedTuple):
    """How far vibrations at a speed are from what a linear response holds for."""

    ripple: FloatArray
    """Sum of the amplitudes of each span tension over its mean: slack from 1 on."""
    friction_used: FloatArray
    """Largest part of its friction that each pulley uses: the whole arc slides from 1 on, inf where a span is slack."""
    stop_used: FloatArray
    """Amplitude of each tensioner over its way to the nearer stop: 1 and more where it is reached."""
    friction_change: float
    """Change of the largest tension amplitude by dry friction of tensioners, relative."""
    error: float
    """Estimated error of amplitudes, relative to the largest one."""


def range_of(
    prepared: Prepared,
    still: SteadyValues,
    frequencies: Sequence[float],
    tensions: ComplexArray,
    positions: ComplexArray,
    rubbed: FloatArray,
) -> Range:
    """How far vibrations of span tensions (N) and tensioners (m or rad) are from the range of a linear response.

    Amplitudes of exp(i w t) have a row for each frequency w (rad/s); `rubbed` are sums of them with dry friction, N.
    """
    times = instants(frequencies)
    waves = np.exp(1j * np.outer(times, frequencies))
    swing, sums = (waves @ tensions).real, np.abs(tensions).sum(axis=0)
    largest = float(np.nanmax(sums, initial=0.0))
    ripple = np.divide(sums, still.tension, out=np.full_like(sums, np.nan), where=still.tension > 0.0)
    used = np.array([_most_used(prepared, still, scale * swing) for scale in _SCALES])
    stop_used = _stop_used(prepared, still.positions, np.abs(positions).sum(axis=0))
    change = float(np.nanmax(np.abs(rubbed - sums), initial=0.0)) / largest if largest > 0.0 else 0.0
    begins = _most_used(prepared, still, np.zeros((1, sums.size)))
    before, after = across(swing, prepared)
    shares = np.abs(before - after).max(axis=0) / (largest or 1.0)
    slides = max(
        (
            min(1.0, shares[pulley]) * (1.0 / scale - 1.0)
            for pulley, scale in enumerate(_scale_of_sliding(used))
            if begins[pulley] < _SLIDES
        ),
        default=0.0,
    )
    worst = float(np.nanmax(ripple, initial=0.0))
    stops = max(float(np.nanmax(stop_used, initial=0.0)) - 1.0, 0.0)
    error = RIPPLE_ERROR * worst**3 + max(slides, worst - 1.0, 0.0) + stops + change
    return Range(ripple, used[-1], stop_used, change, error)


def friction_dashpots(friction: FloatArray, creep_speed: FloatArray, velocity: FloatArray) -> FloatArray:
    """Dashpots that take the work of dry friction in a period: 4 f / (pi V), and f / v_c of tensioners at rest."""
    with np.errstate(divide="ignore", invalid="ignore"):
        held = np.where(friction > 0.0, friction / creep_speed, 0.0)
        slides = np.where(friction > 0.0, 4.0 * friction / (np.pi * velocity), 0.0)
    return np.minimum(held, slides)


def instants(frequencies: Sequence[float]) -> FloatArray:
    """Instants, s, at which vibrations of some frequencies (rad/s) meet in all phases."""
    slowest, fastest = min(frequencies), max(frequencies)
    ratios = np.array(frequencies) / slowest
    meeting = (k for k in range(1, _PERIODS) if np.all(np.abs(k * ratios - np.round(k * ratios)) < _MEET * k * ratios))
    periods = next(meeting, _PERIODS)
    count = ceil(_PER_PERIOD * periods * fastest / slowest - 1e-6)
    parts = np.arange(count) / count if count <= _MOST_INSTANTS else _GOLDEN * np.arange(_MOST_INSTANTS) % 1.0
    return np.asarray(periods * tau / slowest * parts)


def _most_used(prepared: Prepared, still: SteadyValues, swing: FloatArray) -> FloatArray:
    """Largest part of its friction that each pulley uses in a vibration of the tensions, shape (instants, spans)."""
    tension, shape = still.tension + swing, (len(swing), 1)
    used = friction_used(tension, np.tile(still.speed, shape), np.tile(still.centers, (*shape, 1)), prepared)
    before, after = across(tension, prepared)
    slack = np.minimum(before, after) <= 0.0
    return np.asarray(np.where(slack, np.inf, used).max(axis=0))


def _scale_of_sliding(used: FloatArray) -> FloatArray:
    """Part of the vibration at which each whole arc begins to slide, 1 where it does not."""
    slides = used >= 1.0
    return np.where(slides.any(axis=0), _SCALES[np.argmax(slides, axis=0)], 1.0)


def _stop_used(prepared: Prepared, positions: FloatArray, amplitudes: FloatArray) -> FloatArray:
    """Amplitudes of tensioners over their ways to the nearer stop, NaN without stops."""
    found = np.full(amplitudes.size, np.nan)
    for number, one in enumerate(prepared.moving_tensioners):
        if one.stops is not None:
            way = min(abs(positions[number] - stop) for stop in one.stops)
            found[number] = amplitudes[number] / way if way > 0.0 else np.inf
    return found
