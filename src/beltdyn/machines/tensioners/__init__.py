"""Tensioners, which press a pulley against the belt."""
