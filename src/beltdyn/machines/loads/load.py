"""The contract of a load or motor: keys, constants, torque with exact derivatives, and kinks."""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray, blank, fill
from beltdyn.kernel import KernelKinds, interpreted, kernel
from beltdyn.machines.profiles import Schedule
from beltdyn.machines.profiles.harmonic import Harmonic
from beltdyn.machines.profiles.profile import Profile
from beltdyn.machines.tensioners.tensioner import MovingTensioner
from beltdyn.parts.part import Part


class ShaftState(NamedTuple):
    """State of a shaft, counter-clockwise positive, and the command of its load."""

    time: float
    """s."""
    angle: float
    """rad."""
    speed: float
    """rad/s."""
    command: float
    """Value of the load's profile `command`, in its unit; zero without."""
    state: float
    """State of the load's controller, rad or s; zero without."""
    error: float = 0.0
    """By which the load's sensor differs from its set value, m or N; zero without."""


class LoadTorque(NamedTuple):
    """Torque of a load on a shaft, counter-clockwise positive, and its derivatives."""

    torque: float
    """N m."""
    by_angle: float
    """N m/rad."""
    by_speed: float
    """N m s/rad."""
    by_command: float
    """N m over the unit of the command; zero without."""


class StateRate(NamedTuple):
    """Rate of the state of a load's controller, rad/s, and derivatives."""

    rate: float
    """rad/s."""
    by_speed: float
    """Of the rate with respect to the speed of the shaft, 1."""
    by_state: float
    """Of the rate with respect to the state, 1/s."""
    torque_by_state: float
    """Of the torque with respect to the state, N m/rad."""


class SensorSlope(NamedTuple):
    """Derivatives with respect to the error of a load's sensor."""

    torque: float
    """Of the torque, N m/m or N m/N."""
    rate: float
    """Of the rate of its state, in the unit of the rate over m or N."""


@kernel
def no_sensor(_constants: np.record, _numbers: FloatArray, _shaft: ShaftState) -> SensorSlope:
    """Derivatives of a load without a sensor."""
    return SensorSlope(0.0, 0.0)


@kernel
def no_state(_constants: np.record, _numbers: FloatArray, _shaft: ShaftState) -> StateRate:
    """State rate of a load without a state."""
    return StateRate(0.0, 0.0, 0.0, 0.0)


@kernel
def no_kink(_constants: np.record, _numbers: FloatArray, _shaft: ShaftState, _rising: bool) -> float:
    """Next kink of a torque that is smooth over the speed: none."""
    return np.inf


@kernel(inline=True)
def nearer_kink(kink: float, nearest: float, speed: float, rising: bool) -> float:
    """Nearer of two kinks ahead of a speed, rad/s.

    Parameters
    ----------
    kink
        Any kink.
    nearest
        The nearest of others ahead, infinite without any.
    speed
        rad/s.
    rising
        Whether the speed rises.
    """
    ahead = kink > speed if rising else kink < speed
    return kink if ahead and abs(kink - speed) < abs(nearest - speed) else nearest


class Load(Part):
    """A torque on the shaft, counter-clockwise positive, times its schedule and 1 + the sum of its harmonics.

    A kind of load is a class with a field `kind`, and says as class attributes what kernels need.
    """

    constants: ClassVar[np.dtype[np.void]]
    """Record of its constants; by default these are the fields of the same names."""
    torque_at: ClassVar[Callable[[np.record, FloatArray, ShaftState], LoadTorque]]
    """Kernel: the torque from constants, numbers and the state of the shaft, without schedule and harmonics."""
    next_kink: ClassVar[Callable[[np.record, FloatArray, ShaftState, bool], float]] = no_kink
    """Kernel: the next speed at which the torque has a kink, rad/s, infinite without any, from constants, numbers, the
    state of the shaft and whether its speed rises."""

    rate_at: ClassVar[Callable[[np.record, FloatArray, ShaftState], StateRate]] = no_state
    """Kernel: the rate of the state of its controller, from constants, numbers and the state of the shaft."""

    slope_at: ClassVar[Callable[[np.record, FloatArray, ShaftState], SensorSlope]] = no_sensor
    """Kernel: derivatives with respect to the error of its sensor, from the same."""

    signed: ClassVar[tuple[str, ...]] = ()
    """Fields whose sign is that of the sense of rotation: a number or a profile each."""

    if TYPE_CHECKING:
        kind: str

    schedule: Schedule | None = Field(None, description="the factor on the torque over time, from 0 to 1")
    harmonics: tuple[Harmonic, ...] = Field((), description="the harmonics of the torque over the shaft angle")

    def values(self) -> Mapping[str, Any]:
        """Values of its constants."""
        return {name: getattr(self, name) for name in self.constants.names or ()}

    def reversed(self) -> Self:
        """The load in the opposite sense of rotation: its torque changes sign with angle and speed."""
        given = {name: getattr(self, name) for name in self.signed}
        changed = {name: one.reversed() if isinstance(one, Profile) else -one for name, one in given.items()}
        return self.replace(**changed, harmonics=tuple(wave.reversed() for wave in self.harmonics))

    @property
    def numbers(self) -> Sequence[float] | FloatArray:
        """Numbers for its kernels besides the constants, an array of any shape (n,)."""
        return ()

    @property
    def factor(self) -> Profile | None:
        """The profile that multiplies its torque, by default its schedule."""
        return self.schedule

    @property
    def command(self) -> Profile | None:
        """The profile whose value is passed to its kernels, such as a set speed; None without one."""
        return None

    def held_at(self, at: float) -> Mapping[str, Any]:
        """Arguments that freeze it at an instant (s), besides its profiles; by default none."""
        return {}

    @property
    def state_lag(self) -> float | None:
        """Time constant of the state of its controller, s; None without a state."""
        return None

    @property
    def sensed(self) -> str | None:
        """Name of the pulley whose tensioner is its sensor; None without one."""
        return None

    @property
    def senses_force(self) -> bool:
        """Whether its sensor measures a force, by the spring of the tensioner."""
        return False

    def error_of(self, tensioner: MovingTensioner, arm: float) -> tuple[float, float]:
        """The error of its sensor over the coordinate of a tensioner, and at its zero.

        Parameters
        ----------
        tensioner
            The sensor.
        arm
            Way of the carried pulley's center over the coordinate, 1 or m/rad.
        """
        raise NotImplementedError

    @property
    def orders(self) -> Sequence[float]:
        """Orders of its torque: waves per turn of the shaft.

        The torque repeats itself with their largest common measure, and time steps resolve the highest.
        """
        return [wave.order for wave in self.harmonics]

    @property
    def has_mean(self) -> bool:
        """Whether its mean torque over the angle, without factor, depends only on command and shaft speed."""
        return self.state_lag is None

    def torque_over(self, angles: FloatArray, speed: float, time: float = 0.0) -> FloatArray:
        """Torque without factor and harmonics at angles (rad), a speed (rad/s) and an instant (s), N m.

        A controller counts as settled at its state zero.
        """
        constants, numbers = blank(self.constants), np.asarray(self.numbers, dtype=float)
        fill(constants, self.values())
        command = 0.0 if self.command is None else float(self.command.at([time])[0])
        torque = interpreted(type(self).torque_at)
        shafts = [ShaftState(time, float(one), speed, command, 0.0) for one in angles]
        return np.array([torque(constants, numbers, shaft).torque for shaft in shafts])

    @staticmethod
    def mean_numbers(constants: np.record, numbers: FloatArray) -> FloatArray:
        """Numbers that give the mean torque over the angle, without harmonics; by default the same.

        Parameters
        ----------
        constants
            Those of a load of this kind.
        numbers : ndarray, shape (n,)
            Its numbers.

        Returns
        -------
        ndarray, shape (n,)
        """
        return numbers

    @property
    def driven_speed(self) -> float:
        """Speed up to which it drives the shaft, with its sign, rad/s; zero for a load."""
        return 0.0


LOADS = KernelKinds[type[Load]]("load", Load)
"""All kinds of loads by name."""
