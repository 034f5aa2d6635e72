"""Modes of the paper's drive at rest, and what is said of options that make no sense."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.solve.modes import modes


@pytest.fixture(scope="module")
def found(drive: Drive) -> bd.Result:
    return modes(drive, about="rest", count=5)


def test_spans_swing_as_strings(drive: Drive, found: bd.Result) -> None:
    dataset = found.dataset
    assert dataset.kind.values.tolist() == ["rotational", "span", "span", "span", "span"]
    tension = 26.56
    stretch = drive.path.length / drive.belt_length
    string = np.sqrt(tension * stretch / drive.belt.mass_per_length) / (2.0 * drive.path.span_lengths[0])
    np.testing.assert_allclose(dataset.frequency.values[1:], string * np.array([1, 1, 2, 2]), rtol=0.02)


def test_the_free_pulley_turns_on_the_spans_as_on_springs(drive: Drive, found: bd.Result) -> None:
    """Two spans of EA/L, each longer by the length over which a sticking belt takes its tension, sqrt(EA/k)."""
    axial, inertia, radius = drive.belt.axial_stiffness, 0.1, 0.08125
    length = drive.path.span_lengths[0] + 2.0 * np.sqrt(axial / (100.0 * 1e7))
    expected = radius * np.sqrt(2.0 * axial / length / inertia) / (2.0 * np.pi)
    assert float(found.dataset.frequency[0]) == pytest.approx(expected, rel=0.02)
    assert found.dataset.moving_parts.values[0] == "driven"


def test_shares_add_up_and_shapes_reach_one(found: bd.Result) -> None:
    dataset = found.dataset
    total = dataset.span_share.sum("span") + dataset.pulley_share.sum("pulley") + dataset.belt_share.sum("whole")
    np.testing.assert_allclose(total, 1.0, rtol=1e-12)
    for mode in dataset.mode.values:
        one = dataset.sel(mode=mode)
        parts = np.concatenate([one.belt_shape.values, one.rim_shape.values], axis=1)
        assert np.hypot(*parts).max() == pytest.approx(1.0)
    assert found.warnings == []


def test_a_result_of_its_own(found: bd.Result, tmp_path: Path) -> None:
    again = bd.open_result(found.save(tmp_path / "modes.nc"))
    assert again.kind == "modes"
    assert str(again.dataset.attrs["title"]).startswith("Modes of ")
    tables = [path.name for path in bd.write_csv(found, tmp_path / "tables")]
    assert "mode.csv" in tables
    head = (tmp_path / "tables" / "mode.csv").read_text(encoding="utf-8").splitlines()[0]
    assert head.startswith("mode,frequency [Hz],damping_ratio [1]")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"count": 0}, "count = 0 modes are none"),
        ({"about": "standstill"}, "about = 'standstill' is no state"),
        ({"about": "rest", "speed": "800 rpm"}, "speed, pulley and at go with about"),
        ({"pulley": "driver"}, "there is no speed"),
        ({"speed": "800..900 rpm"}, "must be one speed"),
        ({"speed": "fast"}, "speed = 'fast' must be a range"),
    ],
)
def test_options_that_make_no_sense(drive: Drive, options: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        modes(drive, **options)
