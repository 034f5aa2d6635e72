"""The contract of stretch laws, and their registry."""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.kernel import KernelKinds
from beltdyn.kinds import Parameter


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
    """A stretch law, for `register`."""

    name: str
    """Its name in a drive file."""
    meaning: str
    """A short description."""
    record: type[Any]
    """Class of its parameters, a named tuple that begins with `stiffness`, EA in N."""
    stretching: Callable[[Any, float], Stretching]
    """Kernel: from parameters and G the energy and its exact derivatives."""
    parameters: tuple[Parameter, ...] = ()
    """Its keys in a drive file, in the order of the fields of the record behind `stiffness`."""
    through: Callable[[ArrayLike, ArrayLike], Any] | None = None
    """Its parameters from measured strains and tensions (N), if it is a law of measured points."""


LAWS = KernelKinds[StretchLaw]("stretch law", StretchLaw, "record")
"""All stretch laws by name."""
