"""Belt elements, a kind a file or a folder: energy, force and tangent, mass, and the curve that contact sees.

`kind` says what a kind provides, `registry` lists the kinds, and `dispatch` has their kernels under one name each.
"""

from beltdyn.elements.kind import Element, ElementKind
from beltdyn.elements.registry import ELEMENTS
from beltdyn.elements.section import Section

__all__ = ["ELEMENTS", "Element", "ElementKind", "Section"]
