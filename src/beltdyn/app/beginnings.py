"""What new groups of a drive file begin with: valid numbers, with which they act at once and as their kind says."""

import ast
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from beltdyn.app import placing
from beltdyn.app.forms import Field, fields, pulley_at, schema_of, value_at
from beltdyn.errors import ModelError
from beltdyn.machines.loads.brake import Holdback
from beltdyn.machines.loads.load import LOADS, Load
from beltdyn.model import Drive
from beltdyn.parts.quantity import RPM, to_si
from beltdyn.parts.toml_edits import Edit, Location

_EXAMPLE = re.compile(r"^(?:>>>|\.\.\.) (.*)$", re.MULTILINE)
_OF_UNITS = {"rad/s": "1500 rpm", "N*m": "5 N m", "N": "100 N", "Pa": "5 MPa", "W": "1 kW", "": 1.0}
"""What profiles rise to, by their unit."""
_OPPOSING = "-5 N m"
"""Torque on a pulley that turns counter-clockwise."""
_TIMES = {"start": (0.02,), "end": (0.2,), "time": (0.1,), "times": (0.0, 0.2)}
"""Instants of profiles, s; of shorter runs than `_USUAL_DURATION` they are earlier."""
_USUAL_DURATION = 0.4
"""Duration of a run, s, for which the instants of profiles are proposed as they stand."""
_BY_SUPPLY = ("induction_motor",)
"""Loads whose speeds follow from the frequency of the supply."""
_SHARES = {"cut_in_speed": 0.3, "synchronous_speed": 1.05}
"""Speeds of loads over that of their pulley."""
_LOAD_PATH_LENGTH = 4
"""Length of the location of a load: "pulley", its number, "load", its number."""
_ANGLE_COUNT = 73
"""Number of angles of two turns over which the torque of a load is averaged: one every 10°."""


def beginning(
    data: Mapping[str, Any], location: Location, kind: str | None, drive: Drive | None = None
) -> dict[str, Any]:
    """Valid values of a group of a kind that is put at a location; empty where its kind documents none.

    `data` hold the group already, with its kind alone.
    """
    given = {"kind": kind} if kind else {}
    listed = {one.key: one for one in fields(data, location)}
    example = {key: value for key, value in _example(data, location).items() if key in listed}
    found = {key: example[key] for key in listed if key in example}
    for one in listed.values():
        if one.form == "choice" and one.choices and one.key in found and found[one.key] not in one.choices:
            found[one.key] = one.choices[0]  # a name in the drive of the example
        if one.key not in found and (one.required or one.key in ("times", "values", "angles")):
            value = _usual(one, data, drive)
            if value is not None:
                found[one.key] = value
    begun = given | {key: _at_once(value) for key, value in found.items()}
    if drive is None or location[2:3] != ("load",) or len(location) != _LOAD_PATH_LENGTH:
        return begun
    speed = _speed(drive, data, location)
    return _in_sense(_at_speed(begun, listed, speed), speed, drive.positive_sense)


def _at_once(value: Any) -> Any:
    """A profile that steps or rises at some time as a constant: the drive may have ended before."""
    if isinstance(value, Mapping) and "value" in value and value.get("kind") not in (None, "constant"):
        return {"kind": "constant", "value": value["value"]}
    return value


def _speed(drive: Drive | None, data: Mapping[str, Any], location: Location) -> float:
    """Largest speed of the pulley at a location without slip, as the file counts it, rad/s; zero if none is known."""
    if drive is None or drive.driver is None or location[0] != "pulley":
        return 0.0
    try:
        number = pulley_at(drive, data, location)
    except ModelError:
        return 0.0
    radii, end = np.abs(drive.path.radii), drive.simulation.end
    sense = drive.running_sense * drive.pulleys[number].turning * drive.positive_sense
    return float(sense * drive.pulleys[drive.driver].driven_speed(end) * radii[drive.driver] / radii[number])


def _at_speed(begun: dict[str, Any], listed: Mapping[str, Field], speed: float) -> dict[str, Any]:
    """A load whose speeds are those of a pulley, rad/s: full load at that speed, a set speed of the same."""
    keys = [key for key in begun if key in listed and "rad/s" in (listed[key].unit, listed[key].unit_of_values)]
    if not speed or begun["kind"] in _BY_SUPPLY:
        return begun
    at_pulley = dict(begun)
    for key in keys:
        if isinstance(begun[key], list):
            speeds = [to_si(value, "rad/s") if isinstance(value, str) else value for value in begun[key]]
            at_pulley[key] = [_rpm(abs(speed) * value / max(map(abs, speeds))) for value in speeds]
        elif isinstance(begun[key], Mapping):
            at_pulley[key] = {"kind": "constant", "value": _rpm(abs(speed))}
        else:
            at_pulley[key] = _rpm(_SHARES.get(key, 1.0) * abs(speed))
    return at_pulley


def _rpm(speed: float) -> str:
    return f"{speed * RPM:.4g} rpm"


def _in_sense(begun: dict[str, Any], speed: float, positive_sense: int) -> dict[str, Any]:
    """A load that drives a pulley of some speed (rad/s), or opposes it, by its kind; a holdback lets it turn."""
    try:
        load = LOADS[begun["kind"]].model_validate(begun)
    except ValueError:
        return begun
    if isinstance(load, Holdback):
        other = "clockwise" if speed * positive_sense >= 0.0 else "counter-clockwise"
        return begun if load.holds == other else begun | {"holds": other}
    if not speed or not _is_against_its_kind(load, speed):
        return begun
    old, new = load.model_dump(mode="json"), load.reversed().model_dump(mode="json")
    return begun | {key: _rounded(value) for key, value in new.items() if value != old[key]}


def _is_against_its_kind(load: Load, speed: float) -> bool:
    """Whether a load on a pulley of some speed (rad/s) drives it though it is none that drives, or the opposite."""
    drives = bool(load.driven_speed)
    torque = load.torque_over(np.linspace(0.0, 4.0 * np.pi, _ANGLE_COUNT), 0.0 if drives else speed).mean()
    return float(torque) * speed < 0.0 if drives else float(torque) * speed >= 0.0


def _rounded(value: Any) -> Any:
    """Values with five digits."""
    if isinstance(value, Mapping):
        return {key: _rounded(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_rounded(item) for item in value]
    return float(f"{value:.5g}") if isinstance(value, float) else value


def _example(data: Mapping[str, Any], location: Location) -> dict[str, Any]:
    """Arguments of the class in the example of its description, where they are plain data."""
    code = "\n".join(_EXAMPLE.findall(str(schema_of(data, location).get("description", ""))))
    try:
        statements = ast.parse(code)
    except SyntaxError:
        return {}
    for call in (node for node in ast.walk(statements) if isinstance(node, ast.Call)):
        if call.keywords and not call.args:
            try:
                return {str(one.arg): ast.literal_eval(one.value) for one in call.keywords if one.arg != "kind"}
            except ValueError:
                return {}
    return {}


def _usual(one: Field, data: Mapping[str, Any], drive: Drive | None) -> Any:
    """A usual value of a required key."""
    if one.key in _TIMES:
        run = _USUAL_DURATION if drive is None else min(drive.simulation.end - drive.simulation.begin, _USUAL_DURATION)
        instants = [run / _USUAL_DURATION * instant for instant in _TIMES[one.key]]
        return instants if one.key == "times" else instants[0]
    if one.key in ("value", "values"):
        rises_to = _level(one, data, drive)
        return rises_to if one.key == "value" else [0.0, rises_to]
    if one.form == "group" and one.choices:
        return {"kind": "constant", "value": _OF_UNITS.get(one.unit_of_values, 1.0)}
    return one.example


def _level(one: Field, data: Mapping[str, Any], drive: Drive | None) -> Any:
    """What a profile rises to: the torque on a pulley opposes its rotation."""
    level = _OF_UNITS.get(one.unit, 1.0)
    if one.location[0] == "pulley" and one.location[2] == "torque" and drive is not None:
        return level if _speed(drive, data, one.location) < 0.0 else _OPPOSING
    return level


def edits_of_kind(
    data: Mapping[str, Any], location: Location, kind: str | None, drive: Drive | None = None
) -> list[Edit]:
    """Edits that change the kind of a group and keep common values, or remove it with None; others begin as usual."""
    group = value_at(data, location)
    if kind is None:
        return [] if group is None else [Edit("remove", location)]
    if isinstance(group, Mapping) and group.get("kind") == kind:
        return []
    tried = _with(data, location, {"kind": kind})
    known = {one.key for one in fields(tried, location)}
    kept = {key: value for key, value in group.items() if key in known} if isinstance(group, Mapping) else {}
    begun = beginning(tried, location, kind, drive)
    points = {key for key, value in begun.items() if isinstance(value, list)}
    if not points <= kept.keys():  # columns of points belong together
        kept = {key: value for key, value in kept.items() if key not in points}
    return [Edit("set", location, {**begun, **kept, "kind": kind})]


def edits_of_entry(
    data: Mapping[str, Any], location: Location, kind: str | None, drive: Drive | None = None
) -> list[Edit]:
    """Edits that append an entry to a list, with its kind if any, which begins with usual numbers."""
    entries = value_at(data, location)
    listed = entries if isinstance(entries, list) else []
    first = {"kind": kind} if kind else {}
    place = (*location, len(listed))
    made = beginning(_with(data, location, [*listed, first]), place, kind, drive)
    if entries is not None and not isinstance(entries, list):
        return [Edit("set", location, [made])]
    return [Edit("insert", place, made), *(placing.rim(data, location) if location[-1] == "hub" else [])]


def edits_of_group(data: Mapping[str, Any], location: Location) -> list[Edit]:
    """Edits that give a group without kinds, which begins with usual numbers."""
    return [Edit("set", location, beginning(_with(data, location, {}), location, None))]


def _with(data: Mapping[str, Any], location: Location, value: Any) -> dict[str, Any]:
    """Data with another value at one place, whose way is there."""
    if len(location) == 1:
        return {**data, str(location[0]): value}
    inner = data.get(str(location[0]))
    return {**data, str(location[0]): _inside(inner, location[1:], value)}


def _inside(data: Any, location: Location, value: Any) -> Any:
    step, rest = location[0], location[1:]
    new = _inside(value_at(data, (step,)), rest, value) if rest else value
    if isinstance(step, int):
        return [*data[:step], new, *data[step + 1 :]]
    return {**(data or {}), step: new}
