"""The contact between belt and pulleys: penalty normal force and creep-rate friction."""

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import Field, create_model, model_validator

from beltdyn.contact.friction import LAWS as FRICTION_LAWS
from beltdyn.contact.friction import FrictionLaw, FrictionParameters
from beltdyn.contact.normal import LAWS as NORMAL_LAWS
from beltdyn.contact.normal import NormalLaw, NormalParameters
from beltdyn.contact.parameter import Parameter
from beltdyn.errors import ModelError
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Count, Length, LineDamping, LineStiffness, Ratio, quantity


class Penalty(Part):
    """Contact stiffness and damping, common to all laws of the normal force."""

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


def _choice(laws: Iterable[str], default: str, meaning: str) -> Any:
    """Field that names one of several laws."""
    return Literal[tuple(sorted(laws, key=lambda name: (name != default, name)))], Field(default, description=meaning)


def _keys(laws: Mapping[str, FrictionLaw] | Mapping[str, NormalLaw]) -> dict[str, Any]:
    """Fields of the parameters of all laws."""
    return {parameter.name: _field(parameter) for law in laws.values() for parameter in law.parameters}


def _field(parameter: Parameter) -> Any:
    """Field of a parameter; None where its law is not chosen."""
    meaning = f"{parameter.meaning}, in {parameter.unit}" if parameter.unit else parameter.meaning
    number = Annotated[float, quantity(parameter.unit)]
    return number | None, Field(None, gt=parameter.above, description=meaning)


_NORMAL = "the normal force: never tensile, or as published, which may be tensile where the belt leaves"
_Laws: Any = create_model(
    "_Laws",
    __base__=Penalty,
    normal_law=_choice(NORMAL_LAWS, "no_pull", _NORMAL),
    **_keys(NORMAL_LAWS),
    friction=(
        Ratio | None,
        Field(
            None, ge=0, description="the coefficient of friction, without the wedge effect; by default that of the belt"
        ),
    ),
    friction_law=_choice(FRICTION_LAWS, "relative_creep", "the friction law"),
    **_keys(FRICTION_LAWS),
)


class Contact(_Laws, Penalty):
    """Penalty contact with friction, the same on every pulley.

    Stiffness, damping and the creep ratio of friction are numerical parameters. If omitted they are None, and chosen by
    the drive (`prepare`); see `beltdyn.model.defaults`.

    Each law of normal force and friction has its own parameters: the friction law ``"relative_creep"`` has
    `creep_ratio`, the slip velocity at saturation over the rim speed; ``"coefficient_slope"`` has `creep_velocity`, the
    slip velocity at saturation; ``"force_slope"`` (as published) has `creep_rate_factor`, the slope of the friction
    force over the slip velocity.

    Examples
    --------
    >>> drive.replace(contact=drive.contact.replace(friction=0.5)).contact.friction
    0.5
    """

    if TYPE_CHECKING:  # the fields that the laws make
        normal_law: str
        friction: float | None
        friction_law: str

        def __init__(self, **keys: Any) -> None: ...
        def __getattr__(self, parameter: str) -> Any: ...

    moment_arm: Literal["rim", "point"] = Field(
        "rim",
        description="the moment arm of friction about the shaft: the effective radius, for which friction never "
        "generates energy, or the distance of the belt point, as published",
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
        for kind, laws in (("normal", NORMAL_LAWS), ("friction", FRICTION_LAWS)):
            chosen = getattr(self, f"{kind}_law")
            own = {parameter.name: parameter for parameter in laws[chosen].parameters}
            for key, owner in ((key.name, law.name) for law in laws.values() for key in law.parameters):
                if key not in own and getattr(self, key) is not None:
                    raise ValueError(
                        f'{key} belongs to the {kind} law "{owner}", not to "{chosen}". '
                        f'Remove it, or set {kind}_law = "{owner}"'
                    )
            for key, parameter in own.items():
                if getattr(self, key) is None and parameter.default is None and not parameter.found:
                    raise ValueError(f'{key} is missing, but the {kind} law "{chosen}" needs it. Give {key}')
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
