"""The contract of a tensioner: keys, constants, position of its pulley, and force."""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, Self

import numpy as np
from pydantic import Field, model_validator

from beltdyn.arrays import FloatArray
from beltdyn.machines.tensioners.spring import TensionerForce, spring_force
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Name

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

    pulley: Name = Field(description="the name of its pulley")

    @property
    def anchor(self) -> tuple[float, float] | None:
        """Pivot of its arm, m; None without one."""
        return None


class MovingTensioner(Tensioner):
    """A spring-loaded tensioner; its coordinate q is zero at the given center of the pulley.

    q grows where the path of the belt gets longer. The units of the numbers differ: m and N along a line, rad and
    N m about a pivot.
    """

    turns: ClassVar[bool] = False
    """Whether q is an angle: then numbers are in rad and N m, in place of m and N."""
    constants: ClassVar[np.dtype[np.void]]
    """Record of its constants, with a field `spring` where the force is that of `spring_force`."""
    center_at: ClassVar[Callable[[np.record, float], Center]]
    """Kernel: center of the pulley from constants and q."""
    force_at: ClassVar[Callable[[np.record, float, float], TensionerForce]] = spring_force
    """Kernel: generalised force from constants, q and its rate."""

    if TYPE_CHECKING:
        preload: float
        rate: float

    creep_speed: float
    stops: tuple[float, float] | None
    stop_stiffness: float | None
    stop_damping: float

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
            Metre of path for a metre along the line, or along the arc of the arm turned counter-clockwise.

        Raises
        ------
        ValueError
            If the tensioner cannot tension the belt.
        """

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
        """Values of a row of `SPRING`."""
        lower, upper = self.stops or (-np.inf, np.inf)
        stop_stiffness = self.stop_stiffness or 0.0
        own = ("preload", "rate", "damping", "tensioning_friction", "yielding_friction", "creep_speed", "stop_damping")
        return {name: getattr(self, name) for name in own} | {
            "lower": lower,
            "upper": upper,
            "stop_stiffness": stop_stiffness,
        }

    def written(self, position: float) -> str:
        """Format a position, m or rad, with its unit."""
        return f"{np.degrees(position):.4g}°" if self.turns else f"{position:.4g} m"
