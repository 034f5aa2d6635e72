"""The contract of an element kind."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import sqrt
from typing import Any, NamedTuple, Protocol

import numpy as np

from beltdyn.arrays import FloatArray, record
from beltdyn.kernel import KernelKinds, kernel
from beltdyn.quadrature import Quadrature
from beltdyn.stretch import StretchParameters, stretching

# Stiffness, damping and inertia of the belt's section, integrated over the thickness (Eqs. 8, 14 and 15)


class Section(NamedTuple):
    """The factors of Eqs. 14 and 15 after integration over the section, and the section's inertia and damping."""

    stretch: StretchParameters
    """Parameters of the law of stretch, E A alpha1 among them: `CommonStretch`, or a type of its own."""
    bending: float
    """E I alpha2, N m^2."""
    quartic: float
    """E I4 alpha2 with I4 = b h^5 / 80, N m^4."""
    shear: float
    """k_s G A alpha2, N."""
    shear_gradient: float
    """k_s G I alpha2, N m^2."""
    thickness: float
    """E A of the thickness stretch, N; no alpha touches it."""
    mass: float
    """rho A, kg/m."""
    rotary_inertia: float
    """rho I, kg m."""
    axial_damping: float = 0.0
    """E A alpha1 times the damping time of stretch, N s."""
    bending_damping: float = 0.0
    """E I alpha2 times the damping time of bending, N m^2 s."""
    bending_hysteresis: float = 0.0
    """Modulus of the hysteresis of bending that elements themselves take point by point, N m^2."""
    passing_length: float = 1.0
    """Length over which slow rates of bending are smoothed in it, m."""

    @property
    def axial(self) -> float:
        """E A alpha1 without strain, N."""
        return self.stretch.stiffness


@kernel(inline=True)
def is_damped(section: Section) -> bool:
    """Whether the material of a section has damping, or hysteresis of its own."""
    return section.axial_damping > 0.0 or section.bending_damping > 0.0 or section.bending_hysteresis > 0.0


# Tension by the stretch of the centerline, 2 g dW/dG, and by its rate


@kernel
def axial_force(law: StretchParameters, metric: float) -> float:
    """Tension carried by the stretch of the centerline, 2 sqrt(G) dW/dG, N.

    `metric`: G = q . q with q = dr/dx, dimensionless.
    """
    return 2.0 * stretching(law, metric).slope * metric**0.5


@kernel
def damping_tension(metric: float, metric_rate: float, section: Section) -> float:
    """Tension by the rate of stretch, EA alpha1 tau_s dg/dt with g = |q|, N: to be added to `axial_force`.

    `metric`, `metric_rate`: q . q and its rate, 1/s; `section`: with its factors of damping.
    """
    return 0.5 * section.axial_damping * metric_rate / sqrt(metric)


@kernel
def axial_tension(element: "Element", metric: float, metric_rate: float) -> float:
    """Tension of an element by the stretch law of its section, N: both parts."""
    return axial_force(element.section.stretch, metric) + damping_tension(metric, metric_rate, element.section)


class Element(Protocol):
    """First argument of the kernels of an element kind, a named tuple whose class identifies the kind."""

    @property
    def section(self) -> Section:
        """Stiffness, damping and inertia of the belt's section."""

    @property
    def elastic(self) -> Quadrature:
        """Integration points of elastic forces along an element."""


class DampingFactors(NamedTuple):
    """The tangent of damping is the sum of these times derivatives; with the first two zero there is none."""

    by_position: float
    """By the coordinates e."""
    by_velocity: float
    """By their rates."""
    by_flow: float
    """By the rates that follow the coordinates as D e, the vectors of dr/dx: the belt flows through the element at this
    speed, m/s. It is zero for elements that travel with the belt."""
    secant: bool = False
    """Hysteresis of bending changes by its secant from no rate, in place of its slope."""


@kernel
def no_damping(
    element: Element,
    e: FloatArray,
    velocity: FloatArray,
    length: float,
    factors: DampingFactors,
    work: np.record,
) -> tuple[float, float]:
    """Add nothing: the `damping` of undamped kinds."""
    return 0.0, 0.0


def as_cubic(angle: FloatArray) -> FloatArray:
    """The angle itself: the `cubic_angle` of kinds whose centerline is a cubic."""
    return angle


@dataclass(frozen=True)
class ElementKind:
    """A belt element between two nodes, for `register`.

    A node has n coordinates, those of an element are e, shape (2 n,): of its first node, then of its second.  Part of
    them are v vectors of two components that carry the centerline, which consists of one or several Bezier curves.
    """

    name: str
    """Value of ``belt.discretization``."""
    meaning: str
    """A phrase that says what it is."""
    element: type
    """Class of named tuples that begin with the fields of `Element`; kernels are found by it."""
    coordinates: tuple[str, ...]
    """Names of the coordinates of a material point, places first; n is their number times `points`."""
    vectors: tuple[int, ...]
    """Where in e the v vectors begin."""
    shift: tuple[float, ...]
    """What a shift of the whole belt does to each of them: 1 for places, 0 for derivatives."""
    control: Callable[[FloatArray | float], FloatArray]
    """Control points from the vectors, shape (..., curves, degree + 1, v), for reference lengths (m), shape (...)."""
    scale: Callable[[float], tuple[float, ...]]
    """Lengths that turn changes of the n coordinates of a node into m, for a reference length of elements (m)."""
    mass: Callable[[Section, FloatArray | float], FloatArray]
    """Mass matrices of elements, shape (..., 2 n, 2 n), from `Section` and reference lengths (m), shape (...)."""
    nodal: Callable[[FloatArray, FloatArray, FloatArray], FloatArray]
    """Coordinates of nodes, shape (N, n), on a curve: from places r, dr/dx and d2r/dx2 of the material points, each of
    shape (N points, 2)."""
    energy: Callable[..., float]
    """Kernel: strain energy, J, from (element, e, length)."""
    force: Callable[..., None]
    """Kernel: called with (element, e, length, wanted, work); overwrites ``work.gradient`` by dU/de, and
    ``work.tangent`` by d2U/de2 if that is wanted."""
    damping: Callable[..., tuple[float, float]] = no_damping
    """Kernel: called with (element, e, velocity, length, factors, work); adds dR/d(de/dt) of the rate potential R to
    the gradient, and its derivatives times `DampingFactors` to the tangent. Gives the powers lost in stretch and in
    bending, W. By default there is none. An element through which the belt flows also adds d/d(de/dt) D e of it to
    ``work.by_flow``, with a tangent."""
    tension: Callable[..., float] = axial_tension
    """Kernel: tension that results report, N, from (element, metric, rate): q . q with q = dr/dx, and its rate. By
    default `beltdyn.elements.kind.axial_tension`."""
    scratch: Mapping[str, Any] = field(default_factory=dict)
    """Further fields of ``work``, for `beltdyn.arrays.record`."""
    points: int = 1
    """Material points of a node."""
    turned: int = -1
    """Coordinate of a node with which the vector begins that a moment on the node turns; -1 if none does."""
    has_ends: bool = True
    """Whether a belt of such elements may be open, or closed by multipliers."""
    cubic_angle: Callable[[FloatArray], FloatArray] = as_cubic
    """Angle of a pulley over which a cubic misses the circle as much as the element does over a given one (rad)."""
    bent_strain: float = 0.0
    """Strain of the centerline on a circle of radius R, without tension, over EI / (EA R^2)."""

    @property
    def dof(self) -> int:
        """Number of coordinates of a node, n."""
        return self.points * len(self.coordinates)

    @property
    def curves(self) -> int:
        """Number of centerline curves of an element."""
        return len(self.control(1.0))

    @property
    def is_damped(self) -> bool:
        """Whether its material can have damping."""
        return self.damping is not no_damping

    @property
    def workspace(self) -> np.dtype[np.void]:
        """Record type of the scratch and result rows of `force` and `damping`."""
        size = 2 * self.dof
        return record(gradient=f"{size}f8", by_flow=f"{size}f8", tangent=f"({size},{size})f8", **self.scratch)


ELEMENTS = KernelKinds[ElementKind]("element", ElementKind, "element")
"""All element kinds by name."""
