"""First argument of the kernels of the paper's element.

Centerline of the belt element: cubic Hermite shape functions (Eqs. 2 and 6).

The centerline is carried by the four vectors r_i, r_x,i, r_j, r_x,j of an element, in this order everywhere.
"""

from math import sqrt
from typing import NamedTuple

from beltdyn.arrays import FloatArray
from beltdyn.elements.kind import Section
from beltdyn.kernel import kernel
from beltdyn.quadrature import Quadrature

Four = tuple[float, float, float, float]


@kernel
def slopes(xi: float, length: float) -> Four:
    """First derivatives of the shape functions with respect to x, whose combination is q = r_c,x.

    `xi`: dimensionless element coordinate x / L, 0 to 1; `length`: reference length L of the element, m. Returns
    factors of r_i (1/m), r_x,i (1), r_j (1/m), r_x,j (1).
    """
    chord = 6.0 * xi * (1.0 - xi) / length
    return -chord, 1.0 - xi * (4.0 - 3.0 * xi), chord, xi * (3.0 * xi - 2.0)


@kernel
def bends(xi: float, length: float) -> Four:
    """Second derivatives of the shape functions with respect to x, whose combination is w = r_c,xx.

    `xi`, `length`: as for `slopes`. Returns factors of r_i (1/m^2), r_x,i (1/m), r_j (1/m^2), r_x,j (1/m).
    """
    chord = (6.0 - 12.0 * xi) / (length * length)
    return -chord, (6.0 * xi - 4.0) / length, chord, (6.0 * xi - 2.0) / length


class Ancf(NamedTuple):
    """The element of the paper's section 2: nodal coordinates r (m), r_x, r_y of node i, then of node j (Eq. 6)."""

    section: Section
    elastic: Quadrature
    """Points and weights on [0, 1] along the element."""


class NodalShear(NamedTuple):
    """Sine of the shear angle at a node, s = sin(gamma), with what its derivatives are made of."""

    sine: float
    """s = -t . r_y / |r_y|, positive when the section leans back against the tangent."""
    cosine: float
    """n . r_y / |r_y|, 1 without shear."""
    tangent_x: float
    """Unit tangent t = r_x / |r_x| (Eq. 5)."""
    tangent_y: float
    stretch: float
    """|r_x|."""
    section_x: float
    """Unit vector of the section, r_y / |r_y|."""
    section_y: float
    thickness: float
    """|r_y|, thickness stretch of the section."""


@kernel
def nodal_shear(gradient_x: float, gradient_y: float, section_x: float, section_y: float) -> NodalShear:
    """Shear of the section at a node from its two gradients (Eqs. 3 and 5).

    Eq. 3 turns the tangent by 90 degrees and then by the shear angle, r_s = n - t sin(gamma), with cos(gamma) taken
    as 1; the nodal value is read from r_y, normalized so that a change of thickness is not taken for shear.

    `gradient_x`, `gradient_y`: r_x = dr/dx at the node; `section_x`, `section_y`: r_y = dr/dy at the node. Returns s
    and the directions that `shear_gradient` and `add_shear_curvature` need.
    """
    stretch = sqrt(gradient_x * gradient_x + gradient_y * gradient_y)
    thickness = sqrt(section_x * section_x + section_y * section_y)
    tx, ty = gradient_x / stretch, gradient_y / stretch
    sx, sy = section_x / thickness, section_y / thickness
    return NodalShear(-(tx * sx + ty * sy), tx * sy - ty * sx, tx, ty, stretch, sx, sy, thickness)


@kernel
def shear_gradient(shear: NodalShear) -> tuple[float, float, float, float]:
    """Derivative of s with respect to (r_x, r_y) of the node.

    With the directions a of r_x and b of r_y, s = -cos(a - b), da = n . dr_x / |r_x| and likewise for b.

    Returns ds/d(r_x), ds/d(r_y).
    """
    along, across = shear.cosine / shear.stretch, shear.cosine / shear.thickness
    return (
        along * shear.tangent_y,
        -along * shear.tangent_x,
        -across * shear.section_y,
        across * shear.section_x,
    )


@kernel
def add_shear_curvature(shear: NodalShear, factor: float, tangent: FloatArray, first: int) -> None:
    """Add factor times the second derivative of s with respect to (r_x, r_y) to a block of an element tangent.

    `shear`: from `nodal_shear`; `factor`: derivative of the energy with respect to s, J; `tangent`: changed in place,
    shape (12, 12); `first`: index of the node's r_x in the element's coordinates.
    """
    tx, ty, sx, sy = shear.tangent_x, shear.tangent_y, shear.section_x, shear.section_y
    s, c = factor * shear.sine, factor * shear.cosine
    x, y = first, first + 2
    scale = 1.0 / (shear.stretch * shear.stretch)
    _add_symmetric(
        tangent,
        x,
        scale * (-s * ty * ty - 2.0 * c * tx * ty),
        scale * (s * tx * ty + c * (tx * tx - ty * ty)),
        scale * (-s * tx * tx + 2.0 * c * tx * ty),
    )
    scale = 1.0 / (shear.thickness * shear.thickness)
    _add_symmetric(
        tangent,
        y,
        scale * (-s * sy * sy + 2.0 * c * sx * sy),
        scale * (s * sx * sy + c * (sy * sy - sx * sx)),
        scale * (-s * sx * sx - 2.0 * c * sx * sy),
    )
    scale = s / (shear.stretch * shear.thickness)
    for i, left in ((0, -ty), (1, tx)):
        for j, right in ((0, -sy), (1, sx)):
            tangent[x + i, y + j] += scale * left * right
            tangent[y + j, x + i] += scale * left * right


@kernel(inline=True)
def _add_symmetric(tangent: FloatArray, first: int, xx: float, xy: float, yy: float) -> None:
    """Add a symmetric 2 x 2 block on the diagonal of an element tangent."""
    tangent[first, first] += xx
    tangent[first, first + 1] += xy
    tangent[first + 1, first] += xy
    tangent[first + 1, first + 1] += yy
