"""Modes of the paper's drive at rest, and what is said of options that make no sense."""

from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.sparse import csc_array

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import Table
from beltdyn.solvers.eigenvalues import LIGHT, lightly_damped, pencil, swinging
from beltdyn.vibration.modes import modes


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
    assert "dry_tensioners" not in dataset  # none slides or sticks


def test_a_result_of_its_own(found: bd.Result, tmp_path: Path) -> None:
    again = bd.open_result(found.save(tmp_path / "modes.nc"))
    assert again.kind == "modes"
    assert str(again.dataset.attrs["title"]).startswith("Modes of ")
    tables = [path.name for path in bd.write_csv(found, tmp_path / "tables")]
    assert "mode.csv" in tables
    head = (tmp_path / "tables" / "mode.csv").read_text(encoding="utf-8").splitlines()[0]
    assert head.startswith("mode,frequency [Hz],damping_ratio [1]")


def damped_bodies() -> tuple[csc_array, csc_array, csc_array]:
    """Four bodies of 1 kg on springs, the first and third of which are damped beyond a half."""
    frequency, ratio = np.array([100.0, 200.0, 300.0, 400.0]), np.array([0.8, 0.01, 0.6, 0.02])
    return csc_array(np.diag(frequency**2)), csc_array(np.diag(2.0 * ratio * frequency)), csc_array(np.eye(4))


def test_heavily_damped_modes_are_not_counted() -> None:
    given = pencil(*damped_bodies(), np.zeros((4, 0)))
    values = swinging(given, 2, counted=lightly_damped)[0]
    np.testing.assert_allclose(np.abs(values), [100.0, 200.0, 300.0, 400.0], rtol=1e-9)
    assert lightly_damped(values).tolist() == [False, True, False, True]
    assert swinging(given, 1, counted=lightly_damped)[0].size == 2


@pytest.mark.slow
def test_lightly_damped_modes_come_first_and_keep_their_numbers() -> None:
    """The creep of the belt damps most motions of its tensioner by more than a half."""
    result = modes(bd.load(str(files("beltdyn") / "examples" / "alternator_drive.toml")), count=4)
    dataset = result.dataset
    light = dataset.damping_ratio.values < LIGHT
    assert np.all(np.diff(light.astype(int)) <= 0)
    assert np.count_nonzero(light) == 4
    by_number = dataset.sortby("mode")
    assert by_number.mode.values.tolist() == list(range(1, light.size + 1))
    assert np.all(np.diff(by_number.frequency.values) > 0.0)
    tables = [part for part in sheet(result).parts if isinstance(part, Table)]
    assert [table.title.partition(" (")[0] for table in tables] == ["Lightly damped", "Heavily damped"]
    assert [len(table.rows) for table in tables] == [4, light.size - 4]


@pytest.mark.slow
def test_modes_with_stuck_tensioners_have_numbers_of_their_own(drive: Drive) -> None:
    """Whatever the count, so that a number names one mode."""
    slide = {"kind": "sliding", "pulley": "slide", "direction": [0.0, 1.0], "mass": 0.5, "preload": 400.0, "rate": 2e4}
    centers = {"left": [0.0, 0.0], "right": [0.4, 0.0], "slide": [0.2, 0.25]}
    dry = Drive(
        belt=drive.belt.replace(installed_tension=230.0, length=None),
        pulley=[{"name": name, "center": at, "radius": 0.06, "inertia": 2e-3} for name, at in centers.items()],
        tensioner=[slide | {"tensioning_friction": 5.0}],
        contact=drive.contact,
        simulation=drive.simulation,
    )
    few, more = (modes(dry, about="rest", count=count).dataset for count in (2, 3))
    assert few.mode.values.tolist() == [1, 2, 101, 102]
    assert more.mode.values.tolist() == [1, 2, 3, 101, 102, 103]
    assert few.dry_tensioners.values.tolist() == ["sliding"] * 2 + ["stuck"] * 2
    np.testing.assert_allclose(more.frequency.sel(mode=few.mode), few.frequency, rtol=1e-7)


def test_an_open_belt_has_no_modes() -> None:
    with pytest.raises(ModelError, match=r"the belt is open, but modes need a closed belt\. Use `beltdyn stroke`"):
        modes(bd.example("printer_axis"))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"count": 0}, "count = 0 must be at least 1"),
        ({"count": 100}, "count = 100 exceeds the limit of 99 modes"),
        ({"about": "standstill"}, "about = 'standstill' is not a state"),
        ({"about": "rest", "speed": "800 rpm"}, "speed, pulley and at require about"),
        ({"pulley": "driver"}, "needs a speed to prescribe"),
        ({"speed": "800..900 rpm"}, "must be a single speed"),
        ({"speed": "fast"}, "speed = 'fast' must be a range"),
    ],
)
def test_options_that_make_no_sense(drive: Drive, options: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        modes(drive, **options)
