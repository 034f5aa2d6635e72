"""Values that hold where a drive file leaves a key open: of the profile, chosen by the program, or solved for."""

from collections.abc import Mapping
from typing import Any

from beltdyn.app.forms import pulley_at
from beltdyn.errors import ModelError
from beltdyn.model import Drive, estimate_at_rest, prepare
from beltdyn.model.pulley import flat_friction_on
from beltdyn.parts.part import Part
from beltdyn.parts.toml_edits import Location


def in_use(drive: Drive | None, data: Mapping[str, Any], location: Location) -> Any:
    """The value of a drive at a place of its file; None where there is none."""
    if drive is None or len(location) < 2:
        return None
    try:
        if location == ("belt", "installed_tension"):
            return float(estimate_at_rest(prepare(drive))[1].tension)
        if location == ("contact", "friction"):
            return drive.belt.friction
        part, steps = _part(drive, data, location)
        if location[0] == "pulley" and steps == ("friction",):
            return flat_friction_on(part, drive.belt, drive.contact)
        for step in steps:
            part = part[step] if isinstance(step, int) else part.value_of(step) if isinstance(part, Part) else None
    except (LookupError, ModelError, TypeError, ValueError):
        return None
    return part


def _part(drive: Drive, data: Mapping[str, Any], location: Location) -> tuple[Any, Location]:
    """A part of the completed drive, and the rest of a location in it."""
    completed, group = drive.completed, location[0]
    if group == "pulley":
        return completed.pulleys[pulley_at(drive, data, location)], location[2:]
    if group == "tensioner":
        return completed.tensioners[int(location[1])], location[2:]
    if group == "simulation":
        return drive.simulation.replace(frame=drive.frame.name), location[1:]
    if group in ("belt", "contact"):
        return getattr(completed, str(group)), location[1:]
    return drive.value_of(str(group)), location[1:]
