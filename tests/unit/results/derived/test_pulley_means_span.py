"""Spans of the made-up run are straight; what is added to them is found again."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.results import Run
from beltdyn.results.derived import mid_span_displacements, span_tensions

MakeRun = Callable[..., Run]
SINGLE = 1e-7
"""Rounding of places and displacements that were taken from a result, of up to 0.5 m, m."""


def test_numbers_of_the_tensions(make_run: MakeRun) -> None:
    tension = np.stack([np.linspace(0.0, 100.0, 101), np.full(101, 7.0)], axis=1)
    numbers = span_tensions(make_run(span_tension=tension), start=0.2)
    assert numbers["mean"].values == pytest.approx([60.0, 7.0])
    assert numbers["min"].values == pytest.approx([20.0, 7.0])
    assert numbers["max"].values == pytest.approx([100.0, 7.0])


def test_straight_spans_are_not_displaced(run: Run) -> None:
    displacement = mid_span_displacements(run)
    np.testing.assert_allclose(displacement, 0.0, atol=SINGLE)
    assert displacement.attrs == {"units": "m", "long_name": "Mid-span displacement"}


def test_bulge_of_the_lower_span(make_run: MakeRun, run: Run) -> None:
    """The span from driver to driven runs below, to the right: its left is up. A parabola is nearly linear between
    points next to each other: within an eighth of their distance squared times its curvature.
    """
    places = run.dataset["contact_position"].values.copy()
    half = 0.5 * run.drive.path.span_lengths[0]
    free = run.dataset["contact_pulley"].values < 0
    lower = free & (places[..., 1] < 0.0)
    height = 0.004 * np.sin(8.0 * run.dataset["time"].values)[:, None]
    places[..., 1] += np.where(lower, height * (1.0 - (places[..., 0] / half) ** 2), 0.0)
    displacement = mid_span_displacements(make_run(contact_position=places))
    apart = run.drive.path.length / run.dataset.sizes["contact_point"]
    np.testing.assert_allclose(displacement[:, 0], height[:, 0], atol=apart**2 / 8 * 2 * 0.004 / half**2)
    np.testing.assert_allclose(displacement[:, 1], 0.0, atol=SINGLE)


def test_displacement_is_measured_from_where_the_pulleys_are(make_run: MakeRun, run: Run) -> None:
    """Pulleys that have moved up with the belt have not displaced it."""
    moved = np.linspace(0.0, 0.01, 101)[:, None, None] * np.array([0.0, 1.0])
    dataset = run.dataset
    both = make_run(
        contact_position=dataset["contact_position"].values + moved,
        pulley_center=dataset["pulley_center"].values + moved,
    )
    np.testing.assert_allclose(mid_span_displacements(both), 0.0, atol=SINGLE)
    pulleys = make_run(pulley_center=dataset["pulley_center"].values + moved)
    np.testing.assert_allclose(mid_span_displacements(pulleys)[-1], [-0.01, 0.01], atol=SINGLE)


def test_a_belt_that_touches_nothing_has_no_spans(make_run: MakeRun, run: Run) -> None:
    free = np.full_like(run.dataset["contact_pulley"].values, -1)
    assert np.isnan(mid_span_displacements(make_run(contact_pulley=free))).all()


def test_a_single_output_is_a_window(run: Run) -> None:
    tensions, instant = span_tensions(run, start=0.5, end=0.5), run.dataset["span_tension"].sel(time=0.5)
    for name in ("mean", "min", "max"):
        np.testing.assert_allclose(tensions[name], instant, rtol=SINGLE)


def test_displacements_that_were_not_recorded(run: Run) -> None:
    """As in files of the first versions."""
    older = Run(run.dataset.drop_vars("mid_span_displacement"), run.drive)
    with pytest.raises(ModelError, match="has no `mid_span_displacement`: it was written by another version"):
        mid_span_displacements(older)
