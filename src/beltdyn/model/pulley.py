"""A pulley with prescribed speed or turning freely, with its hub chain and the loads on its shaft."""

import math
from collections.abc import Mapping, Sequence
from functools import cache
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

import numpy as np
from pydantic import ConfigDict, Field, create_model, field_validator, model_validator
from pydantic.fields import FieldInfo

from beltdyn.arrays import FloatArray
from beltdyn.contact.surface import KINDS, SurfaceKind
from beltdyn.errors import ModelError
from beltdyn.machines.links import AnyHubLink
from beltdyn.machines.loads import AnyLoad, FunctionLoad
from beltdyn.machines.profiles import SpeedProfile, TorqueProfile
from beltdyn.machines.profiles.harmonic import SpeedHarmonics
from beltdyn.machines.profiles.profile import Profile
from beltdyn.model.belt import Belt, Side, read_side
from beltdyn.model.contact import Contact
from beltdyn.model.friction_state import Friction
from beltdyn.model.toothing import FEWEST_TEETH, LARGEST_PITCH_ERROR, MOST_TEETH
from beltdyn.parts.kind_fields import OneOf, key_field
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Angle, Coordinate, Count, Inertia, Length, Mass, Name, Ratio, Stress
from beltdyn.theory.nip import cover_modulus, plane_modulus

# Covers of rollers


class Cover(Part):
    """An elastic cover of a roller: a layer that is thin against the radius, on a rigid core.

    Without a thickness the roller is solid, and gives way in a nip as Hertz's line contact does.

    Examples
    --------
    >>> rubber = bd.model.Cover(thickness="15 mm", youngs_modulus="4 MPa", poissons_ratio=0.45)
    >>> round(rubber.modulus / 1e6, 2)  # MPa
    15.17
    """

    thickness: Length | None = Field(
        None,
        gt=0,
        description="the thickness of the cover, within the radius of the pulley, in m; without it the roller is "
        "solid, of this material throughout",
    )
    youngs_modulus: Stress = Field(gt=0, description="Young's modulus of the cover, in Pa")
    poissons_ratio: Ratio = Field(ge=0, lt=0.5, description="Poisson's ratio of the cover")

    loss_factor: Ratio = Field(0.0, ge=0, le=0.5, description="the loss factor (tan delta) of compression of the cover")

    @property
    def modulus(self) -> float:
        """Modulus of a layer that cannot expand sideways, E (1 - nu) / ((1 + nu) (1 - 2 nu)), Pa."""
        return cover_modulus(self.youngs_modulus, self.poissons_ratio)

    def stiffness(self, width: float) -> float:
        """Normal force per meter of belt of a width (m) and meter of compression, N/m^2; infinite of a solid roller."""
        return math.inf if self.thickness is None else self.modulus / self.thickness * width

    @property
    def solid_modulus(self) -> float:
        """Modulus of a solid roller in plane strain, E / (1 - nu^2), Pa; infinite of a cover."""
        return plane_modulus(self.youngs_modulus, self.poissons_ratio) if self.thickness is None else math.inf


# Surfaces of pulleys other than smooth circles, a part for each kind


class Surface(Part):
    """A surface other than a smooth circle, which turns with its pulley."""

    if TYPE_CHECKING:  # the field that tells the kinds apart
        kind: str

        def __init__(self, **keys: Any) -> None: ...

    @property
    def parameters(self) -> dict[str, float]:
        """Parameters of its kind, by name."""
        return {parameter.name: getattr(self, parameter.name) for parameter in KINDS[self.kind].parameters}

    @property
    def reach(self) -> float:
        """Largest deviation beyond the effective radius, m."""
        return KINDS[self.kind].reach(self.parameters)


@cache
def surface_part(kind: SurfaceKind) -> type[Surface]:
    """Part of a kind of surface."""
    fields: dict[str, Any] = {parameter.name: (float, key_field(parameter)) for parameter in kind.parameters}
    title = "".join(word.capitalize() for word in kind.name.split("_"))
    named: Any = (Literal[kind.name], Field(kind.name, description="the kind of surface"))
    part: type[Surface] = create_model(f"{title}Surface", __base__=Surface, kind=named, **fields)
    return part


AnySurface = Annotated[Surface, OneOf(KINDS, surface_part)]


_SPATIAL = 3
"""Coordinates of a point in space."""


class Diameter(Part):
    """The size of a pulley as sold."""

    diameter: Length = Field(
        gt=0,
        description="the diameter of the pulley as sold, twice its radius: datum diameter for V-belts, effective "
        "diameter for V-ribbed belts, outside diameter for others and for the back, in m",
    )


ON_THE_BELT = ("datum", "effective", "pitch", "outside")
"""Kinds of diameters whose radius depends on the belt."""


def _describe_diameter(schema: dict[str, Any]) -> None:
    """Add the diameter, which is replaced by the radius on reading, to the JSON schema."""
    schema["properties"] |= Diameter.model_json_schema()["properties"]
    schema["required"] = [key for key in schema["required"] if key not in ("radius", "center")]
    schema["anyOf"] = [{"required": ["radius"]}, {"required": ["diameter"]}, {"required": ["teeth"]}]


Tilt = Annotated[Angle, Field(gt=-0.5, lt=0.5)]


class Pulley(Part):
    """A round pulley with a fixed center, unless a tensioner carries it.

    With `speed` the motion of its shaft is prescribed; without, it turns freely with its `inertia` under the belt,
    `torque` and its loads. The shaft is the rim itself, or the last body of the hub chain behind the rim. Speeds and
    torques are positive in the sense of `Drive.rotation`, by default counter-clockwise, and `torque` is what is applied
    to the shaft: a load that opposes a positive motion is negative.

    Examples
    --------
    >>> bd.Pulley(name="fan", center=["300 mm", 0.0], diameter="100 mm", inertia="12 kg cm^2").radius
    0.05
    """

    model_config = ConfigDict(json_schema_extra=lambda schema: _describe_diameter(schema))
    in_place_of = MappingProxyType({"diameter": "radius"})

    name: Name = Field(description="the name of the pulley, as text")
    center: tuple[Coordinate, Coordinate] = Field(description="the center of the pulley as [x, y], in m")
    radius: Length = Field(
        gt=0, description="the radius of the pulley at the contact surface of the belt, in m; of a toothed one, teeth"
    )
    diameter_kind: Literal["datum", "effective", "pitch", "outside", "flat"] | None = Field(
        None,
        description='the kind of diameter: "datum" of V-belts, "effective" of V-ribbed belts, "pitch" of the tension '
        'line, "outside" of the rim, or "flat" for the back of the belt; by default that by which pulleys of this belt '
        "are sold",
    )
    teeth: Count | None = Field(
        None,
        ge=FEWEST_TEETH,
        le=MOST_TEETH,
        description="the number of teeth for a toothed belt, from which the radius follows; none of a smooth pulley",
    )
    pitch_error: Ratio = Field(
        0.0,
        gt=-LARGEST_PITCH_ERROR,
        lt=LARGEST_PITCH_ERROR,
        description="the pitch of its teeth over that of the belt, less 1",
    )
    surface: AnySurface | None = Field(
        None, description="the surface, a group [pulley.surface], by default a smooth circle of this radius"
    )
    cover: Cover | None = Field(
        None, description="the elastic cover of a roller, a group [pulley.cover]; by default none"
    )
    side: Side = Field("inside", description="the side of the belt that touches the pulley; the outside is its back")
    friction: Friction | None = Field(
        None,
        ge=0,
        description="the coefficient of friction on this pulley, without the wedge effect; by default that of contact",
    )
    speed: SpeedProfile | None = Field(None, description="the prescribed speed of the shaft over time, in rad/s")
    harmonics: SpeedHarmonics = Field(
        (),
        description="the harmonics of the prescribed speed over the angle of its mean, or a table of a measured speed",
    )
    axial_offset: Coordinate = Field(
        0.0,
        description="the offset of the pulley along its shaft, out of the plane of the drive, for `alignment`, in m",
    )
    tilt: tuple[Tilt, Tilt] = Field(
        (0.0, 0.0), description="the tilts of its shaft about the x and the y axis, for `alignment`, in rad"
    )
    mass: Mass = Field(0.0, ge=0, description="the mass of the pulley, used if a tensioner moves it, in kg")
    inertia: Inertia = Field(0.0, ge=0, description="the moment of inertia of the rim about the shaft, in kg*m^2")
    torque: TorqueProfile | None = Field(None, description="the torque applied to the shaft over time, in N*m")
    load: tuple[AnyLoad, ...] = Field((), description="the loads and motors on the shaft, groups [[pulley.load]]")
    hub: tuple[AnyHubLink, ...] = Field(
        (), description="the links of the hub chain from rim to shaft, groups [[pulley.hub]]"
    )

    def value_of(self, key: str) -> Any:
        """As for any part; the diameter is twice the radius, unless its kind depends on the belt."""
        if key == "diameter":
            return None if self.diameter_kind in ("pitch", "outside") else 2.0 * self.radius
        return super().value_of(key)

    @classmethod
    def alternatives(cls) -> Mapping[str, FieldInfo]:
        """The diameter replaces the radius."""
        return Diameter.model_fields

    @model_validator(mode="before")
    @classmethod
    def _take_a_diameter(cls, data: Any) -> Any:
        if not isinstance(data, Mapping) or "diameter" not in data:
            return data
        values = dict(data)
        diameter, kind = values.pop("diameter"), values.get("diameter_kind")
        if diameter is None:
            return values
        if values.get("radius") is not None:
            raise ValueError("radius and diameter exclude each other. Keep one of them")
        size = Diameter.model_validate({"diameter": diameter}).diameter
        if kind in ON_THE_BELT:
            raise ValueError(
                f'diameter_kind = "{kind}" depends on the belt, which this pulley does not know. Give radius, or the '
                "keys of the pulley as a mapping to Drive"
            )
        return values | {"radius": size / 2}

    @model_validator(mode="before")
    @classmethod
    def _a_flat_runs_on_the_back(cls, data: Any) -> Any:
        if not isinstance(data, Mapping) or data.get("diameter_kind") != "flat":
            return data
        if read_side(data.get("side", "outside")) != "outside":
            raise ValueError(
                'diameter_kind = "flat" is that of a pulley on the back of the belt, but side = "inside". Set side = '
                '"outside", or another kind of diameter'
            )
        return {**data, "side": "outside"}

    @property
    def following(self) -> tuple[str, ...]:
        """The radius of a pulley with teeth follows from these."""
        return () if self.teeth is None else ("radius",)

    def merged(self, changes: Mapping[str, Any]) -> dict[str, Any]:
        """As for any part; other teeth give another radius, which the drive finds."""
        arguments = super().merged(changes)
        other = arguments.get("teeth") is not None and ("teeth" in changes or "pitch_error" in changes)
        return {key: value for key, value in arguments.items() if not (other and key == "radius")}

    @model_validator(mode="after")
    def _has_teeth_on_a_circle(self) -> Self:
        if self.teeth is None and self.pitch_error != 0.0:
            raise ValueError(f"pitch_error = {self.pitch_error:g} needs teeth. Give their number, or omit it")
        if self.teeth is not None and self.side == "outside":
            raise ValueError(
                f'teeth = {self.teeth} is incompatible with side = "outside": the back of the belt has no teeth. Omit '
                "teeth for a pulley on the back"
            )
        if self.teeth is not None and self.surface is not None:
            raise ValueError(
                f'surface of kind "{self.surface.kind}" is incompatible with teeth, whose grooves are those of a '
                "circle. Omit one of them"
            )
        return self

    @field_validator("center", mode="before")
    @classmethod
    def _lies_in_the_plane(cls, center: Any) -> Any:
        if isinstance(center, Sequence) and len(center) == _SPATIAL:
            raise ValueError(
                "has three coordinates, but drives are planar, with parallel shafts and aligned pulleys. Spatial "
                "layouts, such as quarter-turn drives, are not supported"
            )
        return center

    @model_validator(mode="after")
    def _is_prescribed_or_free(self) -> Self:
        if self.speed is not None and self.torque is not None:
            raise ValueError(
                "speed and torque exclude each other: the torque of a pulley with prescribed speed is a result. "
                "Remove one of them"
            )
        if self.speed is not None and self.load:
            raise ValueError(
                "speed and load exclude each other: the torque of a shaft with prescribed speed is a result. "
                "Remove one of them"
            )
        if self.speed is None and self.harmonics:
            raise ValueError("has harmonics but no speed. Give the mean speed, or remove harmonics")
        if self.speed is None and self.inertia == 0:
            raise ValueError(
                "has neither speed nor inertia. Give speed if its motion is prescribed, "
                "or an inertia above zero if it turns freely"
            )
        return self

    def driven_speed(self, duration: float = math.inf) -> float:
        """Largest speed at which the shaft is driven within a time (s), by its profile or its motors, rad/s.

        It is zero where nothing drives the shaft.
        """
        if self.speed is not None:
            return self.speed.largest(duration)
        return abs(self.motor_speed)

    def extreme_speed(self, begin: float, end: float) -> float:
        """Speed of largest magnitude at which the shaft is driven between two instants (s), with its sign, rad/s."""
        return self.motor_speed if self.speed is None else self.speed.extreme(end, begin)

    @property
    def motor_speed(self) -> float:
        """Speed up to which the fastest of its motors drives the shaft, with its sign, rad/s; zero without a motor."""
        return max((load.driven_speed for load in self.load), key=abs, default=0.0)

    @model_validator(mode="after")
    def _surface_holds_the_shaft(self) -> Self:
        if self.surface is not None and self.surface.reach >= self.radius:
            raise ValueError(
                f'surface of kind "{self.surface.kind}" deviates by {self.surface.reach:g} m from the radius of '
                f"{self.radius:g} m: the shaft would lie outside the rim. Reduce the deviation"
            )
        return self

    @model_validator(mode="after")
    def _bodies_have_inertia(self) -> Self:
        if self.hub and self.inertia == 0:
            raise ValueError("has a hub chain but no inertia of its free rim. Give an inertia above zero")
        free = self.hub[:-1] if self.prescribed else self.hub
        for number, link in enumerate(free, 1):
            if link.inertia == 0:
                raise ValueError(
                    f"hub[{number}] has no inertia, but the body behind it turns freely. Give an inertia above zero"
                )
        return self

    def reversed(self) -> Self:
        """The pulley with its speed, torques, loads and couplings in the opposite sense of rotation."""
        return self.replace(
            speed=self.speed and self.speed.reversed(),
            torque=self.torque and self.torque.reversed(),
            harmonics=tuple(wave.reversed() for wave in self.harmonics),
            load=tuple(load.reversed() for load in self.load),
            hub=tuple(link.reversed() for link in self.hub),
        )

    @property
    def turning(self) -> int:
        """Turning sense of the pulley by the belt: 1 counter-clockwise (inside), -1 clockwise (outside)."""
        return 1 if self.side == "inside" else -1

    @property
    def prescribed(self) -> bool:
        """Whether the motion of the shaft is prescribed."""
        return self.speed is not None

    @property
    def stands_still(self) -> bool:
        """Whether the shaft is prescribed to stand still at all times."""
        return self.speed is not None and self.speed.largest(math.inf) == 0.0

    @property
    def profiles(self) -> tuple[Profile, ...]:
        """All functions of time prescribed at the pulley."""
        given = (self.speed, self.torque, *self.switching)
        return tuple(profile for profile in given if profile is not None)

    @property
    def switching(self) -> tuple[Profile | None, ...]:
        """Factor and command of each load, then the factors of the hub links; None for missing ones."""
        of_loads = (profile for item in self.load for profile in (item.factor, item.command))
        return (*of_loads, *(link.factor for link in self.hub))


def fastest_rim(pulleys: Sequence[Pulley], radii: FloatArray, duration: float = math.inf) -> float:
    """Speed of the fastest driven rim within a time (s), m/s; zero without one."""
    speeds = np.array([pulley.driven_speed(duration) for pulley in pulleys])
    return float(np.max(np.abs(speeds * radii), initial=0.0))


def friction_on(pulley: Pulley, belt: Belt, contact: Contact) -> float:
    """Friction coefficient of a belt on a pulley, with the wedge factor on the inside."""
    return flat_friction_on(pulley, belt, contact) * (belt.wedge_factor if pulley.side == "inside" else 1.0)


def flat_friction_on(pulley: Pulley, belt: Belt, contact: Contact) -> float:
    """Friction coefficient of a belt on a pulley, without the wedge effect.

    It is that of the pulley, or of the lands on a toothed pulley, or of the contact, or of the belt: the first that is
    given.
    """
    if pulley.teeth is not None and belt.toothing is not None:
        return belt.toothing.land_friction if pulley.friction is None else pulley.friction
    for given in (pulley.friction, contact.friction, belt.friction):
        if given is not None:
            return given
    raise ValueError(
        "contact.friction is missing, and the belt has no friction of its own. Give the coefficient of friction "
        "without the wedge effect: 0.3 to 0.4 for rubber on metal"
    )


# Loads that no file and no other process can have


def has_functions(pulleys: Sequence[Pulley]) -> bool:
    """Whether a load of a pulley is a Python function."""
    return any(isinstance(load, FunctionLoad) for pulley in pulleys for load in pulley.load)


def refuse_functions(pulleys: Sequence[Pulley], rule: str, remedy: str) -> None:
    """Make sure that all loads can be written as text."""
    for pulley in pulleys:
        if has_functions([pulley]):
            raise ModelError(
                f'pulley "{pulley.name}" has a load of kind "function": {rule}. Give the load as a table, or {remedy}'
            )
