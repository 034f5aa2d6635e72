"""What a roller gives way by: an elastic cover, or all of it."""

from math import inf

from pydantic import Field

from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Length, Ratio, Stress
from beltdyn.theory.nip import cover_modulus, plane_modulus


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
        return inf if self.thickness is None else self.modulus / self.thickness * width

    @property
    def solid_modulus(self) -> float:
        """Modulus of a solid roller in plane strain, E / (1 - nu^2), Pa; infinite of a cover."""
        return plane_modulus(self.youngs_modulus, self.poissons_ratio) if self.thickness is None else inf
