"""Belt elements, one kind per file or folder: energy, force, tangent, mass, and the curve for contact.

Importing a kind here registers it. `kind` says what a kind provides; the functions below choose the kernel of the
kind of their first argument.
"""

from beltdyn.elements.ancf import ANCF as ANCF
from beltdyn.elements.kind import ELEMENTS as ELEMENTS
from beltdyn.elements.kind import Element as Element
from beltdyn.elements.kind import ElementKind as ElementKind
from beltdyn.elements.kind import Section as Section
from beltdyn.elements.quintic import QUINTIC as QUINTIC
from beltdyn.elements.three_node_beam import THREE_NODE_BEAM as THREE_NODE_BEAM
from beltdyn.elements.truss import TRUSS as TRUSS
from beltdyn.kernel import by_type

strain_energy = by_type(ELEMENTS.by_class("energy"), "strain_energy")
"""Strain energy of an element; see `ElementKind.energy`."""

elastic_force = by_type(ELEMENTS.by_class("force"), "elastic_force")
"""Elastic force of an element with its tangent; see `ElementKind.force`."""

damping_force = by_type(ELEMENTS.by_class("damping"), "damping_force")
"""Damping force of an element with its tangent; see `ElementKind.damping`."""

tension = by_type(ELEMENTS.by_class("tension"), "tension")
"""Tension for results; see `ElementKind.tension`."""
