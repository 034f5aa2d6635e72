"""Figures of a run: ``f(run, ax=None) -> Axes``; labels and units come from its dataset."""

from beltdyn.plot.animation import animate
from beltdyn.plot.configuration import configuration
from beltdyn.plot.contact import contact_forces
from beltdyn.plot.gallery import save_all
from beltdyn.plot.history import energy, span_tensions, speeds, torques

__all__ = [
    "animate",
    "configuration",
    "contact_forces",
    "energy",
    "save_all",
    "span_tensions",
    "speeds",
    "torques",
]
