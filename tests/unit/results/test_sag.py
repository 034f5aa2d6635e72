"""Sag of spans by their weight: the parabola of a constant tension, and where it turns the belt."""

import numpy as np
import pytest

from beltdyn.model import Prepared, prepare
from beltdyn.results.mechanics import SpanTension
from beltdyn.results.sag import sag_of, weight_of_meter, wrap_with_sag
from tests.lumped.drawn_drives import drawn_drive

TENSION = 800.0


@pytest.fixture(scope="module")
def heavy() -> Prepared:
    return prepare(drawn_drive(0).under(0.0).replace(gravity=(0.0, -9.81)))


def straight(prepared: Prepared) -> tuple[SpanTension, np.ndarray, np.ndarray]:
    """One tension all along, without speed, and the directions of straight spans."""
    tension = np.full((1, prepared.path.spans), TENSION)
    return SpanTension.uniform(tension), np.zeros_like(tension), prepared.path.span_directions[None]


def test_a_span_of_constant_tension_is_a_parabola(heavy: Prepared) -> None:
    """Longer by w^2 L^3 / 24 T^2, and turned by w L / 2 T at both ends, one way and the other."""
    tension, lifted, directions = straight(heavy)
    sag = sag_of(heavy, tension, lifted, directions)
    assert sag is not None
    length = heavy.path.span_lengths
    across = directions[0, :, 0] * weight_of_meter(heavy, tension)[0, 1]
    np.testing.assert_allclose(sag.longer[0], across**2 * length**3 / (24.0 * TENSION**2), rtol=1e-9)
    np.testing.assert_allclose(sag.start[0], 0.5 * across * length / TENSION, rtol=1e-9)
    np.testing.assert_allclose(sag.end, -sag.start, rtol=1e-9)


def test_sag_changes_wraps_by_what_it_turns_the_ends(heavy: Prepared) -> None:
    """Over the whole belt wraps change by as much as the ends turn; without weight nothing does."""
    tension, lifted, directions = straight(heavy)
    sag, path = sag_of(heavy, tension, lifted, directions), heavy.path
    assert sag is not None
    change = wrap_with_sag(heavy, tension, lifted, directions)[0] - path.wrap_angles
    turned = np.sign(path.radii) * (sag.start[0][path.leaving] - sag.end[0][path.reaching])
    np.testing.assert_allclose(change, turned, atol=1e-12)
    light = prepare(heavy.drive.replace(gravity=(0.0, 0.0)))
    assert sag_of(light, tension, lifted, directions) is None
    np.testing.assert_allclose(wrap_with_sag(light, tension, lifted, directions)[0], path.wrap_angles, rtol=1e-12)
