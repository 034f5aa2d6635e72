"""Compile-time dispatch of element kernels on the class of the first argument."""

from beltdyn.elements import ELEMENTS
from beltdyn.kernel import by_type

strain_energy = by_type(ELEMENTS.by_class("energy"), "strain_energy")
"""Strain energy of an element; see `ElementKind.energy`."""

elastic_force = by_type(ELEMENTS.by_class("force"), "elastic_force")
"""Elastic force of an element with its tangent; see `ElementKind.force`."""

damping_force = by_type(ELEMENTS.by_class("damping"), "damping_force")
"""Damping force of an element with its tangent; see `ElementKind.damping`."""

tension = by_type(ELEMENTS.by_class("tension"), "tension")
"""Tension for results; see `ElementKind.tension`."""
