"""A tensioner sliding along a line: center c + q u."""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray, record
from beltdyn.kernel import kernel
from beltdyn.kinds import register
from beltdyn.machines.tensioners.tensioner import LEAST_LEVERAGE, SPRING, Center, Direction, SpringTensioner
from beltdyn.parts.quantity import Coordinate, Damping, Force, Length, Mass, Speed, Stiffness

SLIDE = record(
    center="2f8",  # c, the nominal center of the pulley, m
    direction="2f8",  # u, unit vector
    spring=SPRING,
)


@kernel
def sliding_center(constants: np.record, q: float) -> Center:
    """Center of the pulley on the line; constants are a row of `SLIDE`, q in m."""
    x, y = constants.center
    ux, uy = constants.direction
    return Center(x + q * ux, y + q * uy, ux, uy, 0.0, 0.0)


@register
class SlidingTensioner(SpringTensioner):
    """A pulley sliding along a line, pressed by a spring in `direction`.

    Examples
    --------
    >>> bd.model.SlidingTensioner(kind="sliding", pulley="idler", direction=[0, 1], preload="300 N", rate="2 N/mm").rate
    2000.0
    """

    constants = SLIDE
    center_at = sliding_center

    kind: Literal["sliding"] = Field(description="the kind of tensioner")
    direction: Direction = Field(description="the direction of the spring force on the pulley, as [x, y]")
    mass: Mass = Field(0.0, ge=0, description="the sliding mass without the pulley, in kg")
    preload: Force = Field(description="the spring force at the given pulley center, in N")
    rate: Stiffness = Field(0.0, ge=0, description="the spring rate, in N/m")
    damping: Damping = Field(0.0, ge=0, description="the viscous damping, in N*s/m")
    tensioning_friction: Force = Field(0.0, ge=0, description="the dry friction while the path lengthens, in N")
    yielding_friction: Force = Field(0.0, ge=0, description="the dry friction while the path shortens, in N")
    creep_speed: Speed = Field(1e-3, gt=0, description="the speed at which dry friction reaches 76 %, in m/s")
    stops: tuple[Coordinate, Coordinate] | None = Field(
        None, description="the lower and upper stops, from the given pulley center along the direction, in m"
    )
    travel: Length | None = Field(
        None,
        gt=0,
        description="the travel that the frame leaves to a take-up, for the sheet, in m; by default from stop to stop",
    )
    stop_stiffness: Stiffness | None = Field(None, gt=0, description="the stiffness of the stops, in N/m")
    stop_damping: Damping = Field(0.0, ge=0, description="the damping of the stops, in N*s/m")

    @property
    def frame_travel(self) -> float | None:
        """As in the base."""
        return super().frame_travel if self.travel is None else self.travel

    def leverage(self, center: FloatArray, gradient: FloatArray) -> float:
        """As in the base, along `direction`."""
        found = float(gradient @ np.array(self.direction))
        if found < LEAST_LEVERAGE:
            raise ValueError(
                f'the tensioner of "{self.pulley}" cannot tension the belt: a meter along its direction lengthens the '
                f"path by {found:.3g} m. Choose a direction that lengthens the path"
            )
        return found

    def values(self, center: FloatArray, gradient: FloatArray) -> Mapping[str, Any]:
        """As in the base."""
        self.leverage(center, gradient)
        return {"center": center, "direction": self.direction, "spring": self.spring}

    def moved_inertia(self, center: FloatArray, mass: float) -> float:
        """As in the base, kg."""
        return self.mass + mass

    def weighing_mass(self, mass: float) -> float:
        """As in the base."""
        return mass + self.mass

    def reach(self, center: FloatArray) -> float:
        """One meter a meter."""
        return 1.0
