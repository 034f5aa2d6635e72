"""Steady running: from a belt at rest, from a neighbour, and at many operating points."""
