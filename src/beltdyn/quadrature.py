"""Quadrature: rules on the unit interval, and the running integral of samples."""

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.legendre import Legendre, leggauss

from beltdyn.arrays import FloatArray


class Quadrature(NamedTuple):
    """Points and weights on [0, 1]."""

    points: FloatArray
    weights: FloatArray


def gauss_points(count: int) -> Quadrature:
    """Points and weights of Gauss-Legendre quadrature on [0, 1], exact up to degree 2 count - 1."""
    points, weights = _legendre(count)
    return Quadrature(0.5 * (points + 1.0), 0.5 * weights)


@cache
def _legendre(count: int) -> tuple[FloatArray, FloatArray]:
    """Points and weights on [-1, 1]; roots that every element asks for."""
    points, weights = leggauss(count)
    return points, weights


def lobatto_points(count: int) -> Quadrature:
    """Points and weights of Gauss-Lobatto quadrature on [0, 1], ends included, exact up to degree 2 count - 3."""
    polynomial = Legendre.basis(count - 1)
    points = np.concatenate([[-1.0], polynomial.deriv().roots().real, [1.0]])
    weights = 1.0 / (count * (count - 1) * polynomial(points) ** 2)
    return Quadrature(0.5 * (points + 1.0), weights)


def running_integral(values: FloatArray, places: FloatArray) -> FloatArray:
    """Integral of samples from the first place up to each, by the trapezoidal rule, zero at first."""
    integral = np.zeros(len(values))
    np.cumsum(0.5 * (values[1:] + values[:-1]) * (places[1:] - places[:-1]), out=integral[1:])
    return integral
