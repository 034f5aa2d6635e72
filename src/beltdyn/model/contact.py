"""The contact between belt and pulleys: penalty normal force and creep-rate friction."""

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import Field, model_validator

from beltdyn.contact.friction import LAWS as FRICTION_LAWS
from beltdyn.contact.friction import FrictionParameters
from beltdyn.contact.normal import LAWS as NORMAL_LAWS
from beltdyn.contact.normal import NormalParameters
from beltdyn.errors import ModelError
from beltdyn.kinds import Parameter
from beltdyn.model.friction_state import IN_WORDS, Friction
from beltdyn.parts.kind_fields import LawKeys, NameOf
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Count, Length, LineDamping, LineStiffness


class Contact(Part):
    """Penalty contact with friction, the same on every pulley.

    Stiffness, damping and the creep ratio of friction are numerical parameters. If omitted they are None, and chosen by
    the drive (`prepare`); see `beltdyn.model.defaults`.

    Each law of normal force and friction has its own parameters: the friction law ``"relative_creep"`` has
    `creep_ratio`, the slip velocity at saturation over the rim speed; ``"coefficient_slope"`` has `creep_velocity`, the
    slip velocity at saturation; ``"force_slope"`` (as published) has `creep_rate_factor`, the slope of the friction
    force over the slip velocity; ``"stribeck"`` has `kinetic_ratio` and `stribeck_velocity` beside `creep_ratio`, and
    friction that falls with the slip velocity; ``"air_film"`` has `film_radius`, `web_width` and `roughness` beside
    `creep_ratio`, and friction that falls with the speed of the web.

    Examples
    --------
    >>> drive.replace(contact=drive.contact.replace(friction=0.5)).contact.friction
    0.5
    """

    if TYPE_CHECKING:  # the keys of the laws

        def __init__(self, **keys: Any) -> None: ...
        def __getattr__(self, parameter: str) -> Any: ...

    either = ("stiffness", "allowed_penetration")

    stiffness: LineStiffness | None = Field(
        None, gt=0, description="the normal force per meter of belt and meter of penetration, in N/m^2"
    )
    allowed_penetration: Length | None = Field(
        None,
        gt=0,
        description="the largest penetration of the belt at rest, instead of stiffness, in m",
    )
    damping: LineDamping | None = Field(
        None, ge=0, description="the normal force per meter of belt and penetration rate in m/s, in N*s/m^2"
    )
    normal_law: Annotated[str, NameOf(NORMAL_LAWS, "no_pull")] = Field(
        "no_pull",
        description="the normal force: never tensile, or as published, which may be tensile where the belt leaves",
    )
    friction: Friction | None = Field(
        None,
        ge=0,
        description="the coefficient of friction, without the wedge effect, or a state of rubber on metal: "
        f"{IN_WORDS}; by default that of the belt",
    )
    friction_law: Annotated[str, NameOf(FRICTION_LAWS, "relative_creep")] = Field(
        "relative_creep", description="the friction law"
    )
    moment_arm: Literal["rim", "point"] = Field(
        "rim",
        description="the moment arm of friction about the shaft: the effective radius, for which friction never "
        "generates energy, or the distance of the belt point, as published",
    )
    slip_radius: Literal["rim", "cord"] = Field(
        "rim",
        description="the radius with which slip is taken: the effective radius of the pulley, as published, or that of "
        "the cord, which sinks into the belt's rubber, so that slip grows with the tension over the radius",
    )
    sampling: Literal["distributed", "nodal"] = Field(
        "distributed",
        description="the sampling of contact: distributed along the element, or, for comparison, at its nodes only",
    )
    integration: Literal["zone", "fixed"] = Field(
        "zone",
        description="the range of integration of distributed contact: the contact zone, or the whole element",
    )
    quadrature_points: Count = Field(
        5, ge=1, le=64, description="the number of Gauss points per element for distributed contact forces"
    )

    @model_validator(mode="after")
    def _has_stiffness_or_penetration(self) -> Self:
        if self.stiffness is not None and self.allowed_penetration is not None:
            raise ValueError("stiffness and allowed_penetration exclude each other. Remove one of them")
        return self

    @model_validator(mode="after")
    def _has_the_parameters_of_its_laws(self) -> Self:
        for keys in LAW_KEYS:
            keys.check(self)
        return self

    @property
    def open_keys(self) -> tuple[str, ...]:
        """Keys of open values, which the drive chooses."""
        laws = NORMAL_LAWS[self.normal_law], FRICTION_LAWS[self.friction_law]
        found = [parameter.name for law in laws for parameter in law.parameters if parameter.found]
        return tuple(key for key in ("stiffness", "damping", *found) if getattr(self, key) is None)

    def given(self, key: str) -> float:
        """A given number.

        Raises
        ------
        ModelError
            If it is not given; the drive chooses it.
        """
        number: float | None = getattr(self, key)
        if number is None:
            raise ModelError(f"contact.{key} is open; the drive chooses it. Use prepare(drive).contact, or give {key}.")
        return number

    @property
    def normal_parameters(self) -> NormalParameters:
        """Parameters of the law of the normal force; their type identifies the law."""
        law = NORMAL_LAWS[self.normal_law]
        given = self.given("stiffness"), self.given("damping")
        parameters: NormalParameters = law.record(*given, *self._values(law.parameters))
        return parameters

    @property
    def friction_parameters(self) -> FrictionParameters:
        """Parameters of the friction law, with its saturation; their type identifies the law."""
        law = FRICTION_LAWS[self.friction_law]
        parameters: FrictionParameters = law.record(*self._values(law.parameters))
        return parameters

    def _values(self, parameters: Iterable[Parameter]) -> Iterator[Any]:
        """What is given for some parameters, or their defaults."""
        for parameter in parameters:
            value = getattr(self, parameter.name)
            value = parameter.default if value is None else value
            yield self.given(parameter.name) if value is None else value


LAW_KEYS = LawKeys(Contact, "normal_law", NORMAL_LAWS), LawKeys(Contact, "friction_law", FRICTION_LAWS)
"""The keys of the laws of contact."""
