"""Slip and its parts on three pulleys, from speeds and tensions that are given."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.results import slip_safety
from beltdyn.results.mechanics import SpanTension
from beltdyn.results.slip_safety import SlipParts
from beltdyn.stretch import Green
from beltdyn.theory.creep import entry_strain

STIFFNESS, LENGTH = 1e4, 2.0
RADII = np.array([0.01, 0.05, 0.1])
BELT: Any = SimpleNamespace(
    stretch_parameters=Green(STIFFNESS),
    element_kind=SimpleNamespace(bent_strain=-1.5),
    bent_strain=lambda radii: -1.5e-3 / STIFFNESS / radii**2,
    bending_stiffness=1e-3,
    axial_stiffness=STIFFNESS,
    bending_loss_factor=0.1,
    mass_per_length=0.1,
)
DRIVE: Any = SimpleNamespace(
    belt=BELT,
    belt_length=LENGTH,
    pulleys=[SimpleNamespace(cover=None)] * 3,
    contact=SimpleNamespace(slip_radius="rim"),
    toothed=np.zeros(3, dtype=bool),
    reference=0,
    radii=RADII,
    contact_stiffness=1e9,
    path=SimpleNamespace(reaching=np.array([2, 0, 1]), leaving=np.arange(3)),
)
TENSION = np.array([30.0, 50.0, 90.0])
"""Of the spans that leave the pulleys: the tight one reaches the first pulley, which drives."""
RIM = np.array([10.0, 9.9, 9.95])
NOTHING = np.zeros(3)


def slip_parts(
    rim: FloatArray, tension: FloatArray, gross: FloatArray, elapsed: FloatArray | float, prepared: Any
) -> SlipParts:
    """Of spans with the same tension all along."""
    return slip_safety.slip_parts(rim, SpanTension.uniform(tension), gross, elapsed, prepared)


def test_slip_is_what_the_rims_lose_and_its_parts_make_it_up() -> None:
    gross = np.array([-0.02, 0.01, 0.0])
    total, elastic, radial, bending, added, sliding = slip_parts(RIM, TENSION, gross, 1.0, DRIVE)
    np.testing.assert_allclose(total, [0.0, 0.01, 0.005], rtol=1e-12)
    np.testing.assert_allclose(sliding, [0.0, 0.003, 0.002], rtol=1e-12)
    np.testing.assert_allclose(elastic + bending + added + sliding, total, rtol=0, atol=1e-15)
    assert not radial.any()


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_behind_a_driver_that_slides_slip_is_elastic_creep_from_the_belt_on(way: float) -> None:
    """Rims that hold a belt whose bending takes no stretch; the driver turns faster than it by up to half."""
    element = SimpleNamespace(bent_strain=0.0)
    limp: Any = SimpleNamespace(**vars(DRIVE) | {"belt": SimpleNamespace(**vars(BELT) | {"element_kind": element})})
    limp.belt.bent_strain = np.zeros_like
    reached = np.array([Green(STIFFNESS).stretch(one) for one in (90.0, 30.0, 50.0)])
    for part in (0.0, 0.1, 0.5):
        belt = (1.0 - part) * 10.0 * reached / reached[0]
        rim = way * np.array([10.0, *belt[1:]])
        gross = way * np.array([belt[0] - 10.0, 0.0, 0.0])
        tension = TENSION if way > 0.0 else np.roll(TENSION, 1)
        total, elastic, _, _, added, sliding = slip_parts(rim, tension, gross, 1.0, limp)
        np.testing.assert_allclose(added, 0.0, atol=1e-15)
        np.testing.assert_allclose(sliding[1:], part)
        np.testing.assert_allclose(elastic, (1.0 - part) * (1.0 - reached / reached[0]), atol=1e-15)
        np.testing.assert_allclose(total, elastic + sliding)


def test_slip_is_told_against_the_driver_wherever_it_is_listed() -> None:
    """The same drive from another pulley on: the same slip, creep and sliding of each pulley."""
    gross = np.array([-0.02, 0.01, 0.0])
    listed_third: Any = SimpleNamespace(**vars(DRIVE) | {"reference": 2, "radii": np.roll(RADII, -1)})
    rim, tension, slid = (np.roll(values, -1) for values in (RIM, TENSION, gross))
    parts, others = slip_parts(RIM, TENSION, gross, 1.0, DRIVE), slip_parts(rim, tension, slid, 1.0, listed_third)
    for part, moved in zip(parts, others, strict=True):
        np.testing.assert_allclose(np.roll(part, -1), moved, atol=1e-15)


@pytest.mark.parametrize(("way", "reaching"), [(1.0, [90.0, 30.0, 50.0]), (-1.0, [30.0, 50.0, 90.0])])
def test_elastic_creep_is_by_the_stretch_of_the_spans_that_reach_the_pulleys(way: float, reaching: list[float]) -> None:
    """Those before them, or behind them where the belt runs back; (T_0 - T_i) / EA at small strain e, to 4 e of it."""
    tension = np.array(reaching)
    for smaller in (1.0, 1e-3):
        elastic = slip_parts(way * RIM, smaller * TENSION, NOTHING, 1.0, DRIVE)[1]
        exact = np.array([Green(STIFFNESS).stretch(one) for one in smaller * tension])
        np.testing.assert_allclose(elastic, 1.0 - exact / exact[0], rtol=0, atol=1e-15)
        strain = smaller * 90.0 / STIFFNESS
        linear = smaller * (tension[0] - tension) / STIFFNESS
        np.testing.assert_allclose(elastic, linear, rtol=4.0 * strain, atol=1e-15)


def test_speeds_and_slidings_of_any_unit_give_the_same_slip() -> None:
    gross = np.array([-0.02, 0.01, 0.0])
    parts, scaled = (slip_parts(c * RIM, TENSION, c * gross, 1.0, DRIVE) for c in (1.0, 1e3))
    for one, other in zip(parts, scaled, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-9, atol=1e-15)


@pytest.mark.parametrize(("share", "known"), [(0.99, False), (1.01, True)])
def test_a_rim_stands_still_while_it_goes_no_further_than_the_belt_is_stretched(share: float, known: bool) -> None:
    """At 90 N of 10 kN the belt of 2 m is longer by about 18 mm: at 10 m/s it runs as far in 1.8 ms."""
    elapsed = share * (float(Green(STIFFNESS).stretch(90.0)) - 1.0) * LENGTH / 10.0
    for part in slip_parts(RIM, TENSION, NOTHING, elapsed, DRIVE):
        assert np.isfinite(part).all() == known


def test_every_instant_counts_for_itself() -> None:
    """With one at rest among them."""
    rims = np.stack([RIM, 0.0 * RIM, 2.0 * RIM])
    tensions = np.stack([TENSION, TENSION, TENSION[::-1]])
    together = slip_parts(rims, tensions, np.zeros((3, 3)), np.ones(3), DRIVE)
    for index in range(3):
        alone = slip_parts(rims[index], tensions[index], NOTHING, 1.0, DRIVE)
        for one, all_of_them in zip(alone, together, strict=True):
            np.testing.assert_array_equal(one, all_of_them[index])


def test_a_cord_sinks_by_the_tension_that_presses_over_stiffness_and_radius() -> None:
    """Over the radius once more; the driver, which the tight span reaches, turns faster for it."""
    cord: Any = SimpleNamespace(**vars(DRIVE) | {"contact": SimpleNamespace(slip_radius="cord")})
    parts = slip_parts(RIM, TENSION, NOTHING, 1.0, cord)
    sinking = (np.array([90.0, 30.0, 50.0]) - 0.1 * RIM**2) / 1e9 / RADII**2
    np.testing.assert_allclose(parts.radial, sinking[0] - sinking, rtol=1e-12)
    assert parts.radial[1] > 0.0
    np.testing.assert_allclose(sum(parts[1:]), parts.slip, rtol=0, atol=1e-15)
    toothed: Any = SimpleNamespace(**vars(cord) | {"toothed": np.ones(3, dtype=bool)})
    assert not slip_parts(RIM, TENSION, NOTHING, 1.0, toothed).radial.any()


def test_bending_is_by_the_stretch_that_is_lost_before_the_belt_touches() -> None:
    """Beyond the rolling radii; most on the small pulley that drives, and nothing without stiffness."""
    bending = slip_parts(RIM, TENSION, NOTHING, 1.0, DRIVE).bending
    lost = entry_strain(
        np.array([90.0, 30.0, 50.0]),
        RADII,
        bending_stiffness=1e-3,
        axial_stiffness=STIFFNESS,
        contact_stiffness=1e9,
        bent_strain=-1.5,
        loss_factor=0.1,
    ) + BELT.bent_strain(RADII)
    np.testing.assert_allclose(bending, lost - lost[0], rtol=1e-12)
    assert bending[1] > 0.0
    straight = SimpleNamespace(**vars(BELT) | {"element_kind": SimpleNamespace(bent_strain=0.0)})
    limp: Any = SimpleNamespace(**vars(DRIVE) | {"belt": straight})
    assert not slip_parts(RIM, TENSION, NOTHING, 1.0, limp).bending.any()


def test_teeth_do_not_creep() -> None:
    toothed: Any = SimpleNamespace(**vars(DRIVE) | {"toothed": np.ones(3, dtype=bool)})
    parts = slip_parts(RIM, TENSION, NOTHING, 1.0, toothed)
    np.testing.assert_array_equal(parts.elastic_creep, NOTHING)
    np.testing.assert_array_equal(parts.bending, NOTHING)
    np.testing.assert_allclose(parts.regularization, parts.slip, atol=1e-15)
