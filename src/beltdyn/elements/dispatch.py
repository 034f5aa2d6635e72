"""Compile-time dispatch of element kernels on the class of the first argument."""

from beltdyn.elements import ELEMENTS
from beltdyn.kernel import by_type

strain_energy = by_type({kind.element: kind.energy for kind in ELEMENTS.values()}, "strain_energy")
"""Strain energy of an element; see `ElementKind.energy`."""

elastic_force = by_type({kind.element: kind.force for kind in ELEMENTS.values()}, "elastic_force")
"""Elastic force of an element with its tangent; see `ElementKind.force`."""

damping_force = by_type({kind.element: kind.damping for kind in ELEMENTS.values()}, "damping_force")
"""Damping force of an element with its tangent; see `ElementKind.damping`."""

tension = by_type({kind.element: kind.tension for kind in ELEMENTS.values()}, "tension")
"""Tension for results; see `ElementKind.tension`."""
