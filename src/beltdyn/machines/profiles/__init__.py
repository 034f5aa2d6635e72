"""Prescribed speeds, torques and schedules over time, and harmonics over the angle of a shaft."""
