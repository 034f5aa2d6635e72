"""Elastic force of the belt element and its exact tangent (Eq. 16).

The energy depends on the centerline, through the four vectors r_i, r_x,i, r_j, r_x,j, and on the nodal shears s_i
and s_j; beside them stands the thickness stretch of r_y.  Over the quadrature points the derivatives are gathered
with respect to these vectors and shears.  The shears are carried to r_x and r_y once, by their own first and second
derivatives.
"""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, record
from beltdyn.elements.ancf.element import (
    Ancf,
    Four,
    NodalShear,
    add_shear_curvature,
    bends,
    nodal_shear,
    shear_gradient,
    slopes,
)
from beltdyn.elements.kind import Section
from beltdyn.kernel import kernel
from beltdyn.stretch import stretching

# Strain energy of the belt element per length, with its first and second derivatives (Eqs. 8-15)


class EnergyGradient(NamedTuple):
    """First derivatives of the energy density psi(G, theta, s, p)."""

    metric: float
    """d psi / dG, N."""
    turning: float
    """d psi / d theta, N m."""
    sine: float
    """d psi / ds, N."""
    sine_rate: float
    """d psi / dp, N m."""


class EnergyCurvature(NamedTuple):
    """Second derivatives of psi(G, theta, s, p), named by the pair of arguments: g, t, s, p."""

    gg: float
    gt: float
    gs: float
    gp: float
    tt: float
    ts: float
    tp: float
    ss: float
    sp: float
    pp: float


@kernel
def energy_density(metric: float, turning: float, sine: float, sine_rate: float, section: Section) -> float:
    """Strain energy per reference length, closed over the section (Eqs. 14 and 15).

    With a = G - 1, k = theta + p, c = k^2 + s^2 theta^2:

        psi = W(G) + EI alpha2 / 2 (G k^2 + a c / 2) + E I4 alpha2 / 8 c^2
              + k_s G alpha2 / 2 (A G s^2 + I s^2 p^2)

    where W is the energy of the law of stretch, EA alpha1 / 8 a^2 of the published one.  The terms odd in y vanish over
    the symmetric section, so the stray "-1" printed in Eq. 11 has no effect.

    `metric`: G = r_c,x . r_c,x, dimensionless (shear modulus G appears only inside `section`); `turning`: theta, rate
    at which the tangent turns along the reference length, 1/m; `sine`: s = sin(gamma), dimensionless (Eq. 7);
    `sine_rate`: p = ds/dx, 1/m. Returns psi, J/m.
    """
    excess = metric - 1.0
    bend = turning + sine_rate
    lean = sine * turning
    spread = bend * bend + lean * lean
    return (
        stretching(section.stretch, metric).energy
        + section.bending / 2.0 * (metric * bend * bend + 0.5 * excess * spread)
        + section.quartic / 8.0 * spread * spread
        + 0.5 * sine * sine * (section.shear * metric + section.shear_gradient * sine_rate * sine_rate)
    )


@kernel
def energy_gradient(metric: float, turning: float, sine: float, sine_rate: float, section: Section) -> EnergyGradient:
    """First derivatives of `energy_density`; parameters as there."""
    excess = metric - 1.0
    bend = turning + sine_rate
    spread = bend * bend + (sine * turning) ** 2
    weight = 0.25 * (section.bending * excess + section.quartic * spread)
    moment = section.bending * metric * bend
    return EnergyGradient(
        stretching(section.stretch, metric).slope
        + 0.5 * section.bending * (bend * bend + 0.5 * spread)
        + 0.5 * section.shear * sine * sine,
        moment + weight * 2.0 * (bend + sine * sine * turning),
        sine * (weight * 2.0 * turning * turning + section.shear * metric + section.shear_gradient * sine_rate**2),
        moment + weight * 2.0 * bend + section.shear_gradient * sine * sine * sine_rate,
    )


@kernel
def energy_curvature(metric: float, turning: float, sine: float, sine_rate: float, section: Section) -> EnergyCurvature:
    """Second derivatives of `energy_density`; parameters as there."""
    excess = metric - 1.0
    bend = turning + sine_rate
    square = sine * sine
    spread = bend * bend + square * turning * turning
    weight = 0.25 * (section.bending * excess + section.quartic * spread)
    by_turning = 2.0 * (bend + square * turning)
    by_sine = 2.0 * sine * turning * turning
    by_rate = 2.0 * bend
    half, quarter = 0.25 * section.bending, 0.25 * section.quartic
    stiff = section.bending * metric
    return EnergyCurvature(
        stretching(section.stretch, metric).curvature,
        section.bending * bend + half * by_turning,
        half * by_sine + section.shear * sine,
        section.bending * bend + half * by_rate,
        stiff + weight * 2.0 * (1.0 + square) + quarter * by_turning * by_turning,
        weight * 4.0 * sine * turning + quarter * by_turning * by_sine,
        stiff + weight * 2.0 + quarter * by_turning * by_rate,
        weight * 2.0 * turning * turning
        + quarter * by_sine * by_sine
        + section.shear * metric
        + section.shear_gradient * sine_rate * sine_rate,
        quarter * by_sine * by_rate + 2.0 * section.shear_gradient * sine * sine_rate,
        stiff + weight * 2.0 + quarter * by_rate * by_rate + section.shear_gradient * square,
    )


@kernel
def thickness_energy(strain_i: float, strain_j: float, section: Section, length: float) -> float:
    """Energy of the thickness stretch, linear between its nodal values, J (second term of Eq. 8).

    `strain_i`, `strain_j`: eps_yy = (r_y . r_y - 1) / 2 at the two nodes; `length`: reference length of the element, m.
    """
    return section.thickness * length / 6.0 * (strain_i * strain_i + strain_i * strain_j + strain_j * strain_j)


ELASTIC_WORKSPACE = record(
    xx="(4,4)f8",  # d2U / d(x of vector a) d(x of vector b)
    xy="(4,4)f8",
    yy="(4,4)f8",
    by_shear="(2,12)f8",  # d2U / d(coordinate) d(s_k)
)
"""Scratch arrays of `element_force`."""


class ShearSums(NamedTuple):
    """Derivatives of the energy with respect to the nodal shears: dU/ds_k and d2U/ds_k ds_l."""

    i: float
    j: float
    ii: float
    ij: float
    jj: float


class _Strain(NamedTuple):
    """A quadrature point, and how q and w there change G = q . q and theta = (q x w) / G."""

    slope: Four
    """Factors of the centerline's vectors in q."""
    bend: Four
    """Factors of the centerline's vectors in w."""
    gx: float
    """dG/dq."""
    gy: float
    ax: float
    """dtheta/dq."""
    ay: float
    bx: float
    """dtheta/dw."""
    by: float


@kernel
def centreline(e: FloatArray, factors: Four) -> tuple[float, float]:
    """Combine the four centerline vectors of an element with the given factors.

    `e`: nodal coordinates r (m), r_x, r_y of node i, then of node j (Eq. 6), shape (12,); `factors`: `slopes` for q =
    r_c,x, `bends` for w = r_c,xx.
    """
    return (
        factors[2] * (e[6] - e[0]) + factors[1] * e[2] + factors[3] * e[8],
        factors[2] * (e[7] - e[1]) + factors[1] * e[3] + factors[3] * e[9],
    )


@kernel
def element_energy(element: Ancf, e: FloatArray, length: float) -> float:
    """Strain energy U of one element, J (Eqs. 8, 14 and 15); see `ElementKind.energy`."""
    shear_i = nodal_shear(e[2], e[3], e[4], e[5])
    shear_j = nodal_shear(e[8], e[9], e[10], e[11])
    points, weights, section = element.elastic.points, element.elastic.weights, element.section
    rate = (shear_j.sine - shear_i.sine) / length
    total = thickness_energy(_thickness_strain(e[4], e[5]), _thickness_strain(e[10], e[11]), section, length)
    for point in range(points.size):
        xi = points[point]
        qx, qy = centreline(e, slopes(xi, length))
        wx, wy = centreline(e, bends(xi, length))
        metric = qx * qx + qy * qy
        sine = (1.0 - xi) * shear_i.sine + xi * shear_j.sine
        total += weights[point] * length * energy_density(metric, (qx * wy - qy * wx) / metric, sine, rate, section)
    return total


@kernel
def element_force(element: Ancf, e: FloatArray, length: float, wanted: bool, work: np.record) -> None:
    """Gradient dU/de of the strain energy (the elastic force with the opposite sign, Eq. 16) and its exact tangent.

    Parameters
    ----------
    element
        Section and quadrature.
    e : ndarray, shape (12,)
        Nodal coordinates r (m), r_x, r_y of node i, then of node j (Eq. 6).
    length
        Reference length L, m.
    wanted
        Whether the tangent is.
    work
        Its `gradient` is overwritten by dU/de, N for the rows of r and N m for those of the gradients; its `tangent` by
        d2U/de2, or left alone. `elastic` is scratch.
    """
    shear_i = nodal_shear(e[2], e[3], e[4], e[5])
    shear_j = nodal_shear(e[8], e[9], e[10], e[11])
    scratch, gradient, tangent = work.elastic, work.gradient, work.tangent
    gradient[:] = 0.0
    if wanted:
        scratch.xx[:] = 0.0
        scratch.xy[:] = 0.0
        scratch.yy[:] = 0.0
        scratch.by_shear[:] = 0.0
    sines = shear_i.sine, shear_j.sine
    sums = ShearSums(0.0, 0.0, 0.0, 0.0, 0.0)
    for point in range(element.elastic.points.size):
        more = _add_point(element, e, length, point, sines, wanted, work)
        sums = ShearSums(sums.i + more.i, sums.j + more.j, sums.ii + more.ii, sums.ij + more.ij, sums.jj + more.jj)
    hi, hj = shear_gradient(shear_i), shear_gradient(shear_j)
    for c in range(4):
        gradient[2 + c] += sums.i * hi[c]
        gradient[8 + c] += sums.j * hj[c]
    if wanted:
        _fill_centreline(scratch, tangent)
        _carry_shear(shear_i, shear_j, hi, hj, sums, scratch, tangent)
    _add_thickness(element, e, length, wanted, work)


@kernel(inline=True)
def _add_point(
    element: Ancf, e: FloatArray, length: float, point: int, sines: tuple[float, float], wanted: bool, work: np.record
) -> ShearSums:
    """Add one quadrature point; gives its part of the derivatives with respect to the nodal shears.

    The energy density is a function of G = q . q, theta = (q x w) / G, s and p.  With g = dG/dq = 2 q and the
    derivatives a = dtheta/dq, b = dtheta/dw, its second derivatives in q and w are tensors made of g, a, b, the
    identity (from d2G) and the cross product (from d2(q x w)).
    """
    xi, weight = element.elastic.points[point], element.elastic.weights[point] * length
    slope, bend = slopes(xi, length), bends(xi, length)
    qx, qy = centreline(e, slope)
    wx, wy = centreline(e, bend)
    metric = qx * qx + qy * qy
    inverse = 1.0 / metric
    turning = (qx * wy - qy * wx) * inverse
    sine, rate = (1.0 - xi) * sines[0] + xi * sines[1], (sines[1] - sines[0]) / length
    first = energy_gradient(metric, turning, sine, rate, element.section)
    gx, gy = 2.0 * qx, 2.0 * qy
    ax, ay = (wy - turning * gx) * inverse, -(wx + turning * gy) * inverse
    bx, by = -qy * inverse, qx * inverse
    strain = _Strain(slope, bend, gx, gy, ax, ay, bx, by)
    _add_strain(work.gradient, strain, weight * first.metric, weight * first.turning)
    at_i, at_j, by_rate = 1.0 - xi, xi, 1.0 / length
    by_sine, by_sine_rate = weight * first.sine, weight * first.sine_rate * by_rate
    by_i, by_j = at_i * by_sine - by_sine_rate, at_j * by_sine + by_sine_rate
    if not wanted:
        return ShearSums(by_i, by_j, 0.0, 0.0, 0.0)

    second = energy_curvature(metric, turning, sine, rate, element.section)
    scratch = work.elastic
    gg, tt = weight * second.gg, weight * second.tt
    gt = weight * (second.gt - first.turning * inverse)
    direct = 2.0 * weight * (first.metric - first.turning * turning * inverse)
    cross = weight * first.turning * inverse
    ux, uy = gg * gx + gt * ax, gg * gy + gt * ay
    vx, vy = gt * gx + tt * ax, gt * gy + tt * ay
    _add_block(scratch.xx, slope, bend, ux * gx + vx * ax + direct, vx * bx, vx * bx, tt * bx * bx)
    _add_block(scratch.xy, slope, bend, ux * gy + vx * ay, vx * by + cross, vy * bx - cross, tt * bx * by)
    _add_block(scratch.yy, slope, bend, uy * gy + vy * ay + direct, vy * by, vy * by, tt * by * by)

    gs, gp = weight * second.gs, weight * second.gp * by_rate
    ts, tp = weight * second.ts, weight * second.tp * by_rate
    _add_strain(scratch.by_shear[0], strain, at_i * gs - gp, at_i * ts - tp)
    _add_strain(scratch.by_shear[1], strain, at_j * gs + gp, at_j * ts + tp)
    ss, sp, pp = weight * second.ss, weight * second.sp * by_rate, weight * second.pp * by_rate * by_rate
    return ShearSums(
        by_i,
        by_j,
        at_i * at_i * ss - 2.0 * at_i * sp + pp,
        at_i * at_j * ss + (at_i - at_j) * sp - pp,
        at_j * at_j * ss + 2.0 * at_j * sp + pp,
    )


@kernel(inline=True)
def _add_block(block: FloatArray, slope: Four, bend: Four, qq: float, qw: float, wq: float, ww: float) -> None:
    """Add slope_a qq slope_b + slope_a qw bend_b + bend_a wq slope_b + bend_a ww bend_b for all pairs (a, b)."""
    _add_row(block, 0, slope, bend, slope[0] * qq + bend[0] * wq, slope[0] * qw + bend[0] * ww)
    _add_row(block, 1, slope, bend, slope[1] * qq + bend[1] * wq, slope[1] * qw + bend[1] * ww)
    _add_row(block, 2, slope, bend, slope[2] * qq + bend[2] * wq, slope[2] * qw + bend[2] * ww)
    _add_row(block, 3, slope, bend, slope[3] * qq + bend[3] * wq, slope[3] * qw + bend[3] * ww)


@kernel(inline=True)
def _add_row(block: FloatArray, a: int, slope: Four, bend: Four, q: float, w: float) -> None:
    """Add q slope_b + w bend_b to row a."""
    block[a, 0] += q * slope[0] + w * bend[0]
    block[a, 1] += q * slope[1] + w * bend[1]
    block[a, 2] += q * slope[2] + w * bend[2]
    block[a, 3] += q * slope[3] + w * bend[3]


@kernel(inline=True)
def _add_strain(row: FloatArray, strain: _Strain, by_metric: float, by_turning: float) -> None:
    """Add by_metric dG/de + by_turning dtheta/de to a row, in the places of the centerline's vectors."""
    slope, bend = strain.slope, strain.bend
    qx, qy = by_metric * strain.gx + by_turning * strain.ax, by_metric * strain.gy + by_turning * strain.ay
    wx, wy = by_turning * strain.bx, by_turning * strain.by
    row[0] += slope[0] * qx + bend[0] * wx
    row[1] += slope[0] * qy + bend[0] * wy
    row[2] += slope[1] * qx + bend[1] * wx
    row[3] += slope[1] * qy + bend[1] * wy
    row[6] += slope[2] * qx + bend[2] * wx
    row[7] += slope[2] * qy + bend[2] * wy
    row[8] += slope[3] * qx + bend[3] * wx
    row[9] += slope[3] * qy + bend[3] * wy


@kernel(inline=True)
def _fill_centreline(scratch: np.record, tangent: FloatArray) -> None:
    """Overwrite the tangent by the centerline's part."""
    tangent[:] = 0.0
    for a in range(4):
        row = 6 * (a // 2) + 2 * (a % 2)
        for b in range(4):
            column = 6 * (b // 2) + 2 * (b % 2)
            tangent[row, column] = scratch.xx[a, b]
            tangent[row, column + 1] = scratch.xy[a, b]
            tangent[row + 1, column] = scratch.xy[b, a]
            tangent[row + 1, column + 1] = scratch.yy[a, b]


@kernel(inline=True)
def _carry_shear(
    shear_i: NodalShear,
    shear_j: NodalShear,
    hi: Four,
    hj: Four,
    sums: ShearSums,
    scratch: np.record,
    tangent: FloatArray,
) -> None:
    """Chain rule from the nodal shears to r_x and r_y of their nodes.

    With h_k = ds_k/de, the mixed derivatives m_k and the second derivatives c_kl of the energy in the shears, the
    tangent gains sum_k (m_k h_k^T + h_k m_k^T) + sum_kl c_kl h_k h_l^T + sum_k dU/ds_k d2s_k/de2; the second sum is
    folded into the m_k.
    """
    _add_four(scratch.by_shear, 0, 2, 0.5 * sums.ii, hi)
    _add_four(scratch.by_shear, 0, 8, sums.ij, hj)
    _add_four(scratch.by_shear, 1, 8, 0.5 * sums.jj, hj)
    _add_shear(0, 2, hi, scratch.by_shear, tangent)
    _add_shear(1, 8, hj, scratch.by_shear, tangent)
    add_shear_curvature(shear_i, sums.i, tangent, 2)
    add_shear_curvature(shear_j, sums.j, tangent, 8)


@kernel(inline=True)
def _add_shear(k: int, first: int, h: Four, mixed: FloatArray, tangent: FloatArray) -> None:
    """Add m_k h^T + h m_k^T to the tangent, h in the four columns that begin at first."""
    for row in range(12):
        m = mixed[k, row]
        _add_four(tangent, row, first, m, h)
        tangent[first, row] += m * h[0]
        tangent[first + 1, row] += m * h[1]
        tangent[first + 2, row] += m * h[2]
        tangent[first + 3, row] += m * h[3]


@kernel(inline=True)
def _add_four(matrix: FloatArray, row: int, first: int, factor: float, values: Four) -> None:
    """Add factor times four values to a row, from column first on."""
    matrix[row, first] += factor * values[0]
    matrix[row, first + 1] += factor * values[1]
    matrix[row, first + 2] += factor * values[2]
    matrix[row, first + 3] += factor * values[3]


@kernel(inline=True)
def _thickness_strain(section_x: float, section_y: float) -> float:
    """eps_yy = (r_y . r_y - 1) / 2 at a node."""
    return 0.5 * (section_x * section_x + section_y * section_y - 1.0)


@kernel(inline=True)
def _add_thickness(element: Ancf, e: FloatArray, length: float, wanted: bool, work: np.record) -> None:
    """Add force and tangent of the thickness energy to the rows of r_y."""
    gradient, tangent = work.gradient, work.tangent
    stiffness = element.section.thickness * length / 6.0
    strain_i, strain_j = _thickness_strain(e[4], e[5]), _thickness_strain(e[10], e[11])
    pressure_i, pressure_j = stiffness * (2.0 * strain_i + strain_j), stiffness * (2.0 * strain_j + strain_i)
    for row in range(2):
        gradient[4 + row] += pressure_i * e[4 + row]
        gradient[10 + row] += pressure_j * e[10 + row]
        if not wanted:
            continue
        tangent[4 + row, 4 + row] += pressure_i
        tangent[10 + row, 10 + row] += pressure_j
        for column in range(2):
            tangent[4 + row, 4 + column] += 2.0 * stiffness * e[4 + row] * e[4 + column]
            tangent[4 + row, 10 + column] += stiffness * e[4 + row] * e[10 + column]
            tangent[10 + row, 4 + column] += stiffness * e[10 + row] * e[4 + column]
            tangent[10 + row, 10 + column] += 2.0 * stiffness * e[10 + row] * e[10 + column]
