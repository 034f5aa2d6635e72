"""Linear stretch laws: of engineering strain, and of Green's strain as in the paper.

A measured curve of tension over the elongation g - 1: a monotone cubic spline through its points (PCHIP).

Tension and its slope are continuous, and the tension grows everywhere (Fritsch and Carlson 1980). Below no strain and
beyond the last point the curve goes on as its tangent.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.stretch.law import Stretching, StretchLaw


class Linear(NamedTuple):
    """Parameters of the linear law."""

    stiffness: float
    """EA, N."""

    def tension(self, stretch: ArrayLike) -> FloatArray:
        """Tension EA (g - 1), N."""
        return np.asarray(self.stiffness * (np.asarray(stretch, dtype=float) - 1.0))

    def tangent_stiffness(self, stretch: ArrayLike) -> FloatArray:
        """Rate dN/dg = EA, N."""
        return np.full(np.shape(stretch), self.stiffness)

    def stretch(self, tension: ArrayLike) -> FloatArray:
        """Stretch 1 + N / EA."""
        return np.asarray(1.0 + np.asarray(tension, dtype=float) / self.stiffness)


@kernel
def linear(law: Linear, metric: float) -> Stretching:
    """Kernel of `StretchLaw.stretching`: EA / 2 (g - 1)^2 with g = sqrt(G)."""
    g = metric**0.5
    strain, inverse = (metric - 1.0) / (g + 1.0), 1.0 / g
    return Stretching(
        0.5 * law.stiffness * strain * strain,
        0.5 * law.stiffness * strain * inverse,
        0.25 * law.stiffness * inverse * inverse * inverse,
    )


register(StretchLaw("linear", "tension proportional to elongation", Linear, linear))


class Green(NamedTuple):
    """Parameters of the published law."""

    stiffness: float
    """EA, N."""

    def tension(self, stretch: ArrayLike) -> FloatArray:
        """Tension EA (g^2 - 1) g / 2, N."""
        g = np.asarray(stretch, dtype=float)
        return np.asarray(0.5 * self.stiffness * (g * g - 1.0) * g)

    def tangent_stiffness(self, stretch: ArrayLike) -> FloatArray:
        """Rate dN/dg = EA (3 g^2 - 1) / 2, N."""
        g = np.asarray(stretch, dtype=float)
        return np.asarray(0.5 * self.stiffness * (3.0 * g * g - 1.0))

    def stretch(self, tension: ArrayLike) -> FloatArray:
        """Root of g^3 - g - 2 N / EA = 0 that is 1 without tension.

        By Cardano's formula 2 / sqrt(3) cos(arccos(x) / 3) with x = sqrt(27) N / EA, or with arcosh for x > 1. Below
        -EA / sqrt(27) a belt of this law gives way.
        """
        x = np.sqrt(27.0) * np.asarray(tension, dtype=float) / self.stiffness
        third = np.where(
            x <= 1.0,
            np.cos(np.arccos(np.clip(x, -1.0, 1.0)) / 3.0),
            np.cosh(np.arccosh(np.maximum(x, 1.0)) / 3.0),
        )
        return np.asarray(2.0 / np.sqrt(3.0) * third)


@kernel
def green(law: Green, metric: float) -> Stretching:
    """Kernel of `StretchLaw.stretching`: EA / 8 (G - 1)^2."""
    excess = metric - 1.0
    return Stretching(
        0.125 * law.stiffness * excess * excess,
        0.25 * law.stiffness * excess,
        0.25 * law.stiffness,
    )


register(StretchLaw("green", "as published, by Green's strain", Green, green))


_LEAST_SLOPE = 0.05
"""Slope at an end of the curve over that of the straight line to the next point, at least: the three-point formula
gives none where the next line is three times as steep, and a belt without stiffness."""
_HALVINGS = 60
"""Steps of bisection by which a stretch is found to rounding."""


class Measured(NamedTuple):
    """Parameters of a measured law."""

    stiffness: float
    """Slope dN/dg without strain, N."""
    pieces: FloatArray
    """Pieces of the curve, shape (k, 6): the strain at which a piece begins, the energy (J/m) and the tension N there,
    and the factors (N) of the strain from there, of its square and of its cube in the tension."""

    def tension(self, stretch: ArrayLike) -> FloatArray:
        """Tension by the curve, N."""
        strain, _, force, *slopes = self._at(stretch)
        return np.asarray(force + strain * (slopes[0] + strain * (slopes[1] + strain * slopes[2])))

    def tangent_stiffness(self, stretch: ArrayLike) -> FloatArray:
        """Slope dN/dg of the curve, N."""
        strain, _, _, *slopes = self._at(stretch)
        return np.asarray(slopes[0] + strain * (2.0 * slopes[1] + strain * 3.0 * slopes[2]))

    def stretch(self, tension: ArrayLike) -> FloatArray:
        """Stretch at which the curve has a tension, by bisection; on its tangents beyond its ends."""
        force = np.asarray(tension, dtype=float)
        last = self.pieces[-1]
        low, high = np.ones_like(force), np.full_like(force, 1.0 + last[0])
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            less = self.tension(middle) < force
            low, high = np.where(less, middle, low), np.where(less, high, middle)
        beyond = 1.0 + last[0] + (force - last[2]) / last[3]
        return np.asarray(np.where(force > last[2], beyond, np.where(force > 0.0, high, 1.0 + force / self.stiffness)))

    def _at(self, stretch: ArrayLike) -> FloatArray:
        """Strain from the beginning of the piece at each stretch, and the other numbers of that piece."""
        strain = np.asarray(stretch, dtype=float) - 1.0
        number = np.searchsorted(self.pieces[1:, 0], strain, side="right")
        found: FloatArray = np.moveaxis(self.pieces[number], -1, 0).copy()
        found[0] = strain - found[0]
        return found


def through(strains: ArrayLike, tensions: ArrayLike) -> Measured:
    """Law through measured elongations g - 1 and tensions (N), both ascending from zero."""
    from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

    x, n = np.asarray(strains, dtype=float), np.asarray(tensions, dtype=float)
    slopes = PchipInterpolator(x, n).derivative()(x)
    chords = np.diff(n) / np.diff(x)
    ends = np.clip(slopes[[0, -1]], _LEAST_SLOPE * chords[[0, -1]], None)
    slopes[[0, -1]] = ends
    curve = CubicHermiteSpline(x, n, slopes)
    cube, square, slope, force = curve.c
    energy = curve.antiderivative()(x)
    inner = np.stack([x[:-1], energy[:-1], force, slope, square, cube], axis=1)
    before, after = [0.0, 0.0, 0.0, ends[0], 0.0, 0.0], [x[-1], energy[-1], n[-1], ends[1], 0.0, 0.0]
    return Measured(float(ends[0]), np.ascontiguousarray(np.vstack([before, inner, after])))


@kernel
def measured(law: Measured, metric: float) -> Stretching:
    """Kernel of `StretchLaw.stretching`: the integral of the curve."""
    g = metric**0.5
    strain = (metric - 1.0) / (g + 1.0)
    pieces = law.pieces
    first, behind = 0, pieces.shape[0]
    while behind - first > 1:
        middle = (first + behind) // 2
        if pieces[middle, 0] <= strain:
            first = middle
        else:
            behind = middle
    d, slope, square, cube = strain - pieces[first, 0], pieces[first, 3], pieces[first, 4], pieces[first, 5]
    energy = pieces[first, 1] + d * (pieces[first, 2] + d * (slope / 2.0 + d * (square / 3.0 + d * cube / 4.0)))
    force = pieces[first, 2] + d * (slope + d * (square + d * cube))
    stiffness = slope + d * (2.0 * square + d * 3.0 * cube)
    return Stretching(energy, 0.5 * force / g, 0.25 * (stiffness - force / g) / metric)


register(StretchLaw("measured", "a curve of tension over elongation", Measured, measured, through=through))
