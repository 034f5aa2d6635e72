"""The contract of laws of the normal force, and their registry."""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol, Self

from beltdyn.kernel import KernelKinds
from beltdyn.kinds import Parameter


class NormalParameters(Protocol):
    """Parameters of a law of the normal force: a named tuple of numbers that begins with these two."""

    @property
    def stiffness(self) -> float:
        """k_p, N/m^2: the stiffness at rest, used by estimates of the belt at rest."""

    @property
    def damping(self) -> float:
        """c_p, N s/m^2."""

    def _replace(self, *, stiffness: float) -> Self:
        """A copy with another stiffness, as every named tuple makes it."""


class NormalForce(NamedTuple):
    """Normal force at a point, per m of reference length."""

    force: float
    """f_n along the outward normal, N/m."""
    by_penetration: float
    """df_n/dd, N/m^2."""
    by_rate: float
    """df_n/d(dd/dt), N s/m^2."""
    elastic: float
    """The elastic part of f_n, which depends on d only, N/m; the rest is dissipated."""
    energy: float
    """Integral of that part over d, J/m."""


class NormalLaw(NamedTuple):
    """A law of the normal force, for `register`."""

    name: str
    """Its name in a drive file."""
    record: type[Any]
    """Class of its parameters, a named tuple."""
    force: Callable[[Any, float, float], NormalForce]
    """Kernel: from parameters, penetration d >= 0 (m) and its rate (m/s) the force.  At d < 0 there is none."""
    parameters: tuple[Parameter, ...]
    """Its keys in a drive file beside `stiffness` and `damping`, in the order of the further fields of the record."""


LAWS = KernelKinds[NormalLaw]("normal law", NormalLaw, "record")
"""All laws of the normal force by their names."""
