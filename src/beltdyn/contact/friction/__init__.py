"""Friction laws, one per file (Eqs. 20 and 22, Fig. 3); importing one here registers it."""

from collections import ChainMap

from beltdyn.contact.friction.air_film import AirFilm as AirFilm
from beltdyn.contact.friction.common import CommonFriction as CommonFriction
from beltdyn.contact.friction.common import as_common as as_common
from beltdyn.contact.friction.common import common_friction
from beltdyn.contact.friction.creep_rate import CoefficientSlope as CoefficientSlope
from beltdyn.contact.friction.creep_rate import ForceSlope as ForceSlope
from beltdyn.contact.friction.creep_rate import RelativeCreep as RelativeCreep
from beltdyn.contact.friction.law import LAWS as LAWS
from beltdyn.contact.friction.law import FrictionLaw as FrictionLaw
from beltdyn.contact.friction.law import FrictionParameters as FrictionParameters
from beltdyn.contact.friction.stribeck import Stribeck as Stribeck
from beltdyn.kernel import by_type, kernel

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
