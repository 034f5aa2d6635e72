"""Figures of a run: ``f(run, ax=None) -> Axes``; labels and units come from its dataset. And the layout of a drive."""

from typing import Any

from beltdyn.show.plot.animation import animate as animate
from beltdyn.show.plot.axis import carriage_error as carriage_error
from beltdyn.show.plot.axis import stroke as stroke
from beltdyn.show.plot.contact_pressure import arc_forces as arc_forces
from beltdyn.show.plot.contact_pressure import contact_forces as contact_forces
from beltdyn.show.plot.contact_pressure import contact_pressure as contact_pressure
from beltdyn.show.plot.contact_pressure import load_sharing as load_sharing
from beltdyn.show.plot.contact_pressure import nip_pressure as nip_pressure
from beltdyn.show.plot.contact_pressure import transmission_error as transmission_error
from beltdyn.show.plot.contact_pressure import transmission_orders as transmission_orders
from beltdyn.show.plot.contact_pressure import wear_by_arc as wear_by_arc
from beltdyn.show.plot.contact_pressure import wear_by_belt as wear_by_belt
from beltdyn.show.plot.convergence import mesh_convergence as mesh_convergence
from beltdyn.show.plot.convergence import tolerance_convergence as tolerance_convergence
from beltdyn.show.plot.design_history import belt_history as belt_history
from beltdyn.show.plot.design_history import damage_shares as damage_shares
from beltdyn.show.plot.design_history import line_tensions as line_tensions
from beltdyn.show.plot.design_history import optimization as optimization
from beltdyn.show.plot.design_history import sensitivity as sensitivity
from beltdyn.show.plot.design_history import sheet_slip_safety as sheet_slip_safety
from beltdyn.show.plot.design_history import sheet_tensions as sheet_tensions
from beltdyn.show.plot.design_history import tolerances as tolerances
from beltdyn.show.plot.drive_picture import configuration as configuration
from beltdyn.show.plot.drive_picture import save_stretch as save_stretch
from beltdyn.show.plot.drive_picture import stretch as stretch
from beltdyn.show.plot.figures import FIGURES as FIGURES
from beltdyn.show.plot.figures import always as always
from beltdyn.show.plot.figures import figure as figure
from beltdyn.show.plot.figures import over_time as over_time
from beltdyn.show.plot.figures import save_all as save_all
from beltdyn.show.plot.history import energy as energy
from beltdyn.show.plot.history import mid_spans as mid_spans
from beltdyn.show.plot.history import span_tensions as span_tensions
from beltdyn.show.plot.history import speeds as speeds
from beltdyn.show.plot.history import tension_spectrum as tension_spectrum
from beltdyn.show.plot.history import tensioners as tensioners
from beltdyn.show.plot.history import torques as torques
from beltdyn.show.plot.layouts import layout as layout
from beltdyn.show.plot.layouts import save_layout as save_layout
from beltdyn.show.plot.operating_map import efficiency_map as efficiency_map
from beltdyn.show.plot.operating_map import operating_points as operating_points
from beltdyn.show.plot.operating_map import tensioner_sheet as tensioner_sheet
from beltdyn.show.plot.operating_map import traction_curve as traction_curve
from beltdyn.show.plot.print_style import figure_style as figure_style
from beltdyn.show.plot.pulleys import hub_load_sizes as hub_load_sizes
from beltdyn.show.plot.pulleys import hub_loads as hub_loads
from beltdyn.show.plot.pulleys import losses as losses
from beltdyn.show.plot.pulleys import powers as powers
from beltdyn.show.plot.pulleys import slip as slip
from beltdyn.show.plot.pulleys import slip_safety as slip_safety
from beltdyn.show.plot.released_belt import iteration_steps as iteration_steps
from beltdyn.show.plot.released_belt import iterations as iterations
from beltdyn.show.plot.squeal import squeal as squeal
from beltdyn.show.plot.study_effects import parallel_coordinates as parallel_coordinates
from beltdyn.show.plot.study_effects import study_contour as study_contour
from beltdyn.show.plot.study_effects import study_lines as study_lines
from beltdyn.show.plot.study_ranges import sobol_indices as sobol_indices
from beltdyn.show.plot.study_ranges import tornado as tornado
from beltdyn.show.plot.style import axes_or_new as axes_or_new
from beltdyn.show.plot.style import color as color
from beltdyn.show.plot.style import dash as dash
from beltdyn.show.plot.style import label as label
from beltdyn.show.plot.style import name_lines as name_lines
from beltdyn.show.plot.vibration import amplitudes as amplitudes
from beltdyn.show.plot.vibration import animate_modes as animate_modes
from beltdyn.show.plot.vibration import campbell as campbell
from beltdyn.show.plot.vibration import mode_damping as mode_damping
from beltdyn.show.plot.vibration import mode_shape as mode_shape
from beltdyn.show.plot.vibration import response as response
from beltdyn.show.plot.waterfall import orders as orders
from beltdyn.show.plot.waterfall import waterfall as waterfall

__all__ = [
    "FIGURES",
    "always",
    "animate",
    "animate_modes",
    "axes_or_new",
    "color",
    "dash",
    "figure",
    "figure_style",
    "label",
    "layout",
    "name_lines",
    "over_time",
    "save_all",
    "save_layout",
    "save_stretch",
    "stretch",
    *FIGURES,
]


def __getattr__(name: str) -> Any:
    """A figure that was registered later."""
    if name in FIGURES:
        return FIGURES[name].draw
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
