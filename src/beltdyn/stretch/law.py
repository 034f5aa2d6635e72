"""The contract of stretch laws, and their register."""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray


class StretchParameters(Protocol):
    """Parameters of a stretch law, a named tuple with tension over stretch and its inverse."""

    @property
    def stiffness(self) -> float:
        """EA, rate dN/dg without strain, N."""

    def tension(self, stretch: ArrayLike) -> FloatArray:
        """Tension N, N, at a stretch g, length over reference length."""

    def tangent_stiffness(self, stretch: ArrayLike) -> FloatArray:
        """Rate dN/dg at a stretch g, N."""

    def stretch(self, tension: ArrayLike) -> FloatArray:
        """Stretch g under a tension (N); 1 without tension."""


class Stretching(NamedTuple):
    """Strain energy of stretch per reference length over G = g^2; the tension is 2 g dW/dG."""

    energy: float
    """W, J/m."""
    slope: float
    """dW/dG, N."""
    curvature: float
    """d2W/dG2, N."""


class StretchLaw(NamedTuple):
    """A registered stretch law."""

    name: str
    """Its name in a drive file."""
    meaning: str
    """A short description."""
    record: type[Any]
    """Class of its parameters, a named tuple."""
    stretching: Callable[[Any, float], Stretching]
    """Kernel: from parameters and G the energy and its exact derivatives."""
    make: Callable[..., Any]
    """Parameters from the axial stiffness EA (N) of a belt, or from measured points."""
    from_points: bool = False
    """Whether it is made from measured strains and tensions (N)."""


LAWS: dict[str, StretchLaw] = {}
"""All stretch laws by name."""


def register(law: StretchLaw) -> None:
    """Register a stretch law."""
    LAWS[law.name] = law
