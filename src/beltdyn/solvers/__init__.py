"""Numerical methods on the equations of motion: time integration, equilibrium, eigenvalues. One compiled engine."""
