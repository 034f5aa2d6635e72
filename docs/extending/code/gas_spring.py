"""A gas spring along a line: the force F (l / (l + q))^n of a gas column, with damper, dry friction and stops."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

from beltdyn.arrays import FloatArray
from beltdyn.extend import (
    SPRING,
    Center,
    Direction,
    MovingTensioner,
    TensionerForce,
    kernel,
    quantity,
    record,
    register,
    spring_force,
)

EXPONENT = 1.2
"""Polytropic exponent n: between slow motion, 1, and fast motion of nitrogen, 1.4."""
LEAST_LENGTH = 0.01
"""Length of the gas column over the nominal one, below which the force stays."""

GAS_SPRING = record(
    center="2f8",  # c, the nominal center of the pulley, m
    direction="2f8",  # u, unit vector
    force="f8",  # F, N
    column="f8",  # l, volume of the gas over the area of the rod, at the nominal center, m
    spring=SPRING,  # dry friction and stops
)


@kernel
def gas_spring_center(constants: np.record, q: float) -> Center:
    """Center of the pulley on the line; constants are a row of `GAS_SPRING`, q in m."""
    x, y = constants.center
    ux, uy = constants.direction
    return Center(x + q * ux, y + q * uy, ux, uy, 0.0, 0.0)


@kernel
def gas_spring_force(constants: np.record, q: float, velocity: float) -> TensionerForce:
    """Force of the gas, and of damper, dry friction and stops; constants are a row of `GAS_SPRING`."""
    column, rest = constants.column, spring_force(constants, q, velocity)
    length = max(column + q, LEAST_LENGTH * column)  # searches may look farther
    gas = constants.force * (column / length) ** EXPONENT
    full, left = constants.force * column / (EXPONENT - 1.0), gas * length / (EXPONENT - 1.0)
    return TensionerForce(
        gas + rest.force,
        rest.by_position - EXPONENT * gas / length,
        rest.by_velocity,
        left - full + rest.energy,
        rest.loss,
    )


@register
class GasSpring(MovingTensioner):
    """A pulley sliding along a line, pressed by a gas spring in `direction`."""

    constants = GAS_SPRING
    center_at = gas_spring_center
    force_at = gas_spring_force

    kind: Literal["gas_spring"] = Field(description="the kind of tensioner")
    direction: Direction = Field(description="the direction of the force on the pulley, as [x, y]")
    mass: Annotated[float, quantity("kg")] = Field(0.0, ge=0, description="the sliding mass without the pulley, in kg")
    force: Annotated[float, quantity("N")] = Field(gt=0, description="the force at the given pulley center, in N")
    column: Annotated[float, quantity("m")] = Field(
        gt=0, description="the volume of the gas over the area of the rod at the given pulley center, in m"
    )
    tensioning_friction: Annotated[float, quantity("N")] = Field(
        0.0, ge=0, description="the dry friction while the path lengthens, in N"
    )
    yielding_friction: Annotated[float, quantity("N")] = Field(
        0.0, ge=0, description="the dry friction while the path shortens, in N"
    )

    def leverage(self, center: FloatArray, gradient: FloatArray) -> float:
        """As in the base, along `direction`."""
        lengthening = float(gradient @ np.array(self.direction))
        if not lengthening > 0.0:
            raise ValueError(f'the gas spring of "{self.pulley}" slackens the belt. Turn its direction')
        return lengthening

    def values(self, center: FloatArray, gradient: FloatArray) -> Mapping[str, Any]:
        """As in the base."""
        self.leverage(center, gradient)
        gas = {"force": self.force, "column": self.column}
        return gas | {"center": center, "direction": self.direction, "spring": self.spring}

    def moved_inertia(self, center: FloatArray, mass: float) -> float:
        """As in the base, kg."""
        return self.mass + mass

    def weighing_mass(self, mass: float) -> float:
        """As in the base."""
        return self.mass + mass

    def reach(self, center: FloatArray) -> float:
        """One meter a meter."""
        return 1.0
