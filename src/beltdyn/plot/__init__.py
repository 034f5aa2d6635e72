"""Figures of a run: ``f(run, ax=None) -> Axes``; labels and units come from its dataset. And the layout of a drive."""

from beltdyn.plot.animation import animate as animate
from beltdyn.plot.campbell import campbell as campbell
from beltdyn.plot.campbell import mode_damping as mode_damping
from beltdyn.plot.configuration import configuration as configuration
from beltdyn.plot.contact import contact_forces as contact_forces
from beltdyn.plot.contact import contact_pressure as contact_pressure
from beltdyn.plot.figures import save_all as save_all
from beltdyn.plot.history import energy as energy
from beltdyn.plot.history import span_tensions as span_tensions
from beltdyn.plot.history import speeds as speeds
from beltdyn.plot.history import torques as torques
from beltdyn.plot.layout import layout as layout
from beltdyn.plot.layout import save_layout as save_layout
from beltdyn.plot.losses import losses as losses
from beltdyn.plot.modes import animate_modes as animate_modes
from beltdyn.plot.modes import mode_shape as mode_shape
from beltdyn.plot.operating_points import efficiency_map as efficiency_map
from beltdyn.plot.operating_points import operating_points as operating_points
from beltdyn.plot.operating_points import traction_curve as traction_curve
from beltdyn.plot.optimize import optimization as optimization
from beltdyn.plot.pulleys import capstan_margins as capstan_margins
from beltdyn.plot.pulleys import hub_load_sizes as hub_load_sizes
from beltdyn.plot.pulleys import hub_loads as hub_loads
from beltdyn.plot.pulleys import powers as powers
from beltdyn.plot.pulleys import slip as slip
from beltdyn.plot.registry import FIGURES as FIGURES
from beltdyn.plot.response import response as response
from beltdyn.plot.sensitivity import sensitivity as sensitivity
from beltdyn.plot.sensitivity import tolerances as tolerances
from beltdyn.plot.spans import mid_spans as mid_spans
from beltdyn.plot.spans import tension_spectrum as tension_spectrum
from beltdyn.plot.spans import tensioners as tensioners
from beltdyn.plot.stretch import save_stretch as save_stretch
from beltdyn.plot.stretch import stretch as stretch
from beltdyn.plot.study import parallel_coordinates as parallel_coordinates
from beltdyn.plot.study import study_contour as study_contour
from beltdyn.plot.study import study_lines as study_lines
from beltdyn.plot.study_effects import sobol_indices as sobol_indices
from beltdyn.plot.study_effects import tornado as tornado
from beltdyn.plot.sweep import orders as orders
from beltdyn.plot.sweep import waterfall as waterfall
from beltdyn.plot.tensioner_sheet import tensioner_sheet as tensioner_sheet
from beltdyn.plot.wear import wear_by_arc as wear_by_arc
from beltdyn.plot.wear import wear_by_belt as wear_by_belt

__all__ = [
    "FIGURES",
    "animate",
    "animate_modes",
    "layout",
    "save_all",
    "save_layout",
    "save_stretch",
    "stretch",
    *FIGURES,
]
