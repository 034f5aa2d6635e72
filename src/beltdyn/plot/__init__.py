"""Figures of a run: ``f(run, ax=None) -> Axes``; labels and units come from its dataset. And the layout of a drive."""

from beltdyn.plot.animation import animate
from beltdyn.plot.configuration import configuration
from beltdyn.plot.contact import contact_forces, contact_pressure
from beltdyn.plot.gallery import FIGURES, save_all
from beltdyn.plot.history import energy, span_tensions, speeds, torques
from beltdyn.plot.layout import layout, save_layout
from beltdyn.plot.pulleys import capstan_margins, hub_loads, losses, powers, slip
from beltdyn.plot.spans import mid_spans, tension_spectrum, tensioners
from beltdyn.plot.sweep import orders, waterfall
from beltdyn.plot.wear import wear_by_arc, wear_by_belt

__all__ = [
    "FIGURES",
    "animate",
    "capstan_margins",
    "configuration",
    "contact_forces",
    "contact_pressure",
    "energy",
    "hub_loads",
    "layout",
    "losses",
    "mid_spans",
    "orders",
    "powers",
    "save_all",
    "save_layout",
    "slip",
    "span_tensions",
    "speeds",
    "tension_spectrum",
    "tensioners",
    "torques",
    "waterfall",
    "wear_by_arc",
    "wear_by_belt",
]
