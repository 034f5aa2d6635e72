"""The contract of friction laws, and their registry."""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.kernel import KernelKinds
from beltdyn.kinds import Parameter


class FrictionParameters(Protocol):
    """Parameters of a friction law, a named tuple of numbers with its saturation."""

    def saturation(self, normal: ArrayLike, friction: ArrayLike, rim: ArrayLike) -> FloatArray:
        """Slip velocity at which friction saturates, m/s."""

    def smoothed(self, factor: float) -> Any:
        """The same law with its saturation at a slip velocity larger by a factor."""


def saturation_at(
    law: FrictionParameters,
    chosen: BoolArray,
    touched: IntArray,
    normal: FloatArray,
    friction: FloatArray,
    rim: FloatArray,
) -> FloatArray:
    """Slip velocities at which friction saturates at those points that are chosen, m/s.

    `chosen`, `touched`, `normal`: points, numbers of the pulleys that they touch, and normal forces (N/m), shape (...,
    points); `friction`, `rim`: coefficients of the pulleys, shape (P,), and speeds of their rims (m/s), shape (..., P).
    """
    pulley, (*states, _) = touched[chosen], np.nonzero(chosen)
    rims = np.broadcast_to(rim, (*touched.shape[:-1], rim.shape[-1]))
    return law.saturation(normal[chosen], friction[pulley], rims[(*states, pulley)])


class FrictionLaw(NamedTuple):
    """A friction law, for `register`."""

    name: str
    """Its name in a drive file."""
    record: type[Any]
    """Class of its parameters, a named tuple."""
    force: Callable[[Any, float, float, float, float], tuple[float, float, float, float]]
    """Kernel: from parameters, slip velocity v_t (m/s), normal force f_n >= 0 (N/m), coefficient mu and speed of the
    rim v_r (m/s) the force f_t (N/m) and its derivatives df_t/dv_t (N s/m^2), df_t/df_n and df_t/dv_r (N s/m^2)."""
    parameters: tuple[Parameter, ...]
    """Its keys in a drive file, in the order of the fields of the record."""


LAWS = KernelKinds[FrictionLaw]("friction law", FrictionLaw, "record")
"""All friction laws by their names."""
