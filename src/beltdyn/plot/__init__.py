"""Figures of a run: ``f(run, ax=None) -> Axes``; labels and units come from its dataset. And the layout of a drive."""

from beltdyn.plot.animation import animate
from beltdyn.plot.configuration import configuration
from beltdyn.plot.contact import contact_forces
from beltdyn.plot.gallery import save_all
from beltdyn.plot.history import energy, span_tensions, speeds, torques
from beltdyn.plot.layout import layout, save_layout

__all__ = [
    "animate",
    "configuration",
    "contact_forces",
    "energy",
    "layout",
    "save_all",
    "save_layout",
    "span_tensions",
    "speeds",
    "torques",
]
