"""Prescribed speeds, torques and schedules over time, and harmonics over the shaft angle."""
