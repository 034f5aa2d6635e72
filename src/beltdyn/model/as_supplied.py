"""Diameters of pulleys and angles of tensioner arms as suppliers give them, in place of radii, centers and preloads."""

from collections.abc import Iterator, Mapping, Sequence
from math import atan2, cos, degrees, pi, remainder, sin
from typing import Any, Literal

import numpy as np
from pydantic import Field, ValidationInfo

from beltdyn.arrays import FloatArray
from beltdyn.machines.tensioners.rotary import ArmAsSupplied, Sense
from beltdyn.model.belt import Belt, read_side
from beltdyn.model.pulley import ON_THE_BELT, Diameter, Pulley
from beltdyn.model.routing import fits
from beltdyn.model.toothing import FEWEST_TEETH, LARGEST_PITCH_ERROR, MOST_TEETH
from beltdyn.parts.messages import listing
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import (
    Coordinate,
    Count,
    Length,
    Name,
    Ratio,
    Torque,
    TorsionalStiffness,
    with_other_sense,
)

Rotation = Literal["counter-clockwise", "clockwise"]

_SENSES = {"counter-clockwise": 1.0, "clockwise": -1.0, None: 0.0}

_SAME_PLACE, _SAME_TORQUE = 1e-4, 0.02
"""Distance of two centers, m, and relative difference of two torques, that rounding on a sheet explains."""
_STOP_STIFFNESS = 4.0 * 180.0 / pi
"""Stiffness of a stop whose stiffness is not given, over the preload: it yields by 1 degree under four preloads."""


def as_supplied(data: Any, info: ValidationInfo) -> Any:
    """Turn diameters that depend on the belt into radii, and arms by angles into centers, preloads and stops."""
    if not isinstance(data, Mapping):
        return data
    values = dict(data)
    if values.get("rotation") == "clockwise" and isinstance(values.get("pulley"), Sequence):
        values["pulley"] = _in_clockwise_drive(values["pulley"])
    if isinstance(values.get("pulley"), Sequence):
        values["pulley"] = [_with_radius(one, values.get("belt"), info) for one in values["pulley"]]
        values["pulley"] = _with_toothed_radii(values["pulley"], values.get("belt"), info)
    if isinstance(values.get("tensioner"), Sequence):
        arms = [_with_arm(one, values.get("pulley") or ()) for one in values["tensioner"]]
        values["tensioner"] = [arm for arm, _ in arms]
        centers = {name: center for _, found in arms if found for name, center in (found,)}
        if centers:
            values["pulley"] = [_with_center(one, centers) for one in values["pulley"]]
    if isinstance(values.get("pulley"), Sequence) and not any(values.get(key) for key in _OPEN):
        values["pulley"] = _in_counter_clockwise_order(values["pulley"], values.get("belt"), info)
    return values


# Order of pulleys

_OPEN = ("end", "given_ends", "carriage", "unwinder", "nip", "nips")
"""Keys of drives whose order of pulleys has a beginning, or whose rollers stand beside the belt."""


def _in_counter_clockwise_order(pulleys: Sequence[Any], belt: Any, info: ValidationInfo) -> Sequence[Any]:
    """The pulleys of a closed belt, from the first one on the other way round if they are listed clockwise."""
    try:
        centers = np.array([_value(one, "center") for one in pulleys], dtype=float)
    except (TypeError, ValueError):  # in other units, or told where the pulley is read
        centers = np.zeros((0, 2))
    if len(centers) and (centers.ndim != 2 or _twice_the_area(centers) >= 0.0):
        return pulleys
    try:
        made = belt if isinstance(belt, Belt) else Belt.model_validate(belt, context=info.context)
        listed = [Pulley.model_validate(one, context=info.context) for one in pulleys]
        clockwise = not made.crossed and _twice_the_area(np.array([one.center for one in listed])) < 0.0
        if clockwise and not fits(listed, made) and fits([*listed[:1], *listed[:0:-1]], made):
            return [*pulleys[:1], *pulleys[:0:-1]]
    except ValueError:  # told where the belt and the pulley are read
        pass
    return pulleys


def _twice_the_area(points: FloatArray) -> float:
    """Twice the area of a polygon, positive where its corners, shape (n, 2), are listed counter-clockwise."""
    x, y = points.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


# Senses of rotation


def _in_clockwise_drive(given: Any) -> Any:
    """Values of pulleys with the senses that stand behind numbers exchanged, where positive numbers are clockwise."""
    if isinstance(given, str):
        return with_other_sense(given)
    if isinstance(given, Mapping):
        return {key: _in_clockwise_drive(one) for key, one in given.items()}
    return [_in_clockwise_drive(one) for one in given] if isinstance(given, list | tuple) else given


# Diameters


def _with_radius(pulley: Any, belt: Any, info: ValidationInfo) -> Any:
    """A pulley with the radius of its contact surface, if it is given by a diameter that depends on the belt."""
    if not isinstance(pulley, Mapping) or pulley.get("diameter") is None or pulley.get("radius") is not None:
        return pulley
    kind = pulley.get("diameter_kind")
    if kind not in ON_THE_BELT:
        return pulley
    try:
        made = belt if isinstance(belt, Belt) else Belt.model_validate(belt, context=info.context)
        diameter = Diameter.model_validate({"diameter": pulley["diameter"]}).diameter
    except ValueError:  # told where the belt and the pulley are read
        return pulley
    side = read_side(pulley.get("side", "inside"))
    radius = 0.5 * diameter - _excess(str(kind), made, side, str(pulley.get("name", "")))
    if not radius > 0.0:
        raise ValueError(
            f'the {kind} diameter of "{pulley.get("name")}", {1e3 * diameter:.4g} mm, leaves no radius for its '
            "surface. Increase it"
        )
    return _on_radius(pulley, radius)


def _on_radius(pulley: Mapping[str, Any], radius: float) -> dict[str, Any]:
    return {key: value for key, value in pulley.items() if key != "diameter"} | {"radius": radius}


def _excess(kind: str, belt: Belt, side: str, name: str) -> float:
    """By how much half of a diameter of a kind exceeds the radius of the contact surface, m."""
    entry = belt.entry
    sold = "outside" if entry is None else entry.pulley_diameter
    if kind == "pitch":
        return belt.offset("outside" if side == "outside" else "inside")
    if side == "outside":
        return 0.0
    if kind == "outside":
        return 0.0 if entry is None else entry.groove_height
    if entry is not None and kind != sold:
        raise ValueError(
            f'diameter_kind = "{kind}" of "{name}" is incompatible with profile "{belt.value_of("profile")}", whose '
            f'pulleys are sold by {sold} diameter. Set diameter_kind = "{sold}", "pitch" or "outside"'
        )
    return 0.0


# Teeth

_SAME_RADIUS = 1e-6
"""Difference of two radii of the same pulley, relative."""


class _Teeth(Part):
    teeth: Count = Field(ge=FEWEST_TEETH, le=MOST_TEETH)
    pitch_error: Ratio = Field(0.0, gt=-LARGEST_PITCH_ERROR, lt=LARGEST_PITCH_ERROR)
    radius: Length | None = None
    diameter: Length | None = None


def _with_toothed_radii(pulleys: Sequence[Any], belt: Any, info: ValidationInfo) -> list[Any]:
    """The pulleys, with the radius of those that have teeth."""
    if not any(_value(one, "teeth") is not None for one in pulleys):
        return list(pulleys)
    try:
        made = belt if isinstance(belt, Belt) else Belt.model_validate(belt, context=info.context)
    except ValueError:  # told where the belt is read
        made = None
    return [one if _value(one, "teeth") is None else _with_toothed_radius(one, made) for one in pulleys]


def _with_toothed_radius(pulley: Any, belt: Belt | None) -> Any:
    """A pulley with the radius of its outside, which follows from its teeth."""
    keys = _Teeth.model_fields
    try:
        own = _Teeth.model_validate({key: given for key in keys if (given := _value(pulley, key)) is not None})
    except ValueError:  # told where the pulley is read
        return _on_radius(pulley, 1.0) if isinstance(pulley, Mapping) else pulley
    if belt is None:
        return {"radius": 1.0, **pulley} if isinstance(pulley, Mapping) else pulley
    if belt.toothing is None:
        raise ValueError(
            f'"{_value(pulley, "name")}" has {own.teeth} teeth, but the belt has none. Give the belt a toothed profile '
            'such as "HTD 8M" and its teeth, or omit teeth of the pulley'
        )
    radius = belt.toothing.radius(own.teeth, own.pitch_error, belt.pitch_offset)
    if not radius > 0.0:
        raise ValueError(f'"{_value(pulley, "name")}" has too few teeth: {own.teeth} leave no radius. Give more')
    if isinstance(pulley, Pulley):
        same = abs(pulley.radius - radius) <= _SAME_RADIUS * radius
        return pulley if same else Pulley(**(pulley.arguments | {"radius": radius}))
    given = own.radius if own.diameter is None else 0.5 * own.diameter
    if given is not None and abs(given - radius) > _SAME_RADIUS * radius:
        pitch = 2.0 * pi * (given + belt.pitch_offset) / own.teeth / (1.0 + own.pitch_error)
        raise ValueError(
            f'"{pulley.get("name")}" has {own.teeth} teeth on an outside diameter of {2e3 * given:.5g} mm, a pitch of '
            f"{1e3 * pitch:.5g} mm, but the belt has a pitch of {1e3 * belt.toothing.pitch:.5g} mm. Omit radius and "
            "diameter, which follow from the teeth, or give its pitch_error"
        )
    return _on_radius(pulley, radius)


# Arms of rotary tensioners


class _Arm(ArmAsSupplied):
    """All that a sheet may give of an arm."""

    pulley: Name
    pivot: tuple[Coordinate, Coordinate]
    preload: Torque | None = None
    rate: TorsionalStiffness = 0.0
    sense: Sense | None = None


class _Place(Part):
    center: tuple[Coordinate, Coordinate] | None = None


def _with_arm(tensioner: Any, pulleys: Sequence[Any]) -> tuple[Any, tuple[str, tuple[float, float]] | None]:
    """A tensioner with preload, sense and stops, and its pulley with the nominal center, if its arm has angles."""
    keys = ArmAsSupplied.model_fields.keys()
    if not isinstance(tensioner, Mapping) or tensioner.get("kind") != "rotary" or keys.isdisjoint(tensioner):
        return tensioner, None
    try:
        arm = _Arm.model_validate({key: tensioner[key] for key in _Arm.model_fields if key in tensioner})
        pulley = next((one for one in pulleys if _value(one, "name") == arm.pulley), None)
        center = _Place.model_validate({"center": _value(pulley, "center")}).center
    except ValueError:  # told where the tensioner and the pulley are read
        return tensioner, None
    nominal = _nominal_angle(arm, center)
    rest = {key: value for key, value in tensioner.items() if key not in keys}
    length = arm.arm_length or float(np.hypot(*np.subtract(center or arm.pivot, arm.pivot)))
    if center is None:
        center = arm.pivot[0] + length * cos(nominal), arm.pivot[1] + length * sin(nominal)
    return rest | dict(_spring(arm, nominal, rest)), (arm.pulley, center)


def _nominal_angle(arm: _Arm, center: tuple[float, float] | None) -> float:
    """Angle of the arm with the spring torque `preload`, rad: by its pulley's center, or by angles."""
    found = None if center is None else atan2(center[1] - arm.pivot[1], center[0] - arm.pivot[0])
    if arm.arm_angle is None and found is None:
        needed = {"arm_length": arm.arm_length, "free_angle": arm.free_angle, "preload": arm.preload}
        missing = [key for key, value in (needed | {"rate": arm.rate or None, "sense": arm.sense}).items() if not value]
        if missing:
            raise ValueError(
                f'the nominal position of the tensioner of "{arm.pulley}" is open: {listing(missing)} missing. '
                "Give the center of its pulley, or arm_length with arm_angle, or with free_angle, preload, rate and "
                "sense"
            )
        assert arm.free_angle is not None
        assert arm.preload is not None
        return arm.free_angle - _SENSES[arm.sense] * arm.preload / arm.rate
    nominal = arm.arm_angle if arm.arm_angle is not None else found
    assert nominal is not None
    if center is None:
        if arm.arm_length is None:
            raise ValueError(
                f'arm_length of the tensioner of "{arm.pulley}" is missing. Give it, or the center of its pulley'
            )
        return nominal
    length = float(np.hypot(*np.subtract(center, arm.pivot)))
    away = np.subtract(center, arm.pivot) - (arm.arm_length or length) * np.array([cos(nominal), sin(nominal)])
    if float(np.hypot(*away)) > _SAME_PLACE:
        raise ValueError(
            f'the arm of the tensioner of "{arm.pulley}" holds its pulley {1e3 * float(np.hypot(*away)):.3g} mm away '
            f"from the given center: the center gives an arm of {1e3 * length:.5g} mm at {degrees(found or 0.0):.4g}°, "
            f"arm_length and arm_angle {1e3 * (arm.arm_length or length):.5g} mm at {degrees(nominal):.4g}°. Keep one"
        )
    return nominal


def _spring(arm: _Arm, nominal: float, given: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Preload, sense and stops of an arm with a nominal angle."""
    wound = None if arm.free_angle is None else remainder(arm.free_angle - nominal, 2.0 * pi)
    turns = None if wound is None else "counter-clockwise" if wound > 0.0 else "clockwise"
    if turns is not None and arm.sense is not None and arm.sense != turns:
        raise ValueError(
            f'sense = "{arm.sense}" of the tensioner of "{arm.pulley}" contradicts its angles: from '
            f"{degrees(nominal):.4g}° the spring turns the arm {turns} to free_angle = "
            f"{degrees(arm.free_angle or 0.0):.4g}°. Correct one of them"
        )
    sense = arm.sense or turns
    if sense is not None:
        yield "sense", sense
    preload = arm.preload
    if wound is not None:
        torque = arm.rate * abs(wound)
        if preload is None and torque == 0.0:
            raise ValueError(
                f'the rate of the tensioner of "{arm.pulley}" is missing, from which free_angle gives its preload'
            )
        if preload is not None and abs(torque - preload) > _SAME_TORQUE * preload:
            raise ValueError(
                f'preload = {preload:.4g} N m of the tensioner of "{arm.pulley}" contradicts its angles: '
                f"{degrees(abs(wound)):.4g}° from the nominal to the free arm give {torque:.4g} N m at its rate. "
                "preload is the torque at the nominal position; correct it, or omit it"
            )
        preload = torque if preload is None else preload
        yield "preload", preload
    if arm.load_stop_angle is None:
        return
    if sense is None:
        raise ValueError(
            f'sense of the tensioner of "{arm.pulley}" is missing: with load_stop_angle alone it is unknown to '
            "which side its spring turns the arm. Give sense or free_angle"
        )
    way = remainder(arm.load_stop_angle - nominal, 2.0 * pi) * _SENSES[sense]
    if not way < 0.0:
        raise ValueError(
            f'load_stop_angle = {degrees(arm.load_stop_angle):.4g}° of the tensioner of "{arm.pulley}" lies on the '
            f"side to which its spring turns the arm, {sense} from {degrees(nominal):.4g}°. The load stop is at the "
            "other end"
        )
    if "stops" in given:
        raise ValueError("stops and load_stop_angle exclude each other. Keep one of them")
    yield "stops", (way, pi if wound is None else abs(wound))
    if "stop_stiffness" not in given:
        yield "stop_stiffness", _STOP_STIFFNESS * float(preload or 1.0)


def _with_center(pulley: Any, centers: Mapping[str, tuple[float, float]]) -> Any:
    """A pulley with the nominal center that its arm gives it, if it has none."""
    name = _value(pulley, "name")
    if not isinstance(pulley, Mapping) or pulley.get("center") is not None or name not in centers:
        return pulley
    return {**pulley, "center": centers[name]}


def _value(part: Any, key: str) -> Any:
    """A value of a part that is a mapping or made already."""
    return part.get(key) if isinstance(part, Mapping) else getattr(part, key, None)
