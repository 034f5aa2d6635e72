"""Slip of the pulleys relative to the driver, and its parts."""

from typing import NamedTuple

import numpy as np

from beltdyn.arrays import FloatArray, IntArray
from beltdyn.model import Prepared
from beltdyn.results.mechanics import (
    across,
    cells,
    gross_sliding,
    pressing,
    relative_loss,
    sliding_shares,
    sliding_velocity,
)
from beltdyn.theory.elastic_creep import entry_strain

# Sliding of the belt on every pulley


def sliding_of_pulleys(
    prepared: Prepared,
    belt_coordinate: FloatArray,
    touched: IntArray,
    normal: FloatArray,
    slip_velocity: FloatArray,
    pulley_speed: FloatArray,
) -> dict[str, FloatArray]:
    """Speed (m/s) and share of sliding of each pulley, shape (k, pulleys), from contact at points."""
    sliding = sliding_velocity(slip_velocity, normal, touched, pulley_speed, prepared)
    pressed = pressing(normal, touched, len(prepared.pulleys))
    return {
        "sliding_speed": gross_sliding(sliding, pressed, prepared),
        "sliding_share": sliding_shares(sliding, pressed, cells(belt_coordinate, prepared.belt_length)),
    }


class SlipParts(NamedTuple):
    """Slip and its parts, shape (..., pulleys), over the speed of the driver's rim."""

    slip: FloatArray
    """The sum of the others."""
    elastic_creep: FloatArray
    """By the stretch of the spans that reach the two pulleys."""
    bending: FloatArray
    """By what bending and its hysteresis take from the stretch until the belt touches, beyond the rolling radii."""
    regularization: FloatArray
    """What is left: by the slope of the friction law, and by errors of the mesh."""
    sliding: FloatArray
    """By arcs that slide as a whole."""


def slip_parts(
    rim: FloatArray,
    tension: FloatArray,
    gross: FloatArray,
    elapsed: FloatArray | float,
    prepared: Prepared,
    at_arcs: tuple[FloatArray, FloatArray] | None = None,
) -> SlipParts:
    """Take slip apart into elastic creep, bending, what the slope of the friction law makes, and sliding.

    Between pulleys with teeth there is neither creep nor loss of stretch by bending: what is left is that of radii.

    With Coulomb's friction the belt adheres to every rim where it reaches it, with the tension T of the span before
    and the stretch g(T) there: the elastic creep is 1 - g(T_i) / g(T_d), (T_d - T_i) / EA at small strain (Grashof
    1883), with the driver d (`Drive.reference`). On its way there it bends, and the rim meets it with less stretch than
    the span has (`theory.elastic_creep.entry_strain`), on small pulleys by as much as it creeps. The rolling radii have
    a part of that already. A law of friction that starts at zero lets the belt creep where it touches, and on, while it
    bends.

    The tension T is that of spans, or where the belt reaches and leaves the pulleys (`at_arcs`), if it varies.
    """
    law = prepared.belt.stretch_parameters
    stretched = (law.stretch(np.max(tension, axis=-1)) - 1.0) * prepared.belt_length
    driver = prepared.reference
    runs = np.abs(rim[..., driver]) * elapsed > np.maximum(stretched, 0.0)
    rim = np.where(runs[..., None], rim, 0.0)
    before, after = across(tension, prepared) if at_arcs is None else at_arcs
    reaching = np.where(rim[..., driver, None] > 0.0, before, after)
    reached, lost = law.stretch(reaching), _entry_loss(reaching, prepared)
    total, sliding = relative_loss(-rim, rim, driver), relative_loss(gross, rim, driver)
    creeps = ~(prepared.toothed & prepared.toothed[driver])
    elastic = np.where(runs[..., None], creeps * (1.0 - reached / reached[..., driver, None]), np.nan)
    bending = np.where(runs[..., None], creeps * (lost - lost[..., driver, None]), np.nan)
    return SlipParts(total, elastic, bending, total - elastic - bending - sliding, sliding)


def _entry_loss(reaching: FloatArray, prepared: Prepared) -> FloatArray:
    """Strain lost where the belt first touches, beyond that of the rolling radii; none of elements that do not bend."""
    belt = prepared.belt
    if belt.element_kind.bent_strain == 0.0:
        return np.zeros_like(reaching)
    lost = entry_strain(
        reaching,
        prepared.radii,
        bending_stiffness=belt.bending_stiffness,
        axial_stiffness=belt.axial_stiffness,
        contact_stiffness=prepared.contact_stiffness,
        bent_strain=belt.element_kind.bent_strain,
        loss_factor=belt.bending_loss_factor,
    )
    return np.asarray(lost + belt.bent_strain(prepared.radii))
