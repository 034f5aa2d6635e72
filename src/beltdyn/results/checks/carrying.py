"""Belts that sag too far between idlers."""

from collections.abc import Iterator

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.machines import Support
from beltdyn.model.carrying import lies_on, upper_side
from beltdyn.parts.messages import Finding, listing
from beltdyn.results.checks.evidence import Evidence
from beltdyn.theory.span import sag_ratio

MOST_SAG = 0.01
"""Largest sag over the spacing of idlers that passes without a warning: the usual rule for conveyors."""


def sagging_belt(evidence: Evidence) -> Iterator[Finding]:
    """Supports between whose idlers the belt sags too far at any time, with the goods that are on it."""
    fields, tension = (np.asarray(evidence.recorded[name]) for name in ("field_time", "belt_tension"))
    found, needed, closest = list[str](), 0.0, 1.0
    for number, support in enumerate(evidence.prepared.supports, 1):
        if not support.free_length > 0.0:
            continue
        on, weight = _on_support(evidence, support, fields)
        taut = np.maximum(tension[:, on], np.finfo(float).tiny)
        sag = sag_ratio(1.0, support.free_length, 1.0) * weight / taut
        if not sag.size or not sag.max() > MOST_SAG:
            continue
        row, column = np.unravel_index(int(sag.argmax()), sag.shape)
        least = sag_ratio(float(weight[row, column]), support.free_length, MOST_SAG)
        found.append(
            f"{sag[row, column]:.2g} of the spacing of support[{number}], {'-'.join(support.span)}, at t = "
            f"{fields[row]:.4g} s, where its tension is {tension[:, on][row, column]:.4g} N"
        )
        needed, closest = max(needed, least), min(closest, MOST_SAG / float(sag[row, column]))
    if found:
        yield Finding(
            f"the belt sags between idlers by {listing(found)}, more than {MOST_SAG:.0%}.",
            "Goods work on the belt and may spill; the idlers resist more than their friction coefficient says.",
            f"Raise the least tension to {needed:.3g} N by a heavier take-up, or place idlers {1.0 / closest:.2g} "
            "times as close.",
        )


def _on_support(evidence: Evidence, support: Support, fields: FloatArray) -> tuple[IntArray, FloatArray]:
    """Numbers of the elements on a support, and the weight across the belt there over time, N/m, shape (t, e)."""
    prepared, place = evidence.prepared, np.asarray(evidence.recorded["element_coordinate"])
    stretch = prepared.stretch(support)
    on = np.flatnonzero(lies_on(prepared.laid, stretch, place))
    mass = np.full((fields.size, on.size), prepared.belt.mass_per_length)
    for one in prepared.goods:
        share = np.ones(fields.size) if one.schedule is None else one.schedule.at(fields)
        mass += one.mass_per_length * share[:, None] * lies_on(prepared.laid, prepared.stretch(one), place[on])
    normal = upper_side(stretch.direction, prepared.gravity)
    return on, mass * abs(float(normal @ np.array(prepared.gravity)))
