"""The belt: a closed loop of rectangular section."""

from collections.abc import Mapping
from functools import cached_property
from math import pi, sin, sqrt
from types import MappingProxyType
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import (
    BeforeValidator,
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    PrivateAttr,
    SerializerFunctionWrapHandler,
    ValidationInfo,
    model_serializer,
    model_validator,
)
from pydantic.fields import FieldInfo

from beltdyn.arrays import FloatArray
from beltdyn.elements import ANCF, ELEMENTS, QUINTIC, ElementKind
from beltdyn.errors import ModelError
from beltdyn.model.belt_form import (
    DAMPING_TIMES,
    FORMS,
    LOSS_FACTORS,
    OWN,
    Nominal,
    as_sold,
    changes_as_sold,
    describe_forms,
    in_new_form,
    section_with,
    to_material,
    without_section,
    written_as_sold,
)
from beltdyn.model.catalogue import Entry, find_entry, read_catalogue
from beltdyn.model.friction_state import Friction
from beltdyn.model.rating import CordFatigue, RatedBelt, RibFatigue, StretchCurve
from beltdyn.model.toothing import DISCRETE, FEWEST_TEETH, MOST_OFF, MOST_TEETH, RatedTeeth, Toothing
from beltdyn.parts.kind_fields import LawKeys, NameOf
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import (
    Angle,
    Count,
    Density,
    Flag,
    Force,
    Length,
    LineStiffness,
    Ratio,
    Stiffness,
    Stress,
    Temperature,
    ThermalExpansion,
    Time,
)
from beltdyn.stretch import LAWS, StretchParameters

_ELEMENTS = ", ".join(f'"{kind.name}" ({kind.meaning})' for kind in ELEMENTS.values())
_LAWS = ", ".join(f'"{law.name}" ({law.meaning})' for law in LAWS.values())
_NORMAL_SECTIONS = 20.0
"""Shear stiffness S over EA that keeps sections normal: slip on small pulleys errs by about (T / S) EI / EA R^2."""

_SIDES = MappingProxyType(dict.fromkeys(("back", "backside", "flat", "smooth"), "outside")) | dict.fromkeys(
    ("front", "ribs", "ribbed", "grooves", "grooved"), "inside"
)


def read_side(given: Any) -> Any:
    """The name of a side in a drive file for a synonym."""
    return _SIDES.get(given.strip().lower(), given) if isinstance(given, str) else given


Side = Annotated[
    Literal["inside", "outside"], BeforeValidator(read_side, json_schema_input_type=Literal["inside", "outside"])
]
"""The side of the belt that touches a pulley; the outside is the back of the belt."""


class Belt(Part):
    """A belt of rectangular cross-section; closed, unless the drive has ends.

    The width points out of the plane of the drive, the thickness lies in it. Arguments are in SI units,
    or text such as ``"25 mm"``. With `installed_tension` instead of `length`, the length is None and computed by the
    drive (`Drive.belt_length`); likewise `elements` (`Drive.elements`).

    `density`, `youngs_modulus` and their factors may be replaced by `axial_stiffness` (N), `bending_stiffness` (N m^2)
    and `mass_per_length` (kg/m), or by a `profile` of the catalogue and its number of `ribs`; density, modulus and
    factors are computed from these. `length`, the length of the tension line, may be replaced by the `nominal_length`
    as sold, measured on two pulleys pulled apart by `measuring_force`.

    The default of `stretch_law` is ``"linear"`` for belts specified by stiffnesses or profile, ``"measured"`` with a
    `stretch_curve`, and ``"green"``, as published, for belts specified by their material.

    Examples
    --------
    >>> belt = bd.Belt(profile="PJ", ribs=6, installed_tension="300 N")
    >>> round(belt.mass_per_length, 4), belt.installed_tension
    (0.054, 300.0)
    """

    model_config = ConfigDict(json_schema_extra=lambda schema: describe_forms(schema))
    either = ("length", "installed_tension")
    in_place_of = MappingProxyType({"nominal_length": "length"})

    length: Length | None = Field(
        None,
        gt=0,
        description="the unstretched length of the belt; without it and `installed_tension` that which sets the first "
        "spring-loaded tensioner to its nominal position, or gives a belt of a rated profile the tension that its "
        "loads require, in m",
    )
    installed_tension: Force | None = Field(
        None, gt=0, description="the tension of the belt at rest in the drive, instead of its length, in N"
    )
    teeth: Count | None = Field(
        None,
        ge=FEWEST_TEETH,
        le=MOST_TEETH,
        description="the number of teeth of a toothed belt, which is as long as so many pitches, under measuring_force "
        "if that is given",
    )
    toothing: Toothing | None = Field(
        None, description="the teeth of a toothed belt, a group [belt.toothing]; a profile may have one"
    )
    width: Length = Field(gt=0, description="the width of the belt, out of the plane of the drive, in m")
    thickness: Length = Field(gt=0, description="the thickness of the belt, in the plane of the drive, in m")
    density: Density = Field(gt=0, description="the density of the belt, in kg/m^3")
    youngs_modulus: Stress = Field(gt=0, description="Young's modulus of the belt, in Pa")
    poissons_ratio: Ratio = Field(gt=-1, lt=0.5, description="Poisson's ratio of the belt")
    pitch_offset: Length = Field(
        0.0, ge=0, description="the distance from the inside surface to the tension line, in m"
    )
    back_offset: Length = Field(0.0, ge=0, description="the distance from the back to the tension line, in m")
    measuring_force: Force | None = Field(
        None,
        ge=0,
        description="the total force of both strands on two equal pulleys while nominal_length is measured, in N; by "
        "default nominal_length is unstretched",
    )
    largest_tension: Force | None = Field(
        None,
        gt=0,
        description="the rated tension of the belt, all ribs together, above which `check` warns, in N",
    )
    strength: Stiffness | None = Field(
        None,
        gt=0,
        description='the nominal strength of a conveyor belt per width, such as "1000 N/mm", for its safety factors, '
        "in N/m",
    )
    permanent_elongation: Ratio | None = Field(
        None,
        ge=0,
        lt=0.1,
        description="the permanent elongation over the life of the belt, for the travel of a take-up",
    )
    thermal_expansion: ThermalExpansion | None = Field(
        None, ge=0, description="the coefficient of thermal expansion along the belt, in 1/K"
    )
    temperature_range: tuple[Temperature, Temperature] | None = Field(
        None,
        description="the lowest and the highest temperature of the belt, for the travel of a take-up, in °C; by "
        "default -10 and 40 °C",
    )
    smallest_diameter: Length | None = Field(
        None, gt=0, description="the smallest recommended pulley diameter, as pulleys are sold, in m"
    )
    largest_fleeting_angle: Angle | None = Field(
        None, gt=0, lt=pi / 2, description="the largest fleeting angle of a span at a pulley, in rad"
    )
    temperature: Temperature | None = Field(
        None,
        gt=-274,
        description="the temperature of the belt, in °C; by default that of the reference condition of rib_fatigue",
    )
    cord_fatigue: CordFatigue | None = Field(
        None, description="the S-N line of the cords, a group [belt.cord_fatigue]; a profile may have one"
    )
    rib_fatigue: RibFatigue | None = Field(
        None, description="the law of rib fatigue, a group [belt.rib_fatigue]; a profile may have one"
    )
    crossed: Flag = Field(False, description="whether spans of the belt cross")
    wedge_angle: Angle | None = Field(
        None,
        gt=0,
        le=pi,
        description="the angle between the flanks of a V-belt or of ribs, in rad; not given for a flat belt",
    )
    friction: Friction | None = Field(
        None,
        ge=0,
        description="the coefficient of friction of the belt, without the wedge effect, unless contact gives one",
    )
    contact_stiffness: LineStiffness | None = Field(
        None,
        gt=0,
        description="the normal force per meter of belt and meter of compression, if known, in N/m^2",
    )
    stretch_law: Annotated[str, NameOf(LAWS)] = Field("green", description=f"the law of tension over stretch: {_LAWS}")
    stretch_curve: StretchCurve | None = Field(
        None, description="the measured curve of tension over strain, instead of the axial stiffness"
    )
    stretch_damping_time: Time = Field(
        0.0, ge=0, description="the damping time of stretch, a factor on the strain rate, in s"
    )
    bending_damping_time: Time = Field(
        0.0, ge=0, description="the damping time of bending, a factor on the curvature rate, in s"
    )
    stretch_loss_factor: Ratio = Field(
        0.0,
        ge=0,
        le=1,
        description="the loss factor (tan delta) of stretch: hysteresis independent of speed, "
        "instead of stretch_damping_time",
    )
    bending_loss_factor: Ratio = Field(
        0.0,
        ge=0,
        le=1,
        description="the loss factor (tan delta) of bending: hysteresis independent of speed, "
        "instead of bending_damping_time",
    )
    compression_loss_factor: Ratio = Field(
        0.0,
        ge=0,
        le=2,
        description="the loss factor of compression by the pulleys; needs contact_stiffness",
    )
    compression_set: Ratio = Field(
        0.0,
        ge=0,
        le=0.4,
        description="the part of the largest compression in a nip that stays behind it, in steady running",
    )
    axial_factor: Ratio = Field(1.0, gt=0, description="the factor α₁ on the axial stiffness")
    bending_factor: Ratio = Field(1.0, gt=0, description="the factor α₂ on the bending and shear stiffness")
    shear_correction: Ratio | None = Field(
        None,
        gt=0,
        description="the shear correction factor on a travelling mesh; by default sections stay normal to the "
        "centerline, as on a staying mesh",
    )
    elements: Count | None = Field(
        None, ge=3, le=10_000, description="the number of belt elements; the least one of meshes that are refined"
    )
    discretization: Annotated[str, NameOf(ELEMENTS)] | None = Field(
        None,
        description=f"the kind of elements: {_ELEMENTS}; by default quintic on a staying mesh and with teeth, ancf "
        "on a travelling mesh without",
    )
    integration: Literal["full", "reduced"] = Field(
        "full",
        description="the integration of the elastic forces: over Gauss points, or over three Lobatto points, which "
        "reduces the stretch of a coarse mesh",
    )
    quadrature_points: Count = Field(
        4, ge=1, le=10, description="the number of Gauss points per element for the elastic forces in full integration"
    )

    _section: dict[str, Any] | None = PrivateAttr(None)
    _nominal_length: float | None = PrivateAttr(None)
    _as_long_as_its_teeth: bool = PrivateAttr(False)

    @classmethod
    def alternatives(cls) -> Mapping[str, FieldInfo]:
        """Arguments instead of the material, see `beltdyn.model.belt_form`."""
        return FORMS

    def value_of(self, key: str) -> Any:
        """As for any part; stiffnesses and mass follow from any form, the profile only from a given one."""
        if key in OWN or key == "length":
            return getattr(self, key)
        if key == "nominal_length":
            return None if self.length is None else self.nominal_length_of(self.length)
        return (self._section or {}).get(key, super().value_of(key))

    @property
    def arguments(self) -> dict[str, Any]:
        """As for any part; a nominal length is kept as given."""
        return self._with_its_length(super().arguments)

    def merged(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """As for any part; a stiffness replaces the material, and a profile the section.

        A belt made of a profile stays one, but where its material is changed; one of a nominal length keeps that.
        """
        arguments, section = super().merged(changes), self._section
        if section is not None and changes_as_sold(section, changes):
            return without_section(arguments) | section_with(section, changes) | dict(changes)
        return in_new_form(arguments, changes, {key: getattr(self, key) for key in OWN})

    @model_validator(mode="after")
    def _has_what_its_law_of_stretch_needs(self) -> Self:
        LAW_KEYS.check(self)
        if LAWS[self.stretch_law].through is not None and self.stretch_curve is None:
            raise ValueError(
                f'stretch_law = "{self.stretch_law}" needs a curve. Give [belt.stretch_curve] with strains and '
                "tensions, or a file"
            )
        if self.stretch_curve is None:
            return self
        if LAWS[self.stretch_law].through is None:
            raise ValueError(
                f'stretch_curve is incompatible with stretch_law = "{self.stretch_law}". Remove it, or set '
                'stretch_law = "measured"'
            )
        if self.axial_factor != 1:
            raise ValueError(
                f"axial_factor = {self.axial_factor:g} is incompatible with stretch_curve, which is of the whole belt. "
                "Remove axial_factor"
            )
        return self

    @model_validator(mode="wrap")
    @classmethod
    def _remember_how_it_is_sold(cls, data: Any, make: ModelWrapValidatorHandler[Self], info: ValidationInfo) -> Self:
        values = {key: data[key] for key in data if key != "sold"} if isinstance(data, Mapping) else data
        belt = make(values)
        if belt is data:
            return belt
        belt._section = as_sold(data, belt, (info.context or {}).get("base"))
        if belt.length is not None and isinstance(data, Mapping) and data.get("nominal_length") is not None:
            belt._nominal_length = Nominal.model_validate({"nominal_length": data["nominal_length"]}).nominal_length
            object.__setattr__(belt, "length", belt.length / belt.measured_stretch)
        elif belt.teeth and belt.length and isinstance(data, Mapping) and data.get("length") is None:
            belt._as_long_as_its_teeth = True
            object.__setattr__(belt, "length", belt.given_length / belt.measured_stretch)
        return belt

    @model_serializer(mode="wrap")
    def _as_given(self, dump: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """A nominal length is written as such, so that what it means follows the belt that is read."""
        written = self._with_its_length(dump(self))
        return written if self._section is None else written | {"sold": written_as_sold(self._section)}

    def _with_its_length(self, data: dict[str, Any]) -> dict[str, Any]:
        if self._as_long_as_its_teeth:
            return {key: value for key, value in data.items() if key != "length"}
        if self._nominal_length is None:
            return data
        return {key: value for key, value in data.items() if key != "length"} | {"nominal_length": self._nominal_length}

    @model_validator(mode="before")
    @classmethod
    def _take_any_form(cls, data: Any, info: ValidationInfo) -> Any:
        return to_material(data, (info.context or {}).get("base"))

    @model_validator(mode="after")
    def _only_some_elements_are_damped(self) -> Self:
        for key in (*DAMPING_TIMES, *LOSS_FACTORS):
            value = getattr(self, key)
            if value > 0 and not self.element_kind.is_damped:
                unit = " s" if key in DAMPING_TIMES else ""
                raise ValueError(
                    f'{key} = {value:g}{unit} is incompatible with discretization = "{self.discretization}", which has '
                    f'no damping. Set {key} = 0, or set discretization = "ancf"'
                )
        return self

    @model_validator(mode="after")
    def _has_a_range_of_temperature(self) -> Self:
        if self.temperature_range is not None and not self.temperature_range[0] < self.temperature_range[1]:
            low, high = self.temperature_range
            raise ValueError(
                f"temperature_range = [{low:g}, {high:g}] °C must be the lowest and the highest temperature. Exchange "
                "or change them"
            )
        return self

    @property
    def breaking_force(self) -> float | None:
        """Strength times width, N; None where the strength is not known."""
        return None if self.strength is None else self.strength * self.width

    @model_validator(mode="after")
    def _has_whole_teeth(self) -> Self:
        if self.teeth is None and self.toothing is None:
            return self
        if self.toothing is None:
            raise ValueError(
                f"teeth = {self.teeth} needs the pitch and stiffness of the teeth. Give a toothed profile such as "
                '"HTD 8M", or a group [belt.toothing]'
            )
        pitch = self.toothing.pitch
        if self.teeth is None:
            near = (
                ""
                if self.length is None
                else f": the length of {1e3 * self.length:.5g} mm is {self.length / pitch:.5g}"
            )
            raise ValueError(
                f"teeth is missing: the belt has teeth of a pitch of {1e3 * pitch:.5g} mm{near}. Give their number "
                "in place of a length"
            )
        if self.length is not None and abs(self.length / (self.teeth * pitch) - 1.0) > MOST_OFF:
            raise ValueError(
                f"length = {1e3 * self.length:.5g} mm is {self.length / pitch:.5g} pitches of {1e3 * pitch:.5g} mm, "
                f"but teeth = {self.teeth}. Omit length, which follows from the teeth"
            )
        if self.crossed:
            raise ValueError("crossed = true is incompatible with teeth, of which the back of a belt has none. Omit it")
        if self.wedge_angle is not None:
            raise ValueError("wedge_angle is incompatible with teeth: the belt is flat between them. Omit it")
        return self

    @property
    def has_single_teeth(self) -> bool:
        """Whether teeth act one by one in runs over time."""
        return self.toothing is not None and self.toothing.law == DISCRETE

    @model_validator(mode="after")
    def _one_loss_for_each_strain(self) -> Self:
        for time, factor in zip(DAMPING_TIMES, LOSS_FACTORS, strict=True):
            if getattr(self, time) > 0 and getattr(self, factor) > 0:
                raise ValueError(
                    f"{time} = {getattr(self, time):g} s and {factor} = {getattr(self, factor):g} exclude each other: "
                    "losses grow with the speed, or are independent of it. Keep one of them"
                )
        return self

    @model_validator(mode="after")
    def _has_what_compression_needs(self) -> Self:
        if self.compression_loss_factor > 0 and self.contact_stiffness is None:
            raise ValueError(
                f"compression_loss_factor = {self.compression_loss_factor:g} needs contact_stiffness, which gives the "
                "energy of compression. Give it, or set compression_loss_factor = 0"
            )
        return self

    @property
    def given_length(self) -> float:
        """The given length, m.

        Raises
        ------
        ModelError
            If it is not given; the drive computes it, see `Drive.belt_length`.
        """
        if self.length is None:
            raise ModelError("belt.length is open; the drive computes it. Use drive.belt_length, or give length.")
        return self.length

    @property
    def given_elements(self) -> int:
        """The given number of elements.

        Raises
        ------
        ModelError
            If it is not given; the drive chooses it, see `Drive.elements`.
        """
        if self.elements is None:
            raise ModelError("belt.elements is open; the drive chooses it. Use drive.elements, or give elements.")
        return self.elements

    @property
    def other_elements(self) -> str | None:
        """The kind of elements that is asked for and that a staying mesh does not have; None without one."""
        return None if self.discretization == QUINTIC.name else self.discretization

    @property
    def nominal_length(self) -> float | None:
        """The nominal length, m, if the belt is given by it."""
        return self._nominal_length

    @cached_property
    def entry(self) -> Entry | None:
        """The profile in the catalogue, if the belt is given by one that still exists."""
        section = self._section
        if section is None or not changes_as_sold(section, {}):
            return None
        try:
            return find_entry(read_catalogue(section.get("catalogue")), section["profile"])
        except LookupError:
            return None

    def is_of_profile(self, key: str) -> bool:
        """Whether the value of a key is that of its profile."""
        return self._section is not None and key not in self._section

    @property
    def rib_count(self) -> int | None:
        """Number of ribs, or of V-belts side by side; None for a belt that is sold by another measure."""
        entry = self.entry
        return (self._section or {}).get("ribs", 1 if entry is not None and entry.is_v_belt else None)

    @property
    def v_belts(self) -> int:
        """Number of V-belts side by side; 1 for a belt in one piece."""
        entry = self.entry
        return (self.rib_count or 1) if entry is not None and entry.is_v_belt else 1

    @property
    def wider(self) -> str:
        """What carries more than this belt, in words."""
        if self.entry is None or self.entry.sold_by != "ribs":
            return "a larger belt"
        return f"more {self.entry.piece}s"

    def rated(self, length: float) -> RatedBelt | RatedTeeth | None:
        """The belt as its profile is rated, with an unstretched length in m; None without a rating."""
        entry = self.entry
        if entry is not None and entry.tooth_rating is not None and self.toothing is not None:
            return RatedTeeth(entry.tooth_rating, self.toothing, self.width, self.mass_per_length, self.largest_tension)
        if entry is None or entry.rating is None or self._section is None:
            return None
        return RatedBelt(entry.rating, self.rib_count or 1, entry.is_v_belt, self.nominal_length_of(length))

    @property
    def measured_stretch(self) -> float:
        """Stretch of the belt under its measuring force, half of it in each of two strands."""
        return float(self.stretch_parameters.stretch(0.5 * (self.measuring_force or 0.0)))

    def nominal_length_of(self, length: float) -> float:
        """Nominal length of a closed belt of a given unstretched length, m; of a toothed one along its pitches."""
        return length * self.measured_stretch - (0.0 if self.teeth else 2.0 * pi * self.pitch_offset)

    def offset(self, side: Side, toothed: bool = True) -> float:
        """Distance from a surface to the tension line, m, which the belt adds to the radius of a pulley.

        A belt with teeth runs on their tops around pulleys without, on the inside.
        """
        if side == "outside":
            return self.back_offset
        tall = 0.0 if toothed or self.toothing is None else self.toothing.tooth_height or 0.0
        return self.pitch_offset + tall

    @property
    def given_pitch(self) -> float:
        """Unstretched pitch of the teeth, m; ModelError without teeth."""
        if self.teeth is None:
            raise ModelError("the belt has no teeth. Give belt.teeth.")
        return self.given_length / self.teeth

    def bent_strain(self, radius: FloatArray) -> FloatArray:
        """Strain of the tension line of a belt on circles without tension.

        Parameters
        ----------
        radius : ndarray
            R, m.
        """
        flexibility = self.bending_stiffness / self.axial_stiffness
        return np.asarray(self.element_kind.bent_strain * flexibility / np.asarray(radius) ** 2)

    @property
    def element_kind(self) -> ElementKind:
        """The element kind by `discretization`, or the paper's; `Drive.element_kind` is that of the mesh used."""
        return ELEMENTS[self.discretization or ANCF.name]

    @property
    def has_hysteresis(self) -> bool:
        """Whether it has a loss factor."""
        return self.stretch_loss_factor > 0 or self.bending_loss_factor > 0

    @property
    def area(self) -> float:
        """Area of the section, m²."""
        return self.width * self.thickness

    @property
    def second_moment(self) -> float:
        """Second moment of area of the section, b h³/12, m⁴."""
        return self.width * self.thickness**3 / 12

    @property
    def fourth_moment(self) -> float:
        """Fourth moment of area of the section, b h⁵/80, m⁶."""
        return self.width * self.thickness**5 / 80

    @property
    def shear_modulus(self) -> float:
        """Shear modulus E / 2(1 + ν), Pa."""
        return self.youngs_modulus / (2 * (1 + self.poissons_ratio))

    @property
    def shear_stiffness(self) -> float:
        """Shear stiffness k_s G A α₂, N; by default large enough to keep sections normal."""
        if self.shear_correction is None:
            return _NORMAL_SECTIONS * self.axial_stiffness
        return self.shear_correction * self.shear_modulus * self.area * self.bending_factor

    @property
    def axial_stiffness(self) -> float:
        """Axial stiffness E A α₁, or the initial slope of the measured curve, N."""
        return self.stretch_parameters.stiffness

    @cached_property
    def stretch_parameters(self) -> StretchParameters:
        """Parameters of the law of stretch, with tension over stretch and its inverse."""
        if self.stretch_curve is not None:
            return self.stretch_curve.parameters
        law = LAWS[self.stretch_law]
        given = {one.name: getattr(self, one.name) for one in law.parameters}
        own = (one.default if given[one.name] is None else given[one.name] for one in law.parameters)
        made: StretchParameters = law.record(self.youngs_modulus * self.area * self.axial_factor, *own)
        return made

    def local_stiffness(self, tension: float) -> float:
        """Tangent stiffness dN/dg at a tension, N."""
        law = self.stretch_parameters
        return float(law.tangent_stiffness(law.stretch(max(tension, 0.0))))

    @property
    def bending_stiffness(self) -> float:
        """Bending stiffness E I α₂, N m²."""
        return self.youngs_modulus * self.second_moment * self.bending_factor

    @property
    def wedge_factor(self) -> float:
        """Factor 1 / sin(wedge_angle / 2) on the coefficient of friction in grooves; 1 for a flat belt."""
        return 1.0 if self.wedge_angle is None else 1.0 / sin(self.wedge_angle / 2)

    @property
    def mass_per_length(self) -> float:
        """Mass per length of the unstretched belt, ρ A, kg/m."""
        return self.density * self.area

    @property
    def wave_speed(self) -> float:
        """Longitudinal wave speed of the unstrained belt, √(E A α₁ / ρ A), m/s."""
        return sqrt(self.axial_stiffness / self.mass_per_length)

    @property
    def rotary_inertia(self) -> float:
        """Rotary inertia per length of the unstretched belt, ρ I, kg m."""
        return self.density * self.second_moment


LAW_KEYS = LawKeys(Belt, "stretch_law", LAWS)
"""The keys of the stretch laws."""
