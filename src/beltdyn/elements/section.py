"""Stiffness, damping and inertia of the belt's section, integrated over the thickness (Eqs. 8, 14 and 15)."""

from typing import NamedTuple

from beltdyn.kernel import kernel
from beltdyn.stretch import StretchParameters


class Section(NamedTuple):
    """The factors of Eqs. 14 and 15 after integration over the section, and the section's inertia and damping."""

    stretch: StretchParameters
    """Parameters of the law of stretch, E A alpha1 among them; their type says which law it is."""
    bending: float
    """E I alpha2, N m^2."""
    quartic: float
    """E I4 alpha2 with I4 = b h^5 / 80, N m^4."""
    shear: float
    """k_s G A alpha2, N."""
    shear_gradient: float
    """k_s G I alpha2, N m^2."""
    thickness: float
    """E A of the thickness stretch, N; no alpha touches it."""
    mass: float
    """rho A, kg/m."""
    rotary_inertia: float
    """rho I, kg m."""
    axial_damping: float = 0.0
    """E A alpha1 times the damping time of stretch, N s."""
    bending_damping: float = 0.0
    """E I alpha2 times the damping time of bending, N m^2 s."""
    bending_hysteresis: float = 0.0
    """Modulus of the hysteresis of bending that elements themselves take point by point, N m^2."""
    passing_length: float = 1.0
    """Length over which slow rates of bending are smoothed in it, m."""

    @property
    def axial(self) -> float:
        """E A alpha1 without strain, N."""
        return self.stretch.stiffness


@kernel(inline=True)
def is_damped(section: Section) -> bool:
    """Whether the material of a section has damping, or hysteresis of its own."""
    return section.axial_damping > 0.0 or section.bending_damping > 0.0 or section.bending_hysteresis > 0.0
