"""Solvers: static equilibrium and simulation over time."""

from beltdyn.solve.progress import Progress
from beltdyn.solve.simulate import equilibrium, simulate
from beltdyn.solve.static import Equilibrium, find_equilibrium

__all__ = ["Equilibrium", "Progress", "equilibrium", "find_equilibrium", "simulate"]
