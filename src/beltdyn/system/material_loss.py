"""Hysteresis of stretch and bending in an element: its law is `elements.planar_curve.hysteretic`.

Of an element with the reference length L it takes two strains, both of them means over the element: the elongation

    eps = (1/L integral of q . q dx - 1) / 2 - eps_0,    q = dr/dx,

beyond a strain eps_0 of reference, and the curvature kappa = (theta_j - theta_i) / L by the angles of the centerline
at both ends.  Bending without tension shortens the centerline by b kappa^2, which is no stretch: it is added to eps.
Means know no waves of the strain within an element, and a strain that passes from one element to the next loses the
same on any travelling mesh.  In a staying mesh nothing passes from element to element, and means would jump there:
bending is damped point by point (`elements.planar_curve.add_curve_damping`), and rows are of stretch alone.
"""

from math import atan2, comb

import numpy as np

from beltdyn.arrays import FloatArray, Records, record, records
from beltdyn.elements.planar_curve import Hysteretic, hysteretic
from beltdyn.kernel import kernel
from beltdyn.model import Belt
from beltdyn.model.hysteresis import SMOOTHED, Passing
from beltdyn.quadrature import gauss_points


def hysteresis_record(vectors: int) -> np.dtype[np.void]:
    """Kind of the rows of `add_hysteresis`, for a centerline of so many vectors."""
    return record(
        length="f8",  # reference length L, m
        axial="f8",  # modulus of stretch, N
        bending="f8",  # modulus of bending, N m^2
        strain="f8",  # strain of reference, eps_0
        shortening="f8",  # b, m^2
        stretch_length="f8",  # l of stretch, m
        bending_length="f8",  # l of bending, m
        metric=f"({vectors},{vectors})f8",  # 1/L integral of q . q dx from products of the vectors
        ends=f"(2,{vectors})f8",  # directions of the centerline at both ends from the vectors
        middle=f"{vectors}f8",  # mean place of both ends from the vectors
    )


def hysteresis_scratch(vectors: int) -> np.dtype[np.void]:
    """Kind of the scratch arrays of `add_hysteresis`."""
    size = 2 * vectors
    return record(
        strain="f8",  # beyond the reference
        strain_rate="f8",
        curvature="f8",
        curvature_rate="f8",
        square="f8",  # of the speed of the element, m^2/s^2
        by_strain=f"{size}f8",  # derivatives of strain, curvature and square of the speed
        by_curvature=f"{size}f8",
        by_speed=f"{size}f8",
        strain_drift=f"{size}f8",  # derivatives of the rates of strain and curvature by position
        curvature_drift=f"{size}f8",
        pull_by_rate=f"{size}f8",  # derivatives of both stresses times the length by the rates of the vectors
        moment_by_rate=f"{size}f8",
        pull=f"{size}f8",  # change of both stresses times the length by the unknowns
        moment=f"{size}f8",
        turning="(2,2,2)f8",  # second derivatives of the angles of both ends by their directions
    )


def hysteresis_rows(belt: Belt, length: FloatArray, control: FloatArray, passing: Passing | None) -> Records:
    """Rows of `hysteresis_record` for the elements of a belt; none for a belt without loss factors.

    Control points have shape (elements, curves, degree + 1, v). Strains pass by default from one element to the next,
    without strain at rest.
    """
    curves, count, vectors = control.shape[1:]
    kind = hysteresis_record(vectors)
    if not belt.has_hysteresis:
        return np.zeros(0, kind).view(np.recarray)
    passing = passing or Passing(0.0, belt.given_length / length.size, 0.0)
    xi, weights = gauss_points(count)
    bernstein = np.array([comb(count - 2, k) * xi**k * (1.0 - xi) ** (count - 2 - k) for k in range(count - 1)]).T
    slopes = (count - 1) * curves * bernstein @ np.diff(control, axis=2) / length[:, None, None, None]
    sides = np.diff(control[:, 0, :2], axis=1), np.diff(control[:, -1, -2:], axis=1)
    return records(
        kind,
        length=length,
        axial=np.full(length.size, passing.stretch_share * belt.stretch_loss_factor * belt.axial_stiffness),
        bending=np.full(length.size, passing.bending_share * belt.bending_loss_factor * belt.bending_stiffness),
        strain=np.full(length.size, passing.strain),
        shortening=np.full(length.size, -belt.bent_strain(np.ones(1))[0]),
        stretch_length=np.full(length.size, passing.stretch_length),
        bending_length=passing.bending_length + SMOOTHED * length,
        metric=np.einsum("p,ecpa,ecpb->eab", weights / curves, slopes, slopes),
        ends=np.concatenate(sides, axis=1),
        middle=0.5 * (control[:, 0, 0] + control[:, -1, -1]),
    )


@kernel
def add_hysteresis(
    own: np.record, vectors: tuple[int, ...], by_position: float, by_velocity: float, work: np.record
) -> tuple[float, float]:
    """Add the force of hysteresis on an element, with the opposite sign, and its exact tangent.

    `own`: row of the element, of `hysteresis_record`; `vectors`: where among the coordinates of the element the vectors
    begin that carry its centerline; `by_position`, `by_velocity`: the tangent is the sum of these times the derivatives
    with respect to e and to its rate; with both zero there is none; `work`: from `element_workspace`, with the
    coordinates e of the element and their rates. The force is added to `element.gradient`, and the tangent to
    `element.tangent`; `hysteresis` is scratch. Returns powers lost in stretch and in bending, W; never negative.
    """
    scratch, gradient, length = work.hysteresis, work.element.gradient, own.length
    _find_strains(own, vectors, work.coordinates, scratch)
    stretch = hysteretic(own.axial, scratch.strain, scratch.strain_rate, scratch.square, own.stretch_length)
    bend = hysteretic(own.bending, scratch.curvature, scratch.curvature_rate, scratch.square, own.bending_length)
    for a in range(len(vectors)):
        for axis in range(2):
            row = 2 * a + axis
            pull, moment = stretch.stress * scratch.by_strain[row], bend.stress * scratch.by_curvature[row]
            gradient[vectors[a] + axis] += length * (pull + moment)
    if by_position != 0.0 or by_velocity != 0.0:
        _fill_rates(stretch, bend, length, scratch)
        _add_tangent(own, vectors, stretch, bend, length * by_position, by_velocity, work)
    return length * stretch.stress * scratch.strain_rate, length * bend.stress * scratch.curvature_rate


@kernel
def add_hysteresis_flow(
    vectors: tuple[int, ...], derivative: FloatArray, rate: FloatArray, by_flow: float, work: np.record
) -> None:
    """Add what the belt's flow through an element does to the tangent of its hysteresis, after `add_hysteresis`.

    `vectors`: as there; `derivative`: D, vectors of dr/dx from those of r, 1/m, shape (v, v); `rate`: D e, shape (v,
    2); `by_flow`: the tangent is this times d/d(de/dt) D; `work`: as there; d/d(de/dt) D e is added to
    `element.by_flow`.
    """
    scratch, own = work.hysteresis, work.element
    pull_of_flow = moment_of_flow = 0.0
    for b in range(len(vectors)):
        for axis in range(2):
            pull, moment = 0.0, 0.0
            for k in range(len(vectors)):
                pull += scratch.pull_by_rate[2 * k + axis] * derivative[k, b]
                moment += scratch.moment_by_rate[2 * k + axis] * derivative[k, b]
            for a in range(len(vectors)):
                for side in range(2):
                    change = pull * scratch.by_strain[2 * a + side] + moment * scratch.by_curvature[2 * a + side]
                    own.tangent[vectors[a] + side, vectors[b] + axis] += by_flow * change
            pull_of_flow += scratch.pull_by_rate[2 * b + axis] * rate[b, axis]
            moment_of_flow += scratch.moment_by_rate[2 * b + axis] * rate[b, axis]
    for a in range(len(vectors)):
        for side in range(2):
            pull, moment = scratch.by_strain[2 * a + side], scratch.by_curvature[2 * a + side]
            own.by_flow[vectors[a] + side] += pull_of_flow * pull + moment_of_flow * moment


@kernel
def hysteresis_tension(own: np.record, vectors: tuple[int, ...], work: np.record) -> float:
    """What hysteresis adds to the tension of an element over |q|, N; as for `add_hysteresis`."""
    if own.axial == 0.0:
        return 0.0
    scratch = work.hysteresis
    _find_strains(own, vectors, work.coordinates, scratch)
    return hysteretic(own.axial, scratch.strain, scratch.strain_rate, scratch.square, own.stretch_length).stress


@kernel
def _find_strains(own: np.record, vectors: tuple[int, ...], coordinates: FloatArray, scratch: np.record) -> None:
    """Overwrite both strains, their rates, the square of the speed, and all their derivatives."""
    velocity = coordinates[1]
    speed_x = speed_y = 0.0
    for a in range(len(vectors)):
        speed_x += own.middle[a] * velocity[vectors[a]]
        speed_y += own.middle[a] * velocity[vectors[a] + 1]
    for a in range(len(vectors)):
        scratch.by_speed[2 * a] = 2.0 * own.middle[a] * speed_x
        scratch.by_speed[2 * a + 1] = 2.0 * own.middle[a] * speed_y
    scratch.square = speed_x * speed_x + speed_y * speed_y
    _find_curvature(own, vectors, coordinates, scratch)
    if own.axial != 0.0:
        _find_elongation(own, vectors, coordinates, scratch)
    else:  # nothing asks for it
        scratch.strain = scratch.strain_rate = 0.0
        scratch.by_strain[:] = 0.0
        scratch.strain_drift[:] = 0.0


@kernel(inline=True)
def _find_elongation(own: np.record, vectors: tuple[int, ...], coordinates: FloatArray, scratch: np.record) -> None:
    """Overwrite the elongation, its rate, and their derivatives; the curvature is known."""
    e, velocity = coordinates[0], coordinates[1]
    metric = strain_rate = 0.0
    for a in range(len(vectors)):
        x = y = vx = vy = 0.0
        for b in range(len(vectors)):
            part, i = own.metric[a, b], vectors[b]
            x, y = x + part * e[i], y + part * e[i + 1]
            vx, vy = vx + part * velocity[i], vy + part * velocity[i + 1]
        i = vectors[a]
        scratch.by_strain[2 * a], scratch.by_strain[2 * a + 1] = x, y
        scratch.strain_drift[2 * a], scratch.strain_drift[2 * a + 1] = vx, vy
        metric += x * e[i] + y * e[i + 1]
        strain_rate += x * velocity[i] + y * velocity[i + 1]
    bend, unbend = 2.0 * own.shortening * scratch.curvature, 2.0 * own.shortening * scratch.curvature_rate
    scratch.strain = 0.5 * (metric - 1.0) - own.strain + 0.5 * bend * scratch.curvature
    scratch.strain_rate = strain_rate + bend * scratch.curvature_rate
    for c in range(scratch.by_strain.size):
        scratch.by_strain[c] += bend * scratch.by_curvature[c]
        scratch.strain_drift[c] += unbend * scratch.by_curvature[c] + bend * scratch.curvature_drift[c]


@kernel
def _find_curvature(own: np.record, vectors: tuple[int, ...], coordinates: FloatArray, scratch: np.record) -> None:
    """Overwrite the curvature by the angles of both ends, its rate, and their derivatives."""
    e, velocity = coordinates[0], coordinates[1]
    scratch.curvature_rate = 0.0
    scratch.by_curvature[:] = 0.0
    scratch.curvature_drift[:] = 0.0
    first_x, first_y = 1.0, 0.0
    for end in range(2):
        side = (2.0 * end - 1.0) / own.length
        x, y, vx, vy = 0.0, 0.0, 0.0, 0.0
        for a in range(len(vectors)):
            factor = own.ends[end, a]
            if factor == 0.0:
                continue
            x += factor * e[vectors[a]]
            y += factor * e[vectors[a] + 1]
            vx += factor * velocity[vectors[a]]
            vy += factor * velocity[vectors[a] + 1]
        inverse = 1.0 / (x * x + y * y)
        squared = side * inverse * inverse
        across, along = squared * 2.0 * x * y, squared * (y * y - x * x)
        scratch.turning[end, 0, 0], scratch.turning[end, 0, 1] = across, along
        scratch.turning[end, 1, 0], scratch.turning[end, 1, 1] = along, -across
        slope_x, slope_y = -side * inverse * y, side * inverse * x
        for a in range(len(vectors)):
            factor = own.ends[end, a]
            if factor == 0.0:
                continue
            scratch.by_curvature[2 * a] += factor * slope_x
            scratch.by_curvature[2 * a + 1] += factor * slope_y
            scratch.curvature_drift[2 * a] += factor * (across * vx + along * vy)
            scratch.curvature_drift[2 * a + 1] += factor * (along * vx - across * vy)
        scratch.curvature_rate += slope_x * vx + slope_y * vy
        if end == 0:
            first_x, first_y = x, y
        else:
            scratch.curvature = atan2(first_x * y - first_y * x, first_x * x + first_y * y) / own.length


@kernel(inline=True)
def _fill_rates(stretch: Hysteretic, bend: Hysteretic, length: float, scratch: np.record) -> None:
    """Overwrite the derivatives of both stresses, times the length, by the rates of the vectors."""
    for c in range(scratch.by_speed.size):
        by_speed = scratch.by_speed[c]
        scratch.pull_by_rate[c] = length * (stretch.by_rate * scratch.by_strain[c] + stretch.by_square * by_speed)
        scratch.moment_by_rate[c] = length * (bend.by_rate * scratch.by_curvature[c] + bend.by_square * by_speed)


@kernel
def _add_tangent(
    own: np.record,
    vectors: tuple[int, ...],
    stretch: Hysteretic,
    bend: Hysteretic,
    by_position: float,
    by_velocity: float,
    work: np.record,
) -> None:
    """Add the tangent, with `_fill_rates` done before; `by_position` is that of `add_hysteresis` times the length."""
    scratch, tangent, count = work.hysteresis, work.element.tangent, len(vectors)
    stretched = by_position * stretch.stress
    turned = by_position * bend.stress + 2.0 * own.shortening * scratch.curvature * stretched
    for c in range(2 * count):
        stretching = stretch.by_strain * scratch.by_strain[c] + stretch.by_rate * scratch.strain_drift[c]
        bending = bend.by_strain * scratch.by_curvature[c] + bend.by_rate * scratch.curvature_drift[c]
        bending += 2.0 * own.shortening * stretch.stress * scratch.by_curvature[c]
        scratch.pull[c] = by_position * stretching + by_velocity * scratch.pull_by_rate[c]
        scratch.moment[c] = by_position * bending + by_velocity * scratch.moment_by_rate[c]
    for a in range(count):
        row, x, y = vectors[a], scratch.by_strain[2 * a], scratch.by_strain[2 * a + 1]
        bend_x, bend_y = scratch.by_curvature[2 * a], scratch.by_curvature[2 * a + 1]
        for b in range(count):
            column, along = vectors[b], stretched * own.metric[a, b]
            pull_x, pull_y = scratch.pull[2 * b], scratch.pull[2 * b + 1]
            moment_x, moment_y = scratch.moment[2 * b], scratch.moment[2 * b + 1]
            tangent[row, column] += x * pull_x + bend_x * moment_x + along
            tangent[row, column + 1] += x * pull_y + bend_x * moment_y
            tangent[row + 1, column] += y * pull_x + bend_y * moment_x
            tangent[row + 1, column + 1] += y * pull_y + bend_y * moment_y + along
    for end in range(2):
        for a in range(count):
            part = turned * own.ends[end, a]
            if part == 0.0:
                continue
            for b in range(count):
                factor = part * own.ends[end, b]
                if factor == 0.0:
                    continue
                for side in range(2):
                    for axis in range(2):
                        tangent[vectors[a] + side, vectors[b] + axis] += factor * scratch.turning[end, side, axis]
