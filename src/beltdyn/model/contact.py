"""The contact between belt and pulleys: penalty normal force and creep-rate friction."""

from typing import Literal, Self

from pydantic import Field, model_validator

from beltdyn.contact.friction import LAWS, FrictionLaw
from beltdyn.parts.part import Part, computed
from beltdyn.parts.quantity import Count, CreepRate, Length, LineDamping, LineStiffness, Ratio, Speed

_LAWS = {law.name: law for law in LAWS}


class Contact(Part):
    """Penalty contact with tri-linear friction, the same on every pulley.

    The friction law ``"force_slope"`` (as published) takes `creep_rate_factor`, the slope of the friction
    force over the slip velocity; ``"coefficient_slope"`` takes `creep_velocity`, the slip velocity at which
    the coefficient of friction is reached.
    """

    stiffness: LineStiffness = computed(
        gt=0, description="the normal force per metre of belt and metre of penetration, in N/m^2"
    )
    allowed_penetration: Length | None = Field(
        None,
        gt=0,
        description="the depth to which the belt at rest may sink in anywhere, in place of stiffness, in m",
    )
    damping: LineDamping = Field(
        0.0, ge=0, description="the normal force per metre of belt and m/s of penetration, in N*s/m^2"
    )
    normal_law: Literal["no_pull", "published"] = Field(
        "no_pull", description="the normal force: never pulling, or as published, which may pull where the belt leaves"
    )
    friction: Ratio = Field(ge=0, description="the coefficient of friction")
    friction_law: Literal["force_slope", "coefficient_slope"] = Field("force_slope", description="the friction law")
    creep_rate_factor: CreepRate | None = Field(
        None, gt=0, description="the slope of the friction force over the slip velocity, in kg/(m*s)"
    )
    creep_velocity: Speed | None = Field(
        None, gt=0, description="the slip velocity at which friction is fully used, in m/s"
    )
    moment_arm: Literal["point", "rim"] = Field(
        "point",
        description="the arm of friction about the shaft: to the belt's point, as published, or the effective radius, "
        "with which friction never gives energy",
    )
    sampling: Literal["distributed", "nodal"] = Field(
        "distributed",
        description="the places of contact: all along an element, or for comparison its end nodes only",
    )
    integration: Literal["zone", "fixed"] = Field(
        "zone",
        description="the place where distributed contact is integrated: the touching zone, or the whole element",
    )
    quadrature_points: Count = Field(
        5, ge=1, le=64, description="the number of Gauss points an element for distributed contact forces"
    )

    @model_validator(mode="after")
    def _has_stiffness_or_penetration(self) -> Self:
        if self.stiffness is None and self.allowed_penetration is None:
            raise ValueError("stiffness is missing. Give it, or allowed_penetration in its place")
        if self.stiffness is not None and self.allowed_penetration is not None:
            raise ValueError("stiffness and allowed_penetration exclude each other. Remove one of them")
        return self

    @model_validator(mode="after")
    def _has_the_slope_of_its_law(self) -> Self:
        for law, key in ((law.name, law.parameter) for law in LAWS):
            given = getattr(self, key) is not None
            if law == self.friction_law and not given:
                raise ValueError(f'{key} is missing: the friction law "{law}" needs it. Give {key}')
            if law != self.friction_law and given:
                raise ValueError(
                    f'{key} belongs to the friction law "{law}", not to "{self.friction_law}". '
                    f'Remove it, or set friction_law = "{law}"'
                )
        return self

    @property
    def law(self) -> FrictionLaw:
        """The friction law."""
        return _LAWS[self.friction_law]

    @property
    def creep(self) -> float:
        """Parameter of the friction law: `creep_rate_factor` in kg/(m s), or `creep_velocity` in m/s."""
        return float(getattr(self, self.law.parameter))
