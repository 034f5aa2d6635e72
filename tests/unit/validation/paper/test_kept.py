"""What is kept of a run made by formulas gives what the whole run gives."""

from pathlib import Path

import numpy as np
import pytest

from beltdyn.results import Run
from validation.paper.averages import contact_samples, mean_forces
from validation.paper.distribution import distribution
from validation.paper.kept import AT_END, CURVES, open_kept, paper_run, reduce


def test_curves_and_the_last_output_are_those_of_the_run(run: Run) -> None:
    kept = reduce(run)
    for name in CURVES:
        np.testing.assert_array_equal(kept[name], run.dataset[name])
    for name in AT_END:
        np.testing.assert_array_equal(kept[name], run.dataset[name][-1])
    assert kept.attrs == run.dataset.attrs


def test_means_are_those_of_the_run(run: Run) -> None:
    kept, data = Run(reduce(run), run.drive), run.dataset
    touching = data["contact_pulley"]
    for pulley in (0, 1):
        by_hand = data["normal_force"].where(touching == pulley).mean("contact_point")
        np.testing.assert_allclose(kept.dataset["mean_normal_force"][:, pulley], by_hand)
    slip = abs(data["slip_velocity"]).where(touching >= 0).mean("contact_point")
    np.testing.assert_allclose(kept.dataset["mean_slip_velocity"], slip)
    expected = np.concatenate([samples.mean("friction") for samples in contact_samples(run)])
    np.testing.assert_array_equal(mean_forces(kept, "friction"), expected)


@pytest.mark.parametrize(("at_limit", "mixed"), [(slice(0, 0), 0), (slice(7, 8), 1), (slice(5, 10), 0)])
def test_an_element_is_mixed_if_some_of_its_points_slide(run: Run, at_limit: slice, mixed: int) -> None:
    """Of the five points of the second element none, one or all carry what Coulomb's law allows."""
    data = run.dataset.copy(deep=True)
    data["contact_pulley"][:] = 0
    data["normal_force"][:] = 100.0
    limit = 100.0 * run.drive.frictions[0] / run.drive.contact.creep_rate_factor
    data["slip_velocity"][:] = 0.5 * limit
    data["slip_velocity"][:, at_limit] = -2.0 * limit
    np.testing.assert_array_equal(reduce(Run(data, run.drive))["mixed_elements"], mixed)


def test_points_that_are_free_neither_slide_nor_stick(run: Run) -> None:
    data = run.dataset.copy(deep=True)
    data["contact_pulley"][:] = -1
    kept = reduce(Run(data, run.drive))
    np.testing.assert_array_equal(kept["mixed_elements"], 0)
    assert np.all(np.isnan(kept["mean_slip_velocity"]))


def test_what_is_kept_is_small_and_read_again(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("validation.paper.kept.simulate", lambda *_, **__: run)
    whole = run.save(tmp_path / "whole.nc")
    kept = paper_run(run.drive)
    path = kept.save(tmp_path / "kept.nc")
    assert path.stat().st_size < 0.2 * whole.stat().st_size
    assert open_kept(path).equals(kept.dataset)


def test_an_interrupted_run_is_given_as_it_is(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    interrupted = Run(run.dataset.assign_attrs(status="interrupted"), run.drive)
    monkeypatch.setattr("validation.paper.kept.simulate", lambda *_, **__: interrupted)
    assert paper_run(run.drive) is interrupted


def test_distributions_are_read_from_what_was_kept(run: Run) -> None:
    forces = distribution(Run(reduce(run), run.drive), 0)
    assert forces.distance[0] == 0.0
    assert np.all(forces.normal > 0.0)
    assert np.all(np.diff(forces.place) > 0.0)
