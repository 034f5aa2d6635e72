"""The forms in which the section and length of a belt can be given, and their conversion.

A belt is made of a material: density, Young's modulus, and the factors on axial and bending stiffness. What a user
knows are often the stiffnesses and the mass of a meter, or the name of a profile in the catalogue. Its length is that
of the line that carries the tension; what a user knows is the length by which it is sold.
"""

from collections.abc import Mapping
from math import pi
from pathlib import Path
from types import MappingProxyType
from typing import Any

from pydantic import Field

from beltdyn.errors import ModelError
from beltdyn.model.catalogue import Entry, find_entry, read_catalogue
from beltdyn.model.rating import with_initial_slope
from beltdyn.model.toothing import FEWEST_TEETH, LARGEST_PITCH_ERROR, MOST_TEETH, Toothing
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import AxialStiffness, BendingStiffness, Count, Length, MassPerLength, number_in
from beltdyn.stretch import LAWS

_POISSONS_RATIO = 0.3
"""Default Poisson's ratio of a belt, an assumption. Only the shear modulus of the section depends on it."""
MATERIAL = ("density", "youngs_modulus", "axial_factor", "bending_factor")
_FORCES = ("measuring_force", "largest_tension")
_BESIDE = dict.fromkeys(
    ("width", "axial_stiffness", "bending_stiffness", "mass_per_length", "contact_stiffness", *_FORCES), 1
)
_POWERS: dict[str, dict[str, int]] = {
    "ribs": _BESIDE,
    "width": _BESIDE,
    "diameter": {
        **dict.fromkeys(("width", "thickness", "pitch_offset", "back_offset", "smallest_diameter"), 1),
        **dict.fromkeys(("axial_stiffness", "mass_per_length", *_FORCES), 2),
        "bending_stiffness": 4,
    },
}
"""Exponents of the size in values of a profile, by the measure of the size; other values are constant."""

DAMPING_TIMES = ("stretch_damping_time", "bending_damping_time")
LOSS_FACTORS = ("stretch_loss_factor", "bending_loss_factor")
"""In the order of `DAMPING_TIMES`; each strain has one or the other."""
LOSSES = (*DAMPING_TIMES, *LOSS_FACTORS, "compression_loss_factor")

FATIGUE = ("cord_fatigue", "rib_fatigue")
_GROUPS = (*FATIGUE, "toothing")
_NUMBERS = (
    *("pitch_offset", "back_offset", "wedge_angle", "friction", *_FORCES, "smallest_diameter"),
    *("largest_fleeting_angle", "strength", "permanent_elongation", "thermal_expansion", *LOSSES),
)
TAKEN_OVER = (*_NUMBERS, *_GROUPS)


def stretch_keys() -> tuple[str, ...]:
    """The law of stretch, its curve, and the keys of the laws."""
    parameters = (parameter.name for law in LAWS.values() for parameter in law.parameters)
    return ("stretch_law", "stretch_curve", *parameters)


class Stiffnesses(Part):
    """The section of a belt by its stiffnesses."""

    width: Length = Field(gt=0, description="the width of the belt, out of the plane of the drive, in m")
    thickness: Length = Field(gt=0, description="the thickness of the belt, in the plane of the drive, in m")
    axial_stiffness: AxialStiffness = Field(gt=0, description="the axial stiffness E A of the belt, in N")
    bending_stiffness: BendingStiffness = Field(gt=0, description="the bending stiffness E I of the belt, in N*m^2")
    mass_per_length: MassPerLength = Field(gt=0, description="the mass per length of the belt, in kg/m")


class Sold(Part):
    """The section of a belt as sold."""

    profile: str = Field(description="the name of the belt's profile in the catalogue, as text")
    ribs: Count | None = Field(
        None,
        ge=1,
        le=1000,
        description="the number of ribs of the profile, or of V-belts side by side, by default one V-belt",
    )
    diameter: Length | None = Field(None, gt=0, description="the diameter of a round belt, in m")
    catalogue: str | None = Field(None, description="the path of your own catalogue, a TOML file, as text")


class SoldAs(Sold):
    """The profile and size of a belt whose values stand beside it, as result files have them."""

    given: tuple[str, ...] = Field((), description="the keys of the section that do not come from the profile")


class Origin(Part):
    """Where the section of a belt comes from."""

    sold: SoldAs = Field(
        description="the profile and size of a belt whose section is given by its values, for its rating"
    )


class Nominal(Part):
    """The length of a belt as sold."""

    nominal_length: Length = Field(
        gt=0,
        description="the nominal length of a closed belt as sold, under measuring_force, instead of length: datum "
        "length of a V-belt, effective length of a V-ribbed belt, inside length of any other, in m",
    )


OWN = [key for key in Stiffnesses.model_fields if key not in ("width", "thickness")]

FORMS = MappingProxyType(
    {
        **Sold.model_fields,
        **{key: Stiffnesses.model_fields[key] for key in OWN},
        **Nominal.model_fields,
        **Origin.model_fields,
    }
)
"""Keys of the other forms."""


def to_material(data: Any, base: Path | None) -> Any:
    """Convert a belt given by profile, stiffnesses or nominal length to material and length."""
    return _with_length(_by_material(data, base)) if isinstance(data, Mapping) else data


def _with_length(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Turn a nominal length, if there is one, into that of the line that carries the tension.

    That line lies outside the one of the nominal length by the pitch offset, all around. Both are lengths under the
    measuring force.
    """
    values = dict(data)
    nominal = values.pop("nominal_length", None)
    if nominal is None:
        return values | _length_of_teeth(values)
    if values.get("teeth") is not None:
        raise ValueError(
            "teeth and nominal_length exclude each other: a toothed belt is as long as its pitches. Omit it"
        )
    if values.get("length") is not None:
        raise ValueError("length and nominal_length exclude each other: one follows from the other. Keep one of them")
    length = Nominal.model_validate({"nominal_length": nominal}).nominal_length
    offset = _Offset.model_validate({key: data[key] for key in _Offset.model_fields if key in data}).pitch_offset
    return values | {"length": length + 2 * pi * offset}


def _length_of_teeth(values: Mapping[str, Any]) -> dict[str, float]:
    """The length of a belt with teeth, if no other is given: that of its pitches."""
    if values.get("teeth") is None or values.get("toothing") is None or values.get("length") is not None:
        return {}
    given = values["toothing"]
    try:
        toothing = given if isinstance(given, Toothing) else Toothing.model_validate(given)
        teeth = _Teeth.model_validate({"teeth": values["teeth"]}).teeth
    except ValueError:  # told where the belt is read
        return {}
    return {"length": teeth * toothing.pitch}


class _Teeth(Part):
    teeth: Count = Field(ge=FEWEST_TEETH, le=MOST_TEETH)


class _Offset(Part):
    pitch_offset: Length = Field(0.0, ge=0)


def _by_material(data: Mapping[str, Any], base: Path | None) -> Mapping[str, Any]:
    """Turn a profile or stiffnesses into material."""
    given = [key for key in (*Sold.model_fields, *OWN) if key in data]
    law = {"stretch_law": "measured"} if "stretch_curve" in data else {"stretch_law": "linear"} if given else {}
    if not given:
        return {**law, **data}
    both = [key for key in MATERIAL if key in data]
    if both:
        raise ValueError(
            f"{given[0]} and {both[0]} exclude each other: a belt is given by a profile, or by stiffnesses and mass "
            "per length, or by its material. Keep one of the forms"
        )
    values: dict[str, Any] = {**law, **data}
    if any(key in data for key in Sold.model_fields):
        sold = Sold.model_validate({key: values.pop(key) for key in Sold.model_fields if key in values})
        section = _section(sold, data.get("width"), base)
        for pair in zip(DAMPING_TIMES, LOSS_FACTORS, strict=True):
            if any(key in values for key in pair):
                section = {key: value for key, value in section.items() if key not in pair}
        if any(key in data for key in (*stretch_keys(), "axial_stiffness")):
            section.pop("stretch_curve", None)
        elif "stretch_curve" in section:
            values["stretch_law"] = "measured"
        if "toothing" in section and isinstance(values.get("toothing"), Mapping):
            values["toothing"] = section["toothing"].arguments | values["toothing"]
            _has_pitch_of(sold.profile, section["toothing"].pitch, values["toothing"]["pitch"])
        values = section | values
    if "stretch_curve" in data:
        values |= {key: with_initial_slope(data, base)[key] for key in ("stretch_curve", "axial_stiffness")}
    given_section = {key: values.pop(key) for key in Stiffnesses.model_fields if key in values}
    return {"poissons_ratio": _POISSONS_RATIO} | values | _material(Stiffnesses.model_validate(given_section))


def _has_pitch_of(profile: str, pitch: float, given: Any) -> None:
    """Refuse another pitch than that of the profile (m), whose sizes and ratings would not be those of the teeth."""
    try:
        own = number_in("toothing.pitch", given, "m")
    except (ModelError, TypeError):
        return  # told with the other values of the teeth
    if abs(own / pitch - 1.0) > LARGEST_PITCH_ERROR:
        raise ValueError(
            f'toothing.pitch = {1e3 * own:.5g} mm, but profile "{profile}" has a pitch of {1e3 * pitch:.5g} mm. Omit '
            "it, or choose a profile of that pitch"
        )


def in_new_form(arguments: Mapping[str, Any], changes: Mapping[str, Any], own: Mapping[str, float]) -> dict[str, Any]:
    """Reduce the arguments of a changed belt to one form, that of the changes."""
    gone: set[str] = set()
    if any(key in changes for key in Sold.model_fields):
        gone = {*MATERIAL, "width", "thickness", "poissons_ratio", "contact_stiffness", *TAKEN_OVER, *stretch_keys()}
        own = {}
    elif any(key in changes for key in OWN):
        gone = {*MATERIAL}
    else:
        own = {}
    if "stretch_curve" in changes:
        gone |= {"stretch_law", "axial_factor"}
    elif "stretch_law" in changes:
        gone |= {"stretch_curve"}
    elif "stretch_curve" in arguments and "axial_stiffness" in changes:
        gone |= {*stretch_keys()}
    kept = {key: value for key, value in arguments.items() if key in changes or key not in gone}
    without = {"axial_stiffness"} if "stretch_curve" in kept else set()
    return {key: value for key, value in own.items() if key not in without} | kept


def _material(section: Stiffnesses) -> dict[str, float]:
    """Give the material of a rectangle that has the stiffnesses and the mass."""
    area = section.width * section.thickness
    modulus = section.axial_stiffness / area
    return {
        "width": section.width,
        "thickness": section.thickness,
        "density": section.mass_per_length / area,
        "youngs_modulus": modulus,
        "bending_factor": section.bending_stiffness / (modulus * area * section.thickness**2 / 12),
    }


def _section(sold: Sold, width: object, base: Path | None) -> dict[str, Any]:
    """Look up a profile, and give the keys of a belt of its size."""
    try:
        entry = find_entry(read_catalogue(sold.catalogue, base), sold.profile)
    except LookupError as error:
        raise ValueError(f'{error.args[0]}. Or extend the catalogue with your own: catalogue = "file.toml"') from None
    size, powers = _size(sold, entry, width), _POWERS[entry.sold_by]
    values = {key: getattr(entry, key) for key in (*Stiffnesses.model_fields, "contact_stiffness", *_NUMBERS)}
    found = {key: value * size ** powers.get(key, 0) for key, value in values.items() if value is not None}
    curves = {key: getattr(entry, key) for key in ("stretch_curve", *_GROUPS)}
    strength = size ** powers["axial_stiffness"]
    return found | {key: curve.times(strength) for key, curve in curves.items() if curve is not None}


def _size(sold: Sold, entry: Entry, width: object) -> float:
    """How many times the entry's own size a belt is."""
    given = {"ribs": sold.ribs, "width": width, "diameter": sold.diameter}
    for key in ("ribs", "diameter"):
        if given[key] is not None and key != entry.sold_by:
            raise ValueError(
                f'{key} = {given[key]:g} is incompatible with profile "{sold.profile}", which is sold by '
                f"{entry.sold_by}. Give {entry.sold_by} instead"
            )
    if given[entry.sold_by] is None:
        if entry.is_v_belt:
            return 1
        each = f", each {1e3 * entry.width:.3g} mm wide" if entry.sold_by == "ribs" else ""
        raise ValueError(
            f'{entry.sold_by} is missing: profile "{sold.profile}" is sold by {entry.sold_by}{each}. '
            f"Give {'their number' if each else 'it'}"
        )
    if sold.ribs is not None:
        return sold.ribs
    return _Width.model_validate({"width": given[entry.sold_by]}).width / entry.width


class _Width(Part):
    width: Length = Field(gt=0)


def describe_forms(schema: dict[str, Any]) -> None:
    """Add the keys of the other forms, which are converted to the material on reading, to the JSON schema."""
    forms = (Sold.model_json_schema(), Stiffnesses.model_json_schema(), Nominal.model_json_schema())
    origin = SoldAs.model_json_schema() | {"description": Origin.model_fields["sold"].description}
    for form in forms:
        schema["properties"] = form["properties"] | schema["properties"]
    schema["properties"]["sold"] = origin
    required = schema.pop("required")
    material = [key for key in required if key in (*MATERIAL, "width", "thickness", "poissons_ratio")]
    schema["required"] = [key for key in required if key not in material]
    schema["anyOf"] = [{"required": keys} for keys in (material, forms[1]["required"], ["profile"])]


# The profile and size of a belt as sold, kept so that its size can be changed in the same form

SIZES = ("ribs", "diameter", "width")
"""Measures by which belts are sold."""

_SECTION = (*MATERIAL, *OWN, "width", "thickness", "contact_stiffness", *TAKEN_OVER)
"""Values of a profile, or their replacements, beside those of its stretch law."""


def as_sold(data: Any, belt: Any, base: Path | None) -> dict[str, Any] | None:
    """The section of a belt as given, instead of its material."""
    if not isinstance(data, Mapping):
        return None
    if data.get("sold") is not None:
        if data.get("profile") is not None:
            raise ValueError("profile and sold exclude each other: sold stands beside values. Keep one of them")
        return _section_of(Origin.model_validate({"sold": data["sold"]}).sold, belt)
    if data.get("profile") is None:
        return None
    given = {key: value for key, value in data.items() if value is not None}
    sold = Sold.model_validate({key: given[key] for key in Sold.model_fields if key in given}).arguments
    if sold.get("catalogue") is not None:
        sold["catalogue"] = str(((base or Path()) / sold["catalogue"]).resolve())
    return sold | {key: getattr(belt, key) for key in (*_SECTION, *stretch_keys()) if key in given}


def _section_of(sold: SoldAs, belt: Any) -> dict[str, Any]:
    """The section of a belt with values, and the profile from which they came."""
    other = sorted(set(sold.given) - {*_SECTION, *stretch_keys()})
    if other:
        raise ValueError(f'sold.given has "{other[0]}", which is no key of a section. Omit it')
    of_profile = {key: value for key, value in sold.arguments.items() if key in Sold.model_fields}
    return of_profile | {key: getattr(belt, key) for key in sold.given}


def written_as_sold(section: Mapping[str, Any]) -> dict[str, Any]:
    """The profile and size of a belt, and the keys that do not come from it, to be written beside all values."""
    given = [key for key in section if key not in Sold.model_fields]
    return {key: section[key] for key in section if key not in given} | ({"given": given} if given else {})


def changes_as_sold(section: Mapping[str, Any], changes: Mapping[str, Any]) -> bool:
    """Whether a changed belt is still one of its profile, and the catalogue still exists."""
    if any(key in changes for key in MATERIAL):
        return False
    return section.get("catalogue") is None or Path(section["catalogue"]).is_file()


def section_with(section: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """What is given of a belt's section after changes, the changes themselves left out."""
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
    return {key: value for key, value in arguments.items() if key not in (*_SECTION, *stretch_keys())}
