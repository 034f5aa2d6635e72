"""The elastic cover of a roller."""

from pydantic import Field

from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Length, Ratio, Stress
from beltdyn.theory.nip import cover_modulus


class Cover(Part):
    """An elastic cover of a roller: a layer that is thin against the radius, on a rigid core.

    Examples
    --------
    >>> rubber = bd.model.Cover(thickness="15 mm", youngs_modulus="4 MPa", poissons_ratio=0.45)
    >>> round(rubber.modulus / 1e6, 2)  # MPa
    15.17
    """

    thickness: Length = Field(gt=0, description="the thickness of the cover, within the radius of the pulley, in m")
    youngs_modulus: Stress = Field(gt=0, description="Young's modulus of the cover, in Pa")
    poissons_ratio: Ratio = Field(ge=0, lt=0.5, description="Poisson's ratio of the cover")

    loss_factor: Ratio = Field(0.0, ge=0, le=0.5, description="the loss factor (tan delta) of compression of the cover")

    @property
    def modulus(self) -> float:
        """Modulus of a layer that cannot expand sideways, E (1 - nu) / ((1 + nu) (1 - 2 nu)), Pa."""
        return cover_modulus(self.youngs_modulus, self.poissons_ratio)

    def stiffness(self, width: float) -> float:
        """Normal force per meter of belt of a width (m) and meter of compression, N/m^2."""
        return self.modulus / self.thickness * width
