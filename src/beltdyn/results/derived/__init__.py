"""Quantities derived from a run: functions of a `Run` that return labeled arrays with units."""

from beltdyn.results.derived.contact_profile import contact_arc, nip_profile, nips, wear_by_arc, wear_by_belt
from beltdyn.results.derived.pulley_means import (
    balance,
    hub_loads,
    mid_span_displacements,
    pulley_powers,
    sliding_arcs,
    slip_safeties,
    slip_safety,
    slips,
    span_tensions,
    tension_ratios,
    turn_means,
)
from beltdyn.results.derived.spectrum import (
    amplitude_spectrum,
    element_order,
    order_spectrum,
    orders,
    overall_level,
    transmission_error,
    waterfall,
)
from beltdyn.results.run import pulley_number

__all__ = [
    "amplitude_spectrum",
    "balance",
    "contact_arc",
    "element_order",
    "hub_loads",
    "mid_span_displacements",
    "nip_profile",
    "nips",
    "order_spectrum",
    "orders",
    "overall_level",
    "pulley_number",
    "pulley_powers",
    "sliding_arcs",
    "slip_safeties",
    "slip_safety",
    "slips",
    "span_tensions",
    "tension_ratios",
    "transmission_error",
    "turn_means",
    "waterfall",
    "wear_by_arc",
    "wear_by_belt",
]
