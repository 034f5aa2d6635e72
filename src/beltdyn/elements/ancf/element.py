"""First argument of the kernels of the paper's element."""

from typing import NamedTuple

from beltdyn.elements.kind import Section
from beltdyn.quadrature import Quadrature


class Ancf(NamedTuple):
    """The element of the paper's section 2: nodal coordinates r (m), r_x, r_y of node i, then of node j (Eq. 6)."""

    section: Section
    elastic: Quadrature
    """Points and weights on [0, 1] along the element."""
