"""What a load or motor provides: its keys, its constants, its torque with exact derivatives, and where that bends."""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.kernel import kernel
from beltdyn.machines.profiles.harmonic import Harmonic
from beltdyn.machines.profiles.registry import Schedule
from beltdyn.parts.part import Part


class LoadTorque(NamedTuple):
    """Torque of a load on a shaft, counter-clockwise positive, and its derivatives."""

    torque: float
    """N m."""
    by_angle: float
    """N m/rad."""
    by_speed: float
    """N m s/rad."""


@kernel
def no_kink(_constants: np.record, _points: FloatArray, _speed: float, _rising: bool) -> float:
    """Next kink of a torque that is smooth over the speed: none."""
    return np.inf


class Load(Part):
    """A torque on the shaft, counter-clockwise positive, times its schedule and 1 + the sum of its harmonics.

    A kind of load is a class with a field `kind`, and says as class attributes what kernels need.
    """

    constants: ClassVar[np.dtype[np.void]]
    """Record of its constants; by default these are the fields of the same names."""
    torque_at: ClassVar[Callable[[np.record, FloatArray, float, float], LoadTorque]]
    """Kernel: the torque from constants, points, angle (rad) and speed (rad/s), without schedule and harmonics."""
    next_kink: ClassVar[Callable[[np.record, FloatArray, float, bool], float]] = no_kink
    """Kernel: the next speed at which the torque has a kink, rad/s, infinite without any, from constants, points,
    speed and whether the speed rises."""

    if TYPE_CHECKING:
        kind: str

    schedule: Schedule | None = Field(None, description="the factor on the torque over time, from 0 to 1")
    harmonics: tuple[Harmonic, ...] = Field((), description="the harmonics of the torque over the angle of the shaft")

    def values(self) -> Mapping[str, Any]:
        """Values of its constants."""
        return {name: getattr(self, name) for name in self.constants.names or ()}

    @property
    def points(self) -> Sequence[tuple[float, float]]:
        """Points that its kernels get beside the constants, as many as it likes, as an array of shape (n, 2)."""
        return ()

    @property
    def driven_speed(self) -> float:
        """Speed up to which it drives the shaft, rad/s; zero of a load, which takes power from a shaft that turns."""
        return 0.0
