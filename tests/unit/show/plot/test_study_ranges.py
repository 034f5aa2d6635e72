"""Sobol indices against those that are known in closed form, and against SciPy's."""

import numpy as np
import pytest
from scipy import stats

from beltdyn.arrays import FloatArray
from beltdyn.designs.study_plan import unit_points
from beltdyn.show.plot.study_ranges import indices_of as sobol_indices


def ishigami(points: FloatArray) -> FloatArray:
    """Ishigami and Homma (1990), with a = 7, b = 0.1, over the unit cube."""
    x = np.pi * (2.0 * points - 1.0)
    value: FloatArray = np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])
    return value


def test_indices_of_ishigamis_function() -> None:
    values = ishigami(unit_points("saltelli", 3, 4096, 0))[:, None]
    first, total, first_error, total_error = sobol_indices(values, 3)
    assert first[0] == pytest.approx([0.3139, 0.4424, 0.0], abs=0.01)
    assert total[0] == pytest.approx([0.5576, 0.4424, 0.2437], abs=0.01)
    assert np.all(np.abs(first[0] - [0.3139, 0.4424, 0.0]) < 1.5 * first_error[0])
    assert np.all(np.abs(total[0] - [0.5576, 0.4424, 0.2437]) < 1.5 * total_error[0])


def test_indices_are_those_of_scipy() -> None:
    parts = ishigami(unit_points("saltelli", 3, 256, 1)).reshape(5, 256)
    theirs = stats.sobol_indices(func={"f_A": parts[:1], "f_B": parts[1:2], "f_AB": parts[2:, None]}, n=256)
    first, total, _, _ = sobol_indices(parts.reshape(-1, 1), 3)
    assert first[0] == pytest.approx(np.ravel(theirs.first_order), abs=1e-12)
    assert total[0] == pytest.approx(np.ravel(theirs.total_order), abs=1e-12)


def test_failed_points_are_left_out_and_a_level_result_has_no_indices() -> None:
    values = ishigami(unit_points("saltelli", 3, 4096, 0))
    values[::50] = np.nan
    first, _, _, _ = sobol_indices(np.stack([values, np.full_like(values, 3.0)], axis=1), 3)
    assert first[0] == pytest.approx([0.3139, 0.4424, 0.0], abs=0.04)
    assert np.all(np.isnan(first[1]))
