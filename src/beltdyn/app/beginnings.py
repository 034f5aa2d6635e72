"""Numbers that a new item of a form begins with: those of the documented example of its kind."""

import ast
import re
from collections.abc import Mapping
from typing import Any

from beltdyn.app.forms import Field, fields, schema_of
from beltdyn.model import Drive
from beltdyn.parts.toml_edits import Location

_EXAMPLE = re.compile(r"^(?:>>>|\.\.\.) (.*)$", re.MULTILINE)
_OF_UNITS = {"rad/s": "1500 rpm", "N*m": "5 N m", "N": "100 N", "Pa": "5 MPa", "W": "1 kW", "": 1.0}
"""What profiles rise to, by their unit."""
_OPPOSING = "-5 N m"
"""Torque on a pulley that turns counter-clockwise."""
_TIMES = {"start": 0.02, "end": 0.2, "time": 0.1, "times": [0.0, 0.2]}


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
        if one.key not in found and (one.required or one.key in ("times", "values", "angles")):
            value = _usual(one, data, drive)
            if value is not None:
                found[one.key] = value
    return given | found


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
        return _TIMES[one.key]
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
        pulley = drive.pulleys[int(one.location[1])]
        return level if drive.running_sense * pulley.turning * drive.positive_sense < 0 else _OPPOSING
    return level
