"""Belt elements, one kind per file or folder: energy, force, tangent, mass, and the curve for contact.

Importing a kind here registers it.  `kind` says what a kind provides, and `dispatch` has the kernels of all
kinds under one name each.
"""

from beltdyn.elements.ancf.belt_element import ANCF as ANCF
from beltdyn.elements.kind import ELEMENTS as ELEMENTS
from beltdyn.elements.kind import Element as Element
from beltdyn.elements.kind import ElementKind as ElementKind
from beltdyn.elements.kind import Section as Section
from beltdyn.elements.quintic import QUINTIC as QUINTIC
from beltdyn.elements.three_node_beam import THREE_NODE_BEAM as THREE_NODE_BEAM
from beltdyn.elements.truss import TRUSS as TRUSS
