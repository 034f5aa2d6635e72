"""Graded meshes: they cover the belt, are finest at the ends of arcs, and grow evenly away from there."""

import numpy as np
import pytest

from beltdyn.errors import ConvergenceError
from beltdyn.model.resolution import Arc, graded_mesh, layer_length

ARCS = [Arc(0.18, 0.45, 0.08), Arc(0.80, 1.05, 0.08)]
LENGTH, LAYER = 1.25, 2e-3


def test_elements_make_the_belt() -> None:
    lengths = graded_mesh(LENGTH, ARCS, LAYER)
    assert lengths.sum() == pytest.approx(LENGTH, rel=1e-12)
    assert lengths.min() > 0.0


def test_nodes_stand_at_the_ends_of_arcs_where_elements_are_smallest() -> None:
    lengths = graded_mesh(LENGTH, ARCS, LAYER)
    nodes = np.concatenate([[0.0], np.cumsum(lengths)])
    for place in (end for arc in ARCS for end in arc[:2]):
        node = int(np.argmin(np.abs(nodes - place)))
        assert nodes[node] == pytest.approx(place, abs=1e-12)
        assert max(lengths[node - 1], lengths[node]) < 2.2 * LAYER


def test_an_endless_belt_asks_for_a_bounded_number_of_elements() -> None:
    """Such as that of a drive whose center was given in nanometers."""
    arcs = [Arc(1e12, 1e12 + 0.3, 0.08), Arc(2e12, 2e12 + 0.3, 0.08)]
    assert graded_mesh(3e12, arcs, LAYER).size < 100_000


def test_nodes_stand_at_kinks_amid_small_elements() -> None:
    """Those within the first elements of an arc get none."""
    kinked = [ARCS[0]._replace(kinks=(0.181, 0.3)), ARCS[1]]
    lengths, plain = (graded_mesh(LENGTH, arcs, LAYER) for arcs in (kinked, ARCS))
    nodes = np.concatenate([[0.0], np.cumsum(lengths)])
    node = int(np.argmin(np.abs(nodes - 0.3)))
    assert nodes[node] == pytest.approx(0.3, abs=1e-12)
    assert max(lengths[node - 1], lengths[node]) < 0.015
    assert np.abs(nodes - 0.181).min() > 1e-4
    assert lengths.sum() == pytest.approx(LENGTH, rel=1e-12)
    assert plain.size < lengths.size < plain.size + 10


def test_neighbours_differ_by_a_bounded_factor() -> None:
    lengths = graded_mesh(LENGTH, ARCS, LAYER)
    ratios = lengths[1:] / lengths[:-1]
    assert np.all(np.maximum(ratios, 1.0 / ratios) < 2.5)


def test_fineness_multiplies_the_number_of_elements() -> None:
    coarse, fine = (graded_mesh(LENGTH, ARCS, LAYER, fineness).size for fineness in (1.0, 3.0))
    assert fine == pytest.approx(3 * coarse, abs=2 * (2 * len(ARCS) + 1))


def test_layers_that_meet_on_a_short_arc_leave_a_mesh() -> None:
    """An arc shorter than the first element of its layers is one element."""
    lengths = graded_mesh(LENGTH, [ARCS[0], Arc(0.8, 0.801, 0.02)], LAYER)
    assert lengths.sum() == pytest.approx(LENGTH)
    assert lengths.min() == pytest.approx(1e-3)


def test_the_length_to_resolve() -> None:
    """Real roots of EI x^4 - T x^2 + k = 0 are 1 / sqrt(EI / T) and 1 / sqrt(T / k), complex ones (k / EI)^(1/4)."""
    assert layer_length(bending=6e-3, sinking=1.5e-3) == pytest.approx(3e-3)
    assert layer_length(bending=1e-3, sinking=2e-3) == 1e-3
    assert layer_length(bending=1e-5, sinking=1e-2) == pytest.approx(2e-3)


@pytest.mark.parametrize("arcs", [[(0.1, 0.5), (0.4, 0.6)], [(0.1, 0.9), (0.3, 0.5)], [(0.2, 0.3), (0.6, 1.1)]])
def test_arcs_that_overlap_are_refused(arcs: list[tuple[float, float]]) -> None:
    """As where a span lies against a pulley that its tensioner has moved too far."""
    with pytest.raises(ConvergenceError, match="outside of its arc"):
        graded_mesh(1.0, [Arc(start, end, 0.05) for start, end in arcs], LAYER)
