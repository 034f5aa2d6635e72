"""Slip of the pulleys against the driver, and what it is made of."""

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model import Drive
from beltdyn.results.mechanics import across, relative_loss


def slip_parts(
    rim: FloatArray, tension: FloatArray, gross: FloatArray, elapsed: FloatArray | float, drive: Drive
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Take slip apart into elastic creep, what the slope of the friction law adds, and sliding.

    With Coulomb's friction the belt adheres to every rim where it reaches it, with the tension T of the span before
    and the stretch g(T) there: the elastic creep is 1 - g(T_i) / g(T_d), (T_d - T_i) / EA at small strain (Grashof
    1883), with the driver d (`Drive.reference`). A law of friction that starts at zero lets the belt creep there too.

    Parameters
    ----------
    rim : ndarray, shape (..., pulleys)
        Mean speeds of the rims, m/s; see `mechanics.rim_speeds`.
    tension : ndarray, shape (..., spans)
        Mean tensions, N.
    gross : ndarray, shape (..., pulleys)
        Mean velocities at which whole arcs slide, m/s; see `mechanics.gross_sliding`.
    elapsed : float or ndarray, shape (...)
        Time that means are taken over, s.
    drive : Drive
        The drive.

    Returns
    -------
    slip, elastic, regularisation, sliding : ndarray, shape (..., pulleys)
        Parts of the driver's rim speed, of which the first is the sum of the others. NaN while the driver stands
        still: while its rim goes no further than the belt is stretched.
    """
    law = drive.belt.stretch_parameters
    stretched = (law.stretch(np.max(tension, axis=-1)) - 1.0) * drive.belt_length
    driver = drive.reference
    runs = np.abs(rim[..., driver]) * elapsed > np.maximum(stretched, 0.0)
    rim = np.where(runs[..., None], rim, 0.0)
    before, after = across(tension, drive)
    reached = law.stretch(np.where(rim[..., driver, None] > 0.0, before, after))
    total, sliding = relative_loss(-rim, rim, driver), relative_loss(gross, rim, driver)
    elastic = np.where(runs[..., None], 1.0 - reached / reached[..., driver, None], np.nan)
    return total, elastic, total - elastic - sliding, sliding
