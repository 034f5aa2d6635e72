"""The contract of an element kind."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol

import numpy as np

from beltdyn.arrays import FloatArray
from beltdyn.elements.section import Section
from beltdyn.elements.tension import axial_tension
from beltdyn.kernel import kernel
from beltdyn.quadrature import Quadrature
from beltdyn.records import record


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
    """The angle itself: the `cubic_angle` of kinds whose centreline is a cubic."""
    return angle


@dataclass(frozen=True)
class ElementKind:
    """A belt element between two nodes, registered in `ELEMENTS`.

    A node has n coordinates, those of an element are e, shape (2 n,): of its first node, then of its second.  Part of
    them are v vectors of two components that carry the centreline, which consists of one or several Bezier curves.

    Attributes
    ----------
    name : str
        Value of ``belt.discretization``.
    meaning : str
        A phrase that says what it is.
    element : type
        Class of named tuples that begin with the fields of `Element`; kernels are found by it.
    coordinates : tuple of str
        Names of the coordinates of a material point, places first; n is their number times `points`.
    vectors : tuple of int
        Where in e the v vectors begin.
    shift : tuple of float
        What a shift of the whole belt does to each of them: 1 for places, 0 for derivatives.
    control : callable
        Control points from the vectors, shape (..., curves, degree + 1, v), for reference lengths (m), shape (...).
    scale : callable
        Lengths that turn changes of the n coordinates of a node into m, for a reference length of elements (m).
    mass : callable
        Mass matrices of elements, shape (..., 2 n, 2 n), from `Section` and reference lengths (m), shape (...).
    nodal : callable
        Coordinates of nodes, shape (N, n), on a curve: from places r, dr/dx and d2r/dx2 of the material points, each of
        shape (N points, 2).
    energy : kernel
        Strain energy, J, from (element, e, length).
    force : kernel
        Called with (element, e, length, wanted, work); overwrites ``work.gradient`` by dU/de, and ``work.tangent`` by
        d2U/de2 if that is wanted.
    damping : kernel
        Called with (element, e, velocity, length, factors, work); adds dR/d(de/dt) of the rate potential R to the
        gradient, and its derivatives times `DampingFactors` to the tangent. Gives the powers lost in stretch and in
        bending, W. By default there is none. An element through which the belt flows also adds d/d(de/dt) D e of it to
        ``work.by_flow``, with a tangent.
    tension : kernel
        Tension that results report, N, from (element, metric, rate): q . q with q = dr/dx, and its rate. By default
        `beltdyn.elements.tension.axial_tension`.
    scratch : mapping of str to str or dtype
        Further fields of ``work``, for `beltdyn.records.record`.
    points : int
        Material points of a node.
    turned : int
        Coordinate of a node with which the vector begins that a moment on the node turns; -1 if none does.
    has_ends : bool
        Whether a belt of such elements may be open, or closed by multipliers.
    cubic_angle : callable
        Angle of a pulley over which a cubic misses the circle as much as the element does over a given one (rad).
    bent_strain : float
        Strain of the centreline on a circle of radius R, without tension, over EI / (EA R^2).
    """

    name: str
    meaning: str
    element: type
    coordinates: tuple[str, ...]
    vectors: tuple[int, ...]
    shift: tuple[float, ...]
    control: Callable[[FloatArray | float], FloatArray]
    scale: Callable[[float], tuple[float, ...]]
    mass: Callable[[Section, FloatArray | float], FloatArray]
    nodal: Callable[[FloatArray, FloatArray, FloatArray], FloatArray]
    energy: Callable[..., float]
    force: Callable[..., None]
    damping: Callable[..., tuple[float, float]] = no_damping
    tension: Callable[..., float] = axial_tension
    scratch: Mapping[str, Any] = field(default_factory=dict)
    points: int = 1
    turned: int = -1
    has_ends: bool = True
    cubic_angle: Callable[[FloatArray], FloatArray] = as_cubic
    bent_strain: float = 0.0

    def __post_init__(self) -> None:
        ELEMENTS[self.name] = self

    @property
    def dof(self) -> int:
        """Number of coordinates of a node, n."""
        return self.points * len(self.coordinates)

    @property
    def curves(self) -> int:
        """Number of centreline curves of an element."""
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


ELEMENTS: dict[str, ElementKind] = {}
"""All element kinds by name."""
