"""Kelvin-Voigt damping of the belt element in stretch and bending.

With the elongation eps = |q| - 1, q = r_c,x, whatever the law of stretch, and the curvature kappa = n . w + |q| p,
w = r_c,xx, whose square is the first bending term of Eq. 14 (|q| (theta + p) in `strain_energy`), the rate potential is

    R = integral of EA alpha1 tau_s / 2 (deps/dt)^2 + EI alpha2 tau_b / 2 (dkappa/dt)^2 over the reference length.

The damping force is -dR/d(de/dt), its power -2 R.  At the straight belt it is tau_s and tau_b times the linear elastic
force.  The paper has no damping of the belt's material; shear and the thickness stretch have none here.
"""

from math import sqrt
from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, record
from beltdyn.elements.ancf.elastic_force import centreline
from beltdyn.elements.ancf.element import Ancf, Four, add_shear_curvature, bends, nodal_shear, shear_gradient, slopes
from beltdyn.elements.kind import DampingFactors
from beltdyn.kernel import kernel

DAMPING_WORKSPACE = record(
    slope="(2,12)f8",  # derivatives of eps and kappa with respect to the coordinates e at a point
    change="(2,12)f8",  # rates of these derivatives; then derivatives of the stress in both, the tangent's part
    by_shear="(2,12)f8",  # derivative of p = ds/dx with respect to e, and its rate
    shear_curvature="(12,12)f8",  # second derivative of p with respect to e
    pull="12f8",  # sum over the points of the moment times the derivative of |q| with respect to e
)
"""Scratch arrays of `damping_force`."""


class _Point(NamedTuple):
    """A point of the centerline and the rates of its strains."""

    tangent_x: float
    """Unit tangent u = q / |q|."""
    tangent_y: float
    stretch: float
    """|q|."""
    strain_rate: float
    """deps/dt, 1/s."""
    curvature_rate: float
    """dkappa/dt, 1/(m s)."""
    fold: float
    """u . w / |q|^2, and next the factor of n n^T in the second derivative of kappa with respect to q, 1/m."""
    cross: float


@kernel
def damping_force(
    element: Ancf,
    e: FloatArray,
    velocity: FloatArray,
    length: float,
    factors: DampingFactors,
    work: np.record,
) -> tuple[float, float]:
    """Add dR/d(de/dt), the damping force with the opposite sign, and its exact tangent.

    Parameters
    ----------
    element
        Section, with its factors of damping, and quadrature.
    e, velocity : ndarray, shape (12,)
        Nodal coordinates r (m), r_x, r_y of node i, then of node j (Eq. 6), and their rates.
    length
        Reference length L, m.
    factors
        Of the tangent; the belt does not flow through this element.
    work
        The force is added to its `gradient`, N for the rows of r and N m for those of the gradients, and the tangent to
        its `tangent`. `damping` is scratch.

    Returns
    -------
    tuple of 2 floats
        Powers lost in stretch and in bending, together 2 R, W; never negative.
    """
    points, weights, section = element.elastic.points, element.elastic.weights, element.section
    scratch, gradient, tangent = work.damping, work.gradient, work.tangent
    by_position, by_velocity = factors.by_position, factors.by_velocity
    wanted = by_position != 0.0 or by_velocity != 0.0
    scratch.pull[:] = 0.0
    shear, shear_rate = _shear_rates(e, velocity, length, scratch)
    stretching, turning, twist = 0.0, 0.0, 0.0
    for k in range(points.size):
        weight = weights[k] * length
        axial, bending = weight * section.axial_damping, weight * section.bending_damping
        slope, bend = slopes(points[k], length), bends(points[k], length)
        point = _strain_rates(e, velocity, slope, bend, shear, shear_rate, scratch)
        force, moment = axial * point.strain_rate, bending * point.curvature_rate
        stretching += force * point.strain_rate
        turning += moment * point.curvature_rate
        twist += moment * point.stretch
        for column in range(12):
            gradient[column] += force * scratch.slope[0, column] + moment * scratch.slope[1, column]
        if not wanted:
            continue
        _add_products(axial, bending, by_position, by_velocity, scratch, tangent)
        _add_curvature(point, slope, bend, by_position * force, by_position * moment, tangent)
        for a in range(4):
            scratch.pull[_first(a)] += moment * slope[a] * point.tangent_x
            scratch.pull[_first(a) + 1] += moment * slope[a] * point.tangent_y
    if wanted:
        _add_shear_products(by_position, twist, scratch, tangent)
    return stretching, turning


@kernel(inline=True)
def _first(a: int) -> int:
    """First coordinate of the centerline's vector a, in the order of `element`."""
    return 6 * (a // 2) + 2 * (a % 2)


@kernel(inline=True)
def _shear_rates(e: FloatArray, velocity: FloatArray, length: float, scratch: np.record) -> tuple[float, float]:
    """Overwrite the derivatives of p = (s_j - s_i) / L; give p (1/m) and its rate."""
    scratch.by_shear[:] = 0.0
    scratch.shear_curvature[:] = 0.0
    total, rate = 0.0, 0.0
    for node in range(2):
        first, factor = 6 * node + 2, (2.0 * node - 1.0) / length
        shear = nodal_shear(e[first], e[first + 1], e[first + 2], e[first + 3])
        gradient = shear_gradient(shear)
        total += factor * shear.sine
        for c in range(4):
            scratch.by_shear[0, first + c] = factor * gradient[c]
            rate += factor * gradient[c] * velocity[first + c]
        add_shear_curvature(shear, factor, scratch.shear_curvature, first)
        for c in range(first, first + 4):
            for d in range(first, first + 4):
                scratch.by_shear[1, c] += scratch.shear_curvature[c, d] * velocity[d]
    return total, rate


@kernel(inline=True)
def _strain_rates(
    e: FloatArray,
    velocity: FloatArray,
    slope: Four,
    bend: Four,
    shear: float,
    shear_rate: float,
    scratch: np.record,
) -> _Point:
    """Overwrite the derivatives of both strains at a point and their rates.

    With u = q / |q|, n = u turned by 90 degrees and theta = n . w / |q|, kappa = n . w + |q| p has the derivatives
    p u - (u . w / |q|) n in q, n in w and |q| in p.
    """
    qx, qy = centreline(e, slope)
    wx, wy = centreline(e, bend)
    rate_x, rate_y = centreline(velocity, slope)
    bend_x, bend_y = centreline(velocity, bend)
    stretch = sqrt(qx * qx + qy * qy)
    ux, uy = qx / stretch, qy / stretch
    w_along, w_across = ux * wx + uy * wy, ux * wy - uy * wx
    q_along_rate, q_across_rate = ux * rate_x + uy * rate_y, ux * rate_y - uy * rate_x
    w_along_rate, w_across_rate = ux * bend_x + uy * bend_y, ux * bend_y - uy * bend_x
    lean, fold, cross = w_along / stretch, w_along / (stretch * stretch), (shear - w_across / stretch) / stretch
    along, across = (
        fold * q_across_rate + shear_rate,
        fold * q_along_rate + cross * q_across_rate - w_along_rate / stretch,
    )
    turn = q_across_rate / stretch
    for c in range(12):
        scratch.slope[0, c], scratch.change[0, c] = 0.0, 0.0
        scratch.slope[1, c] = stretch * scratch.by_shear[0, c]
        scratch.change[1, c] = q_along_rate * scratch.by_shear[0, c] + stretch * scratch.by_shear[1, c]
    for a in range(4):
        x, y = _first(a), _first(a) + 1
        scratch.slope[0, x], scratch.slope[0, y] = slope[a] * ux, slope[a] * uy
        scratch.change[0, x], scratch.change[0, y] = -slope[a] * turn * uy, slope[a] * turn * ux
        scratch.slope[1, x] += slope[a] * (shear * ux + lean * uy) - bend[a] * uy
        scratch.slope[1, y] += slope[a] * (shear * uy - lean * ux) + bend[a] * ux
        scratch.change[1, x] += slope[a] * (along * ux - across * uy) - bend[a] * turn * ux
        scratch.change[1, y] += slope[a] * (along * uy + across * ux) - bend[a] * turn * uy
    curvature_rate = shear * q_along_rate - lean * q_across_rate + w_across_rate + stretch * shear_rate
    return _Point(ux, uy, stretch, q_along_rate, curvature_rate, fold, cross)


@kernel(inline=True)
def _add_products(
    axial: float, bending: float, by_position: float, by_velocity: float, scratch: np.record, tangent: FloatArray
) -> None:
    """Add what the rates of the strains at a point contribute to the tangent."""
    for column in range(12):
        for k, stiffness in ((0, axial), (1, bending)):
            scratch.change[k, column] = stiffness * (
                by_position * scratch.change[k, column] + by_velocity * scratch.slope[k, column]
            )
    for row in range(12):
        along, across = scratch.slope[0, row], scratch.slope[1, row]
        for column in range(12):
            tangent[row, column] += along * scratch.change[0, column] + across * scratch.change[1, column]


@kernel(inline=True)
def _add_curvature(point: _Point, slope: Four, bend: Four, force: float, moment: float, tangent: FloatArray) -> None:
    """Add force times the second derivative of eps and moment times that of kappa in the centerline's vectors.

    The former is n n^T / |q|, the latter fold (n u^T + u n^T) + cross n n^T in q and q, -n u^T / |q| in q and w.
    """
    ux, uy = point.tangent_x, point.tangent_y
    fold, cross, turn = moment * point.fold, force / point.stretch + moment * point.cross, moment / point.stretch
    xx = -2.0 * fold * ux * uy + cross * uy * uy
    xy = fold * (ux * ux - uy * uy) - cross * ux * uy
    yy = 2.0 * fold * ux * uy + cross * ux * ux
    for a in range(4):
        for b in range(4):
            row, column = _first(a), _first(b)
            qq, qw, wq = slope[a] * slope[b], turn * slope[a] * bend[b], turn * bend[a] * slope[b]
            tangent[row, column] += qq * xx + (qw + wq) * ux * uy
            tangent[row, column + 1] += qq * xy + qw * uy * uy - wq * ux * ux
            tangent[row + 1, column] += qq * xy - qw * ux * ux + wq * uy * uy
            tangent[row + 1, column + 1] += qq * yy - (qw + wq) * ux * uy


@kernel(inline=True)
def _add_shear_products(by_position: float, twist: float, scratch: np.record, tangent: FloatArray) -> None:
    """Add the sum over the points of the moment times the second derivative of kappa in q and p, and in p alone."""
    for row in range(12):
        for column in range(12):
            tangent[row, column] += by_position * (
                scratch.pull[row] * scratch.by_shear[0, column]
                + scratch.by_shear[0, row] * scratch.pull[column]
                + twist * scratch.shear_curvature[row, column]
            )
