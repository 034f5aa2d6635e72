"""Friction laws, one per file (Eqs. 20 and 22, Fig. 3); importing one here registers it.

The laws of the package have one type, `CommonFriction`, chosen at run time: drives of any share compiled kernels.
"""

from collections import ChainMap
from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.contact.friction.air_film import AirFilm as AirFilm
from beltdyn.contact.friction.air_film import air_film
from beltdyn.contact.friction.creep_rate import CoefficientSlope as CoefficientSlope
from beltdyn.contact.friction.creep_rate import ForceSlope as ForceSlope
from beltdyn.contact.friction.creep_rate import RelativeCreep as RelativeCreep
from beltdyn.contact.friction.creep_rate import coefficient_slope, force_slope, relative_creep
from beltdyn.contact.friction.law import LAWS as LAWS
from beltdyn.contact.friction.law import FrictionLaw as FrictionLaw
from beltdyn.contact.friction.law import FrictionParameters as FrictionParameters
from beltdyn.contact.friction.stribeck import Stribeck as Stribeck
from beltdyn.contact.friction.stribeck import stribeck
from beltdyn.kernel import by_type, kernel


class CommonFriction(NamedTuple):
    """Parameters of one of the laws; those of the others are without effect."""

    law: int
    """Field of the law that holds, counted from 1."""
    relative_creep: RelativeCreep = RelativeCreep(1.0, 1.0)
    force_slope: ForceSlope = ForceSlope(1.0)
    coefficient_slope: CoefficientSlope = CoefficientSlope(1.0)
    stribeck: Stribeck = Stribeck(1.0, 1.0, 1.0, 1.0)
    air_film: AirFilm = AirFilm(1.0, 1.0, 1.0, 1.0, 1.0, 1.0)

    @property
    def own(self) -> Any:
        """Parameters of the law that holds."""
        return self[self.law]

    def saturation(self, normal: ArrayLike, friction: ArrayLike, rim: ArrayLike) -> FloatArray:
        """Slip velocity at which friction saturates, m/s."""
        found: FloatArray = self.own.saturation(normal, friction, rim)
        return found

    def smoothed(self, factor: float) -> "CommonFriction":
        """The law with its saturation at a slip velocity larger by a factor."""
        return self._replace(**{self._fields[self.law]: self.own.smoothed(factor)})


def as_common(law: FrictionParameters) -> FrictionParameters:
    """Parameters of a law of the package under the common type; others as they are."""
    for number, other in enumerate(CommonFriction(0)):
        if type(law) is type(other):
            chosen: dict[str, Any] = {CommonFriction._fields[number]: law}
            return CommonFriction(number, **chosen)
    return law


@kernel
def common_friction(
    law: CommonFriction, slip: float, normal: float, friction: float, rim: float
) -> tuple[float, float, float, float]:
    """Kernel of the common type: friction by the law that holds; see `FrictionLaw.force`."""
    if law.law == 1:
        return relative_creep(law.relative_creep, slip, normal, friction, rim)
    if law.law == 2:
        return force_slope(law.force_slope, slip, normal, friction, rim)
    if law.law == 3:
        return coefficient_slope(law.coefficient_slope, slip, normal, friction, rim)
    if law.law == 4:
        return stribeck(law.stribeck, slip, normal, friction, rim)
    return air_film(law.air_film, slip, normal, friction, rim)


_pressed = by_type(ChainMap(LAWS.by_class("force"), {CommonFriction: common_friction}), "friction_force")


@kernel
def friction_force(
    law: FrictionParameters, slip: float, normal: float, friction: float, rim: float
) -> tuple[float, float, float, float]:
    """Friction force along the tangent t and its derivatives (Eq. 20).

    Parameters
    ----------
    law
        Parameters of a friction law.
    slip
        Slip velocity v_t = t . dr/dt - omega R (Eq. 22), m/s.
    normal
        Normal force f_n, N/m; friction depends on its magnitude.
    friction
        Coulomb coefficient mu.
    rim
        Speed of the rim v_r = omega R, m/s.

    Returns
    -------
    tuple of 4 floats
        f_t (N/m), df_t/dv_t (N s/m^2), df_t/df_n, df_t/dv_r (N s/m^2).
    """
    pressure, sign = (normal, 1.0) if normal >= 0.0 else (-normal, -1.0)
    force, by_slip, by_pressure, by_rim = _pressed(law, slip, pressure, friction, rim)
    return force, by_slip, sign * by_pressure, by_rim
