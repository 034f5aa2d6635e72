"""The contract of a tensioner: keys, constants, position of its pulley, and force."""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from math import tanh
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, NamedTuple, Self

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from beltdyn.arrays import FloatArray, record
from beltdyn.errors import ModelError
from beltdyn.kernel import KernelKinds, kernel
from beltdyn.kinds import register
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Coordinate, Length, Name, Ratio

# A direction in the plane of the drive

_ROUNDING = 4 * np.finfo(float).eps


def _unit(vector: tuple[float, float]) -> tuple[float, float]:
    """Make a vector one meter long; one that is so already stays as it is."""
    length = float(np.hypot(*vector))
    if length == 0:
        raise ValueError("has zero length: at least one component must differ from zero")
    if abs(length - 1) <= _ROUNDING:
        return vector
    return vector[0] / length, vector[1] / length


Direction = Annotated[tuple[Ratio, Ratio], AfterValidator(_unit)]


# The force of spring-loaded tensioners: spring, viscous damper, dry friction and stops

SPRING = record(
    preload="f8",  # spring force at q = 0
    rate="f8",  # spring force lost in a unit of q
    damping="f8",  # viscous damping
    tensioning_friction="f8",  # dry friction while q grows
    yielding_friction="f8",  # dry friction while q falls
    creep_speed="f8",  # speed over which dry friction builds up
    lower="f8",  # lower stop, -inf where there is none
    upper="f8",  # upper stop, inf where there is none
    stop_stiffness="f8",  # stiffness of the stops
    stop_damping="f8",  # damping of the stops
)
"""Constants of a spring-loaded tensioner; q is in m or rad, forces in N or N m."""


class TensionerForce(NamedTuple):
    """Generalized force of a tensioner on its coordinate, positive where it lengthens the path, without weight."""

    force: float
    """N or N m."""
    by_position: float
    by_velocity: float
    energy: float
    """Stored since q = 0, J."""
    loss: float
    """Power lost, W."""


@kernel
def spring_force(constants: np.record, q: float, velocity: float) -> TensionerForce:
    """Force preload - k q - c v - dry friction + stops.

    `constants`: a row with a field `spring`, a row of `SPRING`; `q`, `velocity`: coordinate and its rate v, m and m/s,
    or rad and rad/s.
    """
    spring = constants.spring
    friction, friction_slope = dry_friction(spring, velocity)
    force = spring.preload - spring.rate * q - spring.damping * velocity - friction
    energy = (0.5 * spring.rate * q - spring.preload) * q
    by_position, by_velocity = -spring.rate, -spring.damping - friction_slope
    loss = (spring.damping * velocity + friction) * velocity
    if q > spring.upper:
        depth, side = q - spring.upper, 1.0
    elif q < spring.lower:
        depth, side = spring.lower - q, -1.0
    else:
        return TensionerForce(force, by_position, by_velocity, energy, loss)
    elastic, approach = spring.stop_stiffness * depth, side * velocity
    stop = elastic + spring.stop_damping * approach
    energy += 0.5 * elastic * depth
    if stop <= 0.0:
        return TensionerForce(force, by_position, by_velocity, energy, loss - elastic * approach)
    return TensionerForce(
        force - side * stop,
        by_position - spring.stop_stiffness,
        by_velocity - spring.stop_damping,
        energy,
        loss + spring.stop_damping * velocity * velocity,
    )


@kernel
def dry_friction(spring: np.record, velocity: float) -> tuple[float, float]:
    """Dry friction against the motion of a tensioner: f tanh(v / v_c), with an f for each sense.

    `spring`: a row of `SPRING`; `velocity`: v, m/s or rad/s, positive where the path gets longer. Returns friction,
    slope: friction, N or N m, which has the sign of the velocity, and its derivative, that for positive ones at zero.
    """
    largest = spring.tensioning_friction if velocity >= 0.0 else spring.yielding_friction
    rise = tanh(velocity / spring.creep_speed)
    return largest * rise, largest * (1.0 - rise * rise) / spring.creep_speed


LEAST_LEVERAGE = 1e-3
"""Least lengthening of the path per unit motion of the pulley's center."""


class Center(NamedTuple):
    """Center of a carried pulley, m, and its derivatives with respect to the coordinate q of the tensioner."""

    x: float
    y: float
    dx: float
    dy: float
    ddx: float
    ddy: float


class Tensioner(Part):
    """A movable support of a pulley."""

    if TYPE_CHECKING:
        kind: str

    turns: ClassVar[bool] = False
    """Whether it turns about a pivot, with numbers in rad and N m, in place of m and N along a line."""

    pulley: Name = Field(description="the name of its pulley")

    @abstractmethod
    def leverage(self, center: FloatArray, gradient: FloatArray) -> float:
        """Lengthening of the path per motion of the pulley's center, dL/ds.

        Parameters
        ----------
        center : ndarray, shape (2,), m
            Nominal center of the pulley.
        gradient : ndarray, shape (2,)
            Derivative of the length of the path with respect to the center.

        Returns
        -------
        float
            Meter of path for a meter along the line, or along the arc of the arm turned counter-clockwise.

        Raises
        ------
        ValueError
            If the tensioner cannot tension the belt.
        """

    @property
    def frame_travel(self) -> float | None:
        """Travel that the frame leaves to a take-up, m or rad; None where it is not stated."""
        return None

    @property
    def anchor(self) -> tuple[float, float] | None:
        """Pivot of its arm, m; None without one."""
        return None


class MovingTensioner(Tensioner):
    """A spring-loaded tensioner; its coordinate q is zero at the given center of the pulley.

    q grows where the path of the belt gets longer. The units of the numbers differ: m and N along a line, rad and
    N m about a pivot.
    """

    constants: ClassVar[np.dtype[np.void]]
    """Record of its constants, with a field `spring` where the force is that of `spring_force`."""
    center_at: ClassVar[Callable[[np.record, float], Center]]
    """Kernel: center of the pulley from constants and q."""
    force_at: ClassVar[Callable[[np.record, float, float], TensionerForce]] = spring_force
    """Kernel: generalized force from constants, q and its rate."""

    creep_speed: float = Field(1e-3, gt=0, description="the speed at which dry friction reaches 76 %, in SI units")
    stops: tuple[float, float] | None = Field(None, description="the lower and upper stops of q, in m or rad")
    stop_stiffness: float | None = Field(None, gt=0, description="the stiffness of the stops, in SI units")
    stop_damping: float = Field(0.0, ge=0, description="the damping of the stops, in SI units")

    @model_validator(mode="after")
    def _stops_hold_the_nominal_place(self) -> Self:
        if self.stops is None:
            if self.stop_stiffness is not None or self.stop_damping != 0:
                raise ValueError(
                    "stops is missing, but stop_stiffness or stop_damping is given. Give stops = [lower, upper]"
                )
            return self
        lower, upper = self.stops
        if not lower <= 0 <= upper or lower == upper:
            raise ValueError(
                f"stops = [{lower:g}, {upper:g}] must be a lower and an upper stop on both sides of zero, the given "
                "pulley center"
            )
        if self.stop_stiffness is None:
            raise ValueError("stop_stiffness is missing, but stops are springs. Give stop_stiffness")
        return self

    @property
    def frame_travel(self) -> float | None:
        """By default from stop to stop."""
        return None if self.stops is None else self.stops[1] - self.stops[0]

    @abstractmethod
    def values(self, center: FloatArray, gradient: FloatArray) -> Mapping[str, Any]:
        """Values of its constants; parameters and errors as for `leverage`."""

    @abstractmethod
    def moved_inertia(self, center: FloatArray, mass: float) -> float:
        """Inertia of the tensioner with its pulley, a point mass since it turns on its own: kg, or kg m^2.

        Parameters
        ----------
        center : ndarray, shape (2,), m
            Nominal center of the pulley.
        mass : float
            Mass of the pulley, kg.
        """

    @abstractmethod
    def weighing_mass(self, mass: float) -> float:
        """Mass at the pulley center with the same weight force on q as tensioner and pulley, kg.

        Parameters
        ----------
        mass : float
            Mass of the pulley, kg.
        """

    @abstractmethod
    def reach(self, center: FloatArray) -> float:
        """Travel of the pulley's center per unit of q: 1, or the length of the arm in m."""

    @property
    def spring(self) -> dict[str, float]:
        """Values of a row of `SPRING`: damper and dry friction, as far as the kind has them, and stops."""
        lower, upper = self.stops or (-np.inf, np.inf)
        of_motion = ("damping", "tensioning_friction", "yielding_friction", "creep_speed", "stop_damping")
        return {name: float(getattr(self, name, 0.0)) for name in of_motion} | {
            "lower": lower,
            "upper": upper,
            "stop_stiffness": self.stop_stiffness or 0.0,
        }

    def pushed(self, force: float) -> Self:
        """The same with a constant force on q besides its own, N or N m; ModelError of a kind that has no such form."""
        raise ModelError(
            f'the tensioner of "{self.pulley}" takes no further force: its kind does not define `pushed`, so that its '
            "tension after friction is left out. Define it, or give the tensioner no dry friction."
        )

    @property
    def force_unit(self) -> str:
        """Unit of forces on q."""
        return "N m" if self.turns else "N"

    def written(self, position: float) -> str:
        """Format a position, m or rad, with its unit."""
        return f"{np.degrees(position):.4g}°" if self.turns else f"{position:.4g} m"


class SpringTensioner(MovingTensioner):
    """A tensioner with a spring of constant rate: preload - rate q."""

    if TYPE_CHECKING:
        preload: float
        rate: float

    @property
    def spring(self) -> dict[str, float]:
        """As in the base, with preload and rate."""
        return super().spring | {"preload": self.preload, "rate": self.rate}

    def pushed(self, force: float) -> Self:
        """As in the base, by its preload."""
        return self.replace(preload=self.preload + force)


# A tensioner set before the drive runs


TENSIONERS = KernelKinds[type[Tensioner]]("tensioner", Tensioner)
"""All kinds of tensioners by name."""


@register
class FixedTensioner(Tensioner):
    """A pulley moved along a line before the drive runs, and held there.

    Examples
    --------
    >>> bd.model.FixedTensioner(kind="fixed", pulley="idler", direction=[0, 2], take_up="10 mm").take_up
    0.01
    """

    kind: Literal["fixed"] = Field(description="the kind of tensioner")
    direction: Direction = Field(description="the direction of the take-up, as [x, y]")
    take_up: Coordinate = Field(0.0, description="the displacement of the pulley from its center, in m")
    travel: Length | None = Field(
        None, gt=0, description="the travel that the frame leaves to a take-up, for the sheet, in m"
    )

    @property
    def frame_travel(self) -> float | None:
        """As in the base."""
        return self.travel

    def leverage(self, center: FloatArray, gradient: FloatArray) -> float:
        """As in the base, of whatever sign."""
        return float(gradient @ np.array(self.direction))
