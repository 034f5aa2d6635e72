"""The profile and size of a belt as sold, kept so that its size can be changed in the same form."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from beltdyn.model.belt_form import DAMPING_TIMES, LOSS_FACTORS, MATERIAL, OWN, STRETCH, TAKEN_OVER, Sold

SIZES = ("ribs", "diameter", "width")
"""Measures by which belts are sold."""

_SECTION = (*MATERIAL, *OWN, "width", "thickness", "contact_stiffness", *TAKEN_OVER, *STRETCH)
"""Values of a profile, or their replacements."""


def as_sold(data: Any, belt: Any, base: Path | None) -> dict[str, Any] | None:
    """The section of a belt as given, instead of its material.

    Parameters
    ----------
    data
        The keys of the belt as the user gave them.
    belt
        The belt that was made of them.
    base
        Folder that the path of a catalogue starts from; None for the working directory.

    Returns
    -------
    dict or None
        Profile, size and what was given beside them, with values of the belt; None of a belt without profile.
    """
    if not isinstance(data, Mapping) or data.get("profile") is None:
        return None
    given = {key: value for key, value in data.items() if value is not None}
    sold = Sold.model_validate({key: given[key] for key in Sold.model_fields if key in given}).arguments
    if sold.get("catalogue") is not None:
        sold["catalogue"] = str(((base or Path()) / sold["catalogue"]).resolve())
    return sold | {key: getattr(belt, key) for key in _SECTION if key in given}


def changes_as_sold(section: Mapping[str, Any], changes: Mapping[str, Any]) -> bool:
    """Whether a changed belt is still one of its profile, and the catalogue still exists."""
    if any(key in changes for key in MATERIAL):
        return False
    return section.get("catalogue") is None or Path(section["catalogue"]).is_file()


def section_with(section: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """What is given of a belt's section after changes, the changes themselves left out.

    Parameters
    ----------
    section
        As from `as_sold`.
    changes
        Keys of a belt -> new value.

    Returns
    -------
    dict
        Another profile keeps the size alone, and not even that where a size is changed with it. A curve of stretch
        takes the place of the axial stiffness, a law of stretch that of a curve, and a loss that of the same strain.
    """
    gone = set[str]()
    if "profile" in changes:
        resized = any(key in changes for key in SIZES)
        size = next((key for key in SIZES if key in section), "ribs")
        gone = {key for key in section if key not in Sold.model_fields and key != size}
        gone |= {size} if resized else set()
    if "stretch_curve" in changes:
        gone |= {"axial_stiffness", "stretch_law"}
    if "stretch_law" in changes or "axial_stiffness" in changes:
        gone |= {"stretch_curve", *({"stretch_law"} if "stretch_curve" in section else ())}
    for pair in zip(DAMPING_TIMES, LOSS_FACTORS, strict=True):
        if any(key in changes for key in pair):
            gone.update(pair)
    return {key: value for key, value in section.items() if key not in gone and key not in changes}


def without_section(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """Arguments of a belt without those of a profile."""
    return {key: value for key, value in arguments.items() if key not in _SECTION}
