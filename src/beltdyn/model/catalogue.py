"""The catalogue of belts as sold, by profile."""

import re
from collections.abc import Mapping
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from math import pi
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import Field, ValidationError, ValidationInfo, model_validator

from beltdyn.model.conveyor_class import class_values, listed_classes
from beltdyn.model.rating import CordFatigue, Rating, RibFatigue, StretchCurve, with_initial_slope
from beltdyn.model.toothing import Toothing, ToothRating
from beltdyn.parts.messages import explain, reason
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import (
    Angle,
    AxialStiffness,
    BendingStiffness,
    Count,
    Force,
    Length,
    LineStiffness,
    MassPerLength,
    Ratio,
    Stiffness,
    ThermalExpansion,
    Time,
)
from beltdyn.parts.text_file import LONGEST_TOML, parse_toml, read_text, shorten
from beltdyn.stretch import Linear


class Entry(Part):
    """A profile of the catalogue, for one rib or for a certain width or diameter.

    A profile sold by ribs gives the values of one rib or one V-belt, and one sold by width those of a belt that is
    `width` wide. A belt of n ribs, or n times as wide, has n times the stiffnesses (that of contact too) and the mass.
    A profile sold by diameter is a round belt; its `width` and `thickness` are the diameter. A belt n times as thick
    has n² times the axial stiffness and the mass, n⁴ times the bending stiffness, and the same contact stiffness.

    Examples
    --------
    >>> entry = bd.read_catalogue()["PK"]
    >>> entry.title, entry.axial_stiffness  # of a rib, N
    ('V-ribbed belt PK, polyester cord', 20000.0)
    """

    title: str = Field(description="the name of the profile in words, as text")
    kind: str = Field("Other belts", description="the kind of belt, for grouping in lists, as text")
    sold_by: Literal["ribs", "width", "diameter"] = Field(
        "ribs", description="the measure of size: ribs, width or diameter"
    )
    width: Length = Field(gt=0, description="the width of a rib, or of the belt to which the values apply, in m")
    thickness: Length = Field(gt=0, description="the thickness of the belt, in m")
    axial_stiffness: AxialStiffness = Field(gt=0, description="the axial stiffness E A, in N")
    stretch_curve: StretchCurve | None = Field(
        None, description="the measured curve of tension over strain, instead of the axial stiffness"
    )
    bending_stiffness: BendingStiffness = Field(gt=0, description="the bending stiffness E I, in N*m^2")
    mass_per_length: MassPerLength = Field(gt=0, description="the mass per length, in kg/m")
    pitch_offset: Length = Field(
        0.0, ge=0, description="the distance from the inside surface to the tension line, in m"
    )
    back_offset: Length = Field(0.0, ge=0, description="the distance from the back surface to the tension line, in m")
    wedge_angle: Angle | None = Field(None, gt=0, le=pi, description="the angle between the flanks, in rad")
    friction: Ratio | None = Field(
        None, ge=0, description="the coefficient of friction on the usual pulley, without the wedge effect"
    )
    contact_stiffness: LineStiffness | None = Field(
        None,
        gt=0,
        description="the normal force per meter of belt and meter of compression, in N/m^2",
    )
    stretch_damping_time: Time = Field(0.0, ge=0, description="the damping time of stretch, in s")
    bending_damping_time: Time = Field(0.0, ge=0, description="the damping time of bending, in s")
    stretch_loss_factor: Ratio = Field(0.0, ge=0, le=1, description="the loss factor (tan delta) of stretch")
    bending_loss_factor: Ratio = Field(0.0, ge=0, le=1, description="the loss factor (tan delta) of bending")
    compression_loss_factor: Ratio = Field(0.0, ge=0, le=2, description="the loss factor of compression in grooves")
    measuring_force: Force | None = Field(
        None,
        ge=0,
        description="the total force of both strands on two equal pulleys while the nominal length is measured, in N",
    )
    largest_tension: Force | None = Field(None, gt=0, description="the rated tension, in N")
    strength: Stiffness | None = Field(
        None, gt=0, description="the nominal strength of a conveyor belt per width, in N/m"
    )
    permanent_elongation: Ratio | None = Field(
        None, ge=0, lt=0.1, description="the permanent elongation of a conveyor belt over its life"
    )
    thermal_expansion: ThermalExpansion | None = Field(
        None, ge=0, description="the coefficient of thermal expansion along a conveyor belt, in 1/K"
    )
    least_safety: Ratio | None = Field(
        None, gt=0, description="the least safety factor of a conveyor belt in steady running: strength over tension"
    )
    least_motion_safety: Ratio | None = Field(
        None, gt=0, description="the least safety factor of a conveyor belt in starts and stops"
    )
    pulley_diameter: Literal["datum", "effective", "outside"] = Field(
        "outside", description="the diameter that is twice the radius of a pulley: datum, effective or outside"
    )
    groove_height: Length = Field(
        0.0,
        ge=0,
        description="the height of the groove above the datum line, half of outside less datum diameter, in m",
    )
    groove_spacing: Length | None = Field(
        None, gt=0, description="the distance between the middles of two grooves of a pulley, in m"
    )
    groove_edge: Length | None = Field(
        None, gt=0, description="the distance from the middle of the last groove to the side of the pulley, in m"
    )
    smallest_diameter: Length | None = Field(None, gt=0, description="the smallest recommended pulley diameter, in m")
    largest_fleeting_angle: Angle | None = Field(
        None, gt=0, lt=pi / 2, description="the largest fleeting angle of a span at a pulley, in rad"
    )
    toothing: Toothing | None = Field(None, description="the teeth of a toothed belt")
    cord_fatigue: CordFatigue | None = Field(None, description="the S-N line of the cords")
    rib_fatigue: RibFatigue | None = Field(None, description="the law of rib fatigue")
    lengths: tuple[Length, ...] = Field((), description="the standard nominal lengths, in m")
    tooth_counts: tuple[Count, ...] = Field((), description="the standard numbers of teeth of a toothed belt")
    rating: Rating | None = Field(
        None, description="the power rating of a rib or V-belt, by the small pulley and speed"
    )
    tooth_rating: ToothRating | None = Field(
        None, description="the rating of a toothed belt, by its teeth in mesh and the pulley speed"
    )
    generic: bool = Field(False, description="whether the values are typical of a profile, not of a product")
    source: str = Field(min_length=1, description="the source of the values, as text")

    @property
    def is_v_belt(self) -> bool:
        """Whether it is a V-belt, several of which lie side by side."""
        return self.pulley_diameter == "datum"

    @property
    def piece(self) -> str:
        """What a profile that is sold by ribs is counted in: "belt" or "rib"."""
        return "belt" if self.is_v_belt else "rib"

    def face_width(self, grooves: int) -> float | None:
        """Face width of a pulley with so many grooves, (z - 1) e + 2 f, m; None where the grooves are unknown."""
        if self.groove_spacing is None or self.groove_edge is None:
            return None
        return (grooves - 1) * self.groove_spacing + 2.0 * self.groove_edge

    @property
    def measured_stretch(self) -> float:
        """Stretch of the belt while its nominal length is measured, with half of the force in each strand."""
        curve = self.stretch_curve
        law = Linear(self.axial_stiffness) if curve is None else curve.parameters
        return float(law.stretch(0.5 * (self.measuring_force or 0.0)))

    @model_validator(mode="after")
    def _is_as_long_as_its_teeth(self) -> Self:
        if self.tooth_counts:
            if self.toothing is None:
                raise ValueError("tooth_counts need the pitch of the teeth. Give a group toothing, or give lengths")
            object.__setattr__(self, "lengths", tuple(one * self.toothing.pitch for one in self.tooth_counts))
        if self.tooth_rating is not None and (self.toothing is None or not self.toothing.largest_tooth_load):
            raise ValueError("tooth_rating needs toothing.largest_tooth_load. Give it, or omit tooth_rating")
        return self

    @model_validator(mode="after")
    def _has_both_sizes_of_grooves(self) -> Self:
        if (self.groove_spacing is None) != (self.groove_edge is None):
            raise ValueError("groove_spacing and groove_edge give the face width together. Give both, or none")
        return self

    @model_validator(mode="before")
    @classmethod
    def _stretches_by_one_law(cls, data: Any, info: ValidationInfo) -> Any:
        return with_initial_slope(data, (info.context or {}).get("base"))


def read_catalogue(name: object = None, base: Path | None = None) -> dict[str, Entry]:
    """Read the catalogue of the package, extended by that of a user.

    Parameters
    ----------
    name : object, optional
        Path of the user's file, as the user wrote it: a TOML table for each profile, whose keys are those of `Entry`.
    base : Path, optional
        Folder that a relative path starts from; by default the working directory.

    Returns
    -------
    dict
        Entries by the name of their profile.

    Raises
    ------
    ValueError
        If the file cannot be read, or is not a catalogue.

    Examples
    --------
    >>> bd.read_catalogue()["PK"].sold_by
    'ribs'
    """
    if name is None:
        return dict(_shipped())
    if not isinstance(name, str | Path):
        raise ValueError(f"catalogue = {shorten(name)!r} must be the path of a TOML file, as text")
    try:
        text = read_text((base or Path()) / name, LONGEST_TOML)
    except UnicodeDecodeError as error:
        raise ValueError(f'catalogue = "{shorten(name)}" is not UTF-8 text. A catalogue is a TOML file') from error
    except (OSError, ValueError) as error:
        raise ValueError(
            f'catalogue = "{shorten(name)}" cannot be read: {reason(error)}. Relative paths start at the folder of '
            "the drive file"
        ) from error
    return _shipped() | _entries(text, str(name), base)


def find_entry(catalogue: Mapping[str, Entry], profile: str) -> Entry:
    """Look up a profile, by its name or as a class of conveyor belts such as "EP 400/3"."""
    entry = catalogue.get(profile)
    if entry is None and (values := class_values(profile)) is not None:
        entry = Entry.model_validate(values)
    if entry is None:
        if other := _OTHER_DRIVES.get(_section(profile)):
            raise LookupError(f'profile = "{shorten(profile)}" is not in the catalogue. {other}')
        like = get_close_matches(profile.lower(), [name.lower() for name in catalogue], n=10, cutoff=0.5)
        like = sorted(like, key=lambda name: name[0] != profile[:1].lower())[:4]
        near = [name for name in catalogue if name.lower() in like]
        known = f"Similar names: {', '.join(near)}" if near else f"Choose one of {', '.join(catalogue)}"
        raise LookupError(f'profile = "{shorten(profile)}" is not in the catalogue. {known}')
    return entry


_TOOTHED = (
    "Toothed belts are in it by these names: MXL, XL, L, H, XH, T2.5, T5, T10, AT5, AT10, HTD 3M, HTD 5M, HTD 8M, HTD "
    "14M, STD 3M to 14M, GT 2M to 8M; width is given apart. For others give [belt.toothing]"
)
_CHAIN = (
    'Chains are not in it. Mass, stretch and links of a chain are those of a belt with discretization = "truss"; the '
    "meshing of rollers and teeth is not modeled"
)
_ROPE = (
    "Ropes are not in it. A rope on pulleys is a belt with the axial_stiffness, bending_stiffness and mass_per_length "
    "that its maker states; friction between wires is not modeled"
)
_OTHER_DRIVES = {
    **dict.fromkeys(("htd", "gt", "std", "at", "t", "mxl", "xl", "l", "h", "xh", "xxh"), _TOOTHED),
    **dict.fromkeys(("timing", "toothed", "synchronous", "zahnriemen", "rpp", "polychain"), _TOOTHED),
    **dict.fromkeys(("chain", "roller", "kette"), _CHAIN),
    **dict.fromkeys(("rope", "wire", "cable", "seil"), _ROPE),
}
"""What is and is not there for belts and other drives that are not in the catalogue, by the words of their names."""


def _section(profile: str) -> str:
    """A name without sizes, such as that of "HTD 5M-15" or "8MGT"."""
    words = re.sub(r"[\d.]+m?", " ", profile.lower().replace("_", " ").replace("-", " ")).split()
    return words[0] if words else ""


@cache
def _shipped() -> dict[str, Entry]:
    resource = files("beltdyn.model").joinpath("catalogue.toml")
    classes = {name: Entry.model_validate(values) for name, values in listed_classes()}
    return _entries(resource.read_text(encoding="utf-8"), resource.name) | classes


def _entries(text: str, name: str, base: Path | None = None) -> dict[str, Entry]:
    try:
        tables = parse_toml(text)
    except ValueError as error:
        raise ValueError(
            f'catalogue = "{shorten(name)}" is not valid TOML: {shorten(error, 200)}. Correct the file'
        ) from error
    return {profile: _entry(profile, table, name, base) for profile, table in tables.items()}


def _entry(profile: str, table: object, name: str, base: Path | None) -> Entry:
    file, profile = f'catalogue = "{shorten(name)}"', shorten(profile)
    if not isinstance(table, Mapping):
        raise ValueError(f"{file}: {profile} must be a group of keys, such as [{profile}]. Correct it")
    try:
        return Entry.model_validate(table, context={"base": base})
    except ValidationError as error:
        told = explain(error, Entry, table).splitlines()
        raise ValueError("\n".join(f"{file}, profile {profile}: {line}" for line in told)) from None
