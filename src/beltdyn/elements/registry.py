"""All belt elements."""

from typing import Final

from beltdyn.elements.ancf.kind import ANCF
from beltdyn.elements.kind import ElementKind
from beltdyn.elements.three_node_beam import THREE_NODE_BEAM
from beltdyn.elements.truss import TRUSS

ELEMENTS: Final[tuple[ElementKind, ...]] = (
    ANCF,
    TRUSS,
    THREE_NODE_BEAM,
)
"""The element kinds, in the order in which they are named; the first is the default."""
