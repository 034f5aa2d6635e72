"""Friction that falls with web speed, as the air that web and roller draw in lifts the web off their roughness.

The film of a web that wraps a roller of radius R (Knox and Sweeney 1971), with the tension T' = f_n R / b per width b,
the viscosity eta of the air, and the speeds v_r of the rim and v_r + v_t of the web:

    h = 0.643 R (6 eta |2 v_r + v_t| / T')^(2/3).

Friction is that of relative creep times a share: 1 up to h = sigma, the combined rms roughness of both surfaces,
3/2 - h / 2 sigma up to 3 sigma, 0 above (Ducotey and Good 1999).
"""

from typing import NamedTuple

from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray
from beltdyn.contact.friction.creep_rate import CREEP_KEYS, RelativeCreep, relative_creep
from beltdyn.contact.friction.law import FrictionLaw
from beltdyn.kernel import kernel
from beltdyn.kinds import Parameter, register


class AirFilm(NamedTuple):
    """Parameters of friction with an air film."""

    creep_ratio: float
    """s of relative creep."""
    standstill_creep: float
    """v_0 of relative creep, m/s."""
    film_radius: float
    """R, m."""
    web_width: float
    """b, m."""
    roughness: float
    """sigma, m."""
    air_viscosity: float
    """eta, Pa s."""

    def saturation(self, normal: ArrayLike, friction: ArrayLike, rim: ArrayLike) -> FloatArray:
        """Slip velocity v_c whatever the normal force, m/s."""
        return RelativeCreep(self.creep_ratio, self.standstill_creep).saturation(normal, friction, rim)

    def smoothed(self, factor: float) -> "AirFilm":
        """The law with its saturation at a slip velocity larger by a factor, and the same film."""
        return self._replace(creep_ratio=self.creep_ratio * factor, standstill_creep=self.standstill_creep * factor)


@kernel
def air_film(
    law: AirFilm, slip: float, normal: float, friction: float, rim: float
) -> tuple[float, float, float, float]:
    """Kernel of `FrictionLaw.force`: relative creep with the coefficient that the film leaves of mu."""
    entrained, tension = 2.0 * rim + slip, normal * law.film_radius / law.web_width
    shear, thickness = 6.0 * law.air_viscosity * abs(entrained), law.roughness / (0.643 * law.film_radius)
    dry = relative_creep(RelativeCreep(law.creep_ratio, law.standstill_creep), slip, normal, friction, rim)
    if shear <= tension * thickness**1.5:
        return dry
    if shear >= tension * (3.0 * thickness) ** 1.5:
        return 0.0, 0.0, 0.0, 0.0
    height = (shear / tension) ** (2.0 / 3.0) / thickness  # h / sigma
    share, fall = 1.5 - height / 2.0, -height / 3.0  # fall = 2/3 h d(share)/dh
    by_speed = dry[0] * fall / entrained
    return (
        share * dry[0],
        share * dry[1] + by_speed,
        share * dry[2] - dry[0] * fall / normal,
        share * dry[3] + 2.0 * by_speed,
    )


_KEYS = (
    *CREEP_KEYS,
    Parameter("film_radius", "m", "the radius of the rollers, for the height of the air film", example=0.05),
    Parameter("web_width", "m", "the width of the web, for its tension per width", example=0.1),
    Parameter("roughness", "m", "the combined rms roughness of web and rollers", example=3e-6),
    Parameter("air_viscosity", "Pa*s", "the viscosity of the air", default=1.81e-5, example=1.81e-5),
)
register(FrictionLaw("air_film", AirFilm, air_film, _KEYS))
