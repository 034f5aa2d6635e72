"""Tensioners: what presses a pulley against the belt."""
