"""Friction laws, a law a file (Eqs. 20 and 22, Fig. 3).

A law provides the force with its exact derivatives as a kernel, and a `FrictionLaw`, which tells the rest of the
package its name, its parameter and where it saturates.  `registry` lists the laws.
"""

from beltdyn.contact.friction.law import FrictionLaw
from beltdyn.contact.friction.registry import LAWS, friction_force

__all__ = ["LAWS", "FrictionLaw", "friction_force"]
