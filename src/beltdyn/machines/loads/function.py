"""A torque as a Python function of time, angle and speed; derivatives given or by central differences."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal, Self

import numpy as np
from pydantic import Field, PrivateAttr, field_serializer, field_validator

from beltdyn.arrays import FloatArray, record
from beltdyn.errors import ModelError
from beltdyn.kernel import kernel
from beltdyn.kernel.callback import address_of, call_at
from beltdyn.kinds import register
from beltdyn.machines.loads.load import Load, LoadTorque, ShaftState
from beltdyn.parts.quantity import AngularSpeed, Ratio

FUNCTION = record(
    torque="i8",  # address of the torque
    by_angle="i8",  # of its derivatives, zero without
    by_speed="i8",
    sense="f8",  # of positive angles, speeds and torques of the function: 1 counter-clockwise, -1 clockwise
)

_STEP = 1e-5
"""Half the distance of differences, rad, and rad/s or the part of a speed above 1 rad/s: a third of the digits."""


@kernel
def torque_of_function(constants: np.record, _numbers: FloatArray, shaft: ShaftState) -> LoadTorque:
    """Kernel of `Load.torque_at` for a row of `FUNCTION`: a function of time, angle and speed."""
    time, angle, speed = shaft.time, constants.sense * shaft.angle, constants.sense * shaft.speed
    torque = constants.sense * call_at(constants.torque, time, angle, speed)
    if constants.by_angle != 0:
        by_angle = call_at(constants.by_angle, time, angle, speed)
        return LoadTorque(torque, by_angle, call_at(constants.by_speed, time, angle, speed), 0.0)
    rise = _STEP * max(1.0, abs(speed))
    more, less = (
        call_at(constants.torque, time, angle + _STEP, speed),
        call_at(constants.torque, time, angle - _STEP, speed),
    )
    faster, slower = (
        call_at(constants.torque, time, angle, speed + rise),
        call_at(constants.torque, time, angle, speed - rise),
    )
    return LoadTorque(torque, (more - less) / (2.0 * _STEP), (faster - slower) / (2.0 * rise), 0.0)


@register
class FunctionLoad(Load):
    """A torque as a Python function of time (s), angle (rad) and speed (rad/s) of the shaft; not for drive files.

    Numba compiles functions that use only numbers and `math`. Others are run by Python, with a warning about the cost.

    Examples
    --------
    >>> fan = bd.model.FunctionLoad(function=lambda time, angle, speed: -2e-3 * speed * abs(speed))
    >>> driver, driven = drive.pulleys
    >>> drive = drive.replace(pulley=[driver, driven.replace(load=[fan])])
    """

    constants = FUNCTION
    torque_at = torque_of_function
    signed = ("drives_to",)

    kind: Literal["function"] = Field("function", description="the kind of load")
    function: Any = Field(description="the torque as a function of time, angle and speed, in N*m")
    derivatives: Any = Field(
        None,
        description="the derivatives of the torque with respect to angle and speed, two functions of the same "
        "arguments; by default differences",
    )
    highest_order: Ratio = Field(
        0.0, ge=0, description="the highest order over the angle, which time steps then resolve"
    )
    drives_to: AngularSpeed = Field(
        0.0, description="the speed up to which it drives the shaft, in rad/s; 0 for a load"
    )

    _sense: float = PrivateAttr(1.0)

    @field_validator("function")
    @classmethod
    def _is_a_function(cls, value: Any) -> Any:
        """A function, or the name of one, as a result file keeps it."""
        if not callable(value) and not isinstance(value, str):
            raise ValueError(f"must be a function of time, angle and speed, not {value!r}")
        return value

    @field_validator("derivatives")
    @classmethod
    def _are_two_functions(cls, value: Any) -> Any:
        two = isinstance(value, Sequence) and len(value) == 2
        if value is not None and not (two and all(callable(one) or isinstance(one, str) for one in value)):
            raise ValueError(f"must be two functions, the derivatives by angle and by speed, not {value!r}")
        return value

    @field_serializer("function", "derivatives", when_used="json")
    def _name(self, value: Any) -> Any:
        if isinstance(value, Sequence) and not isinstance(value, str):
            return [self._name(one) for one in value]
        return getattr(value, "__name__", value)

    @property
    def only_named(self) -> bool:
        """Whether it comes from a file, which keeps only the name of the function."""
        return isinstance(self.function, str)

    def reversed(self) -> Self:
        """As in the base: the function is called with the opposite angle and speed."""
        other = super().reversed()
        other._sense = -self._sense
        return other

    def values(self) -> Mapping[str, Any]:
        """Addresses of the functions, and their sense."""
        if self.only_named:
            raise ModelError(
                f'the function "{self.function}" of a load is not in the file, which holds only its name. In Python, '
                "replace the load by FunctionLoad(function=...)"
            )
        functions: list[Callable[[float, float, float], float]] = [self.function, *(self.derivatives or ())]
        addresses = [address_of(one) for one in functions]
        return {**dict(zip(self.constants.names or (), addresses, strict=False)), "sense": self._sense}

    @property
    def orders(self) -> Sequence[float]:
        """Orders of its harmonics, and the given highest order."""
        return [*super().orders, *([self.highest_order] if self.highest_order else [])]

    @property
    def has_mean(self) -> bool:
        """False: the dependence of a function is unknown."""
        return False

    @property
    def driven_speed(self) -> float:
        """The speed up to which it drives, rad/s."""
        return self.drives_to
