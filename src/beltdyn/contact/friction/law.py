"""What a friction law tells of itself beside its force."""

from collections.abc import Callable
from dataclasses import dataclass

from numpy.typing import ArrayLike

from beltdyn.arrays import FloatArray


@dataclass(frozen=True)
class FrictionLaw:
    """A friction law as models, results and analyses see it.

    Attributes
    ----------
    name : str
        Its name in a drive file.
    parameter : str
        Key of the number that it takes beside the coefficient of friction.
    saturation : callable
        Slip velocity at which friction is fully used, m/s, from the normal force (N/m), the coefficient of friction and
        the parameter.
    softened : callable
        What to change in a drive file so that friction is fully used at a slip velocity (m/s) no smaller than a given
        one, from the largest friction force (N/m) and that velocity.
    """

    name: str
    parameter: str
    saturation: Callable[[ArrayLike, ArrayLike, float], FloatArray]
    softened: Callable[[float, float], str]
