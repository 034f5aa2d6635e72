"""The history of strains along the belt of a drive, as needed for hysteresis."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.model.end import pulling
from beltdyn.model.prepared import Prepared
from beltdyn.model.resolution import layer_lengths
from beltdyn.theory.nip import BENDING_SHARE, STRETCH_SHARE, bending_loss, compression_loss

SMOOTHED = 2.0
"""Length over which slow rates of bending are smoothed, over that on which the curvature changes."""
_KEPT = 0.91
"""What smoothing leaves of the loss of the curvature exp(s / l) / R (s < 0), then 1 / R, in the mean over elements of
any length h, and smoothed over 2 (l + h): within 2 %."""
_SMOOTHED_AT_POINTS = 6.0
"""Length over which slow rates of bending are smoothed where the law holds point by point, over sqrt(EI / T).  The belt
overshoots and swings about the curvature of a soft pulley: 2 leaves 0.69 to 0.88 of the loss, 10 leaves 1.00 to 1.02.
The longer, the more sharply the sign of the rate turns, and the more steps over time fail."""
_KEPT_AT_POINTS = 0.97
"""What this leaves of the loss: 0.95 to 0.99, on pulleys from soft to stiff."""
_LEAST_FRICTION = 0.1
"""With less the belt is taken to slide on the arc as if it had this."""


class Passing(NamedTuple):
    """Strains along the belt."""

    strain: float
    """Reference strain."""
    stretch_length: float
    """Length over which slow changes of the stretch are smoothed, m."""
    bending_length: float
    """The same for the curvature, without the length of an element, m."""
    stretch_share: float = STRETCH_SHARE
    """Modulus of stretch over loss factor and stiffness."""
    bending_share: float = BENDING_SHARE
    """Modulus of bending over loss factor and stiffness."""


class BendingAtPoints(NamedTuple):
    """Hysteresis of bending that holds point by point."""

    modulus: float
    """N m^2."""
    length: float
    """Over which slow changes of the curvature are smoothed, m."""


def bending_at_points(prepared: Prepared) -> BendingAtPoints:
    """Bending hysteresis on a staying mesh, where curvatures have no waves of the mesh."""
    belt = prepared.belt
    modulus = BENDING_SHARE / _KEPT_AT_POINTS * belt.bending_loss_factor * belt.bending_stiffness
    return BendingAtPoints(modulus, _SMOOTHED_AT_POINTS * layer_lengths(prepared, prepared.tension_at_rest)[0])


def passing_strains(prepared: Prepared) -> Passing:
    """The history of strains along the belt of a prepared.

    With fixed centers the stretch of the whole belt stays as it was at rest, and tensions lie as far above as below
    it; where a spring or an end holds a tension, the slack side stays at it.  The tension changes over R / mu, the
    length of an arc that slides until it has grown by a factor of e, the curvature over sqrt(EI / T) and an element.
    """
    tension = prepared.tension_at_rest
    belt, friction = prepared.belt, np.maximum(prepared.frictions, _LEAST_FRICTION)
    holds = bool(prepared.carriers) or pulling(prepared.path_ends) is not None
    return Passing(
        strain=0.5 * (float(belt.stretch_parameters.stretch(tension)) ** 2 - 1.0),
        stretch_length=float((prepared.radii / friction).max()),
        bending_length=SMOOTHED * layer_lengths(prepared, tension)[0],
        stretch_share=BENDING_SHARE if holds else STRETCH_SHARE,
        bending_share=BENDING_SHARE / _KEPT,
    )


def bending_resistance(prepared: Prepared) -> float:
    """Resisting force of bending hysteresis on all pulleys of a drive, N."""
    belt = prepared.belt
    return float(bending_loss(belt.bending_stiffness, belt.bending_loss_factor, prepared.radii).sum())


def rolling_resistances(prepared: Prepared) -> FloatArray:
    """Coefficients rho of rolling resistance, shape (n,), equivalent to the compression losses of the belt at rest.

    Per meter of belt, rho times the normal force along an arc of the angle phi takes rho phi T. Above the rated tension
    of the belt, where the data of its losses end, coefficients are those at that tension.
    """
    if prepared.belt.compression_loss_factor == 0.0:
        return np.zeros(len(prepared.pulleys))
    wrapped = prepared.tension_at_rest * prepared.path.wrap_angles
    losses = compression_losses(prepared)
    losses[[one for pair in prepared.path.nips for one in pair]] = 0.0  # nips have their own
    return np.divide(losses, wrapped, out=np.zeros_like(losses), where=wrapped > 0.0)


def compression_losses(prepared: Prepared) -> FloatArray:
    """Resistance by compression at each pulley, N, at rest; zero at the back of the belt, which no groove presses."""
    belt = prepared.belt
    stiffness, tension = belt.contact_stiffness, prepared.tension_at_rest
    if stiffness is None or belt.compression_loss_factor == 0.0 or not tension > 0.0:
        return np.zeros(len(prepared.pulleys))
    known = min(tension, belt.largest_tension or tension)
    losses = compression_loss(known, belt.bending_stiffness, stiffness, belt.compression_loss_factor, prepared.radii)
    return np.asarray(losses * (tension / known) * np.array([pulley.side == "inside" for pulley in prepared.pulleys]))
