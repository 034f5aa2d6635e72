"""Loads and motors on the shaft of a pulley: torques over its speed and angle, switched over time."""
