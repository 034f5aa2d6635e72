"""What a process does at points: a fault at one leaves the others, and says how to repeat it."""

import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.designs import study_columns
from beltdyn.designs.point_work import PointWork, compute_points
from beltdyn.model import Drive
from beltdyn.results import Result

Make = Callable[..., PointWork]


def widths_of(work: PointWork, *widths: float) -> list[Any]:
    points = [(number, {"belt.width": width}) for number, width in enumerate(widths)]
    return compute_points(work, points).outcomes


@pytest.mark.provokes_internal_errors
def test_an_internal_error_is_told_with_the_line_that_repeats_it(
    tiny_work: Make, drive: Drive, monkeypatch: pytest.MonkeyPatch
) -> None:
    reductions = dict(study_columns._REDUCTIONS)
    monkeypatch.setattr(study_columns, "_REDUCTIONS", {"largest": reductions["largest"]})  # another one is a KeyError
    work, request = tiny_work(), study_columns._Request("mean", "width")
    monkeypatch.setattr(study_columns, "request_of", lambda text: request)
    monkeypatch.setattr(study_columns, "_unnamed", lambda variable: [str(dim) for dim in variable.dims] or ["x"])
    first, other, third = widths_of(work, 0.01, -1.0, 0.02)
    for one in (first, third):
        assert re.match(r"internal error in designs/study_columns.py:\d+ \(KeyError: 'mean'\)", one.failure)
        assert one.values == {}
    assert "belt.width" in other.failure
    line = third.failure.partition("repeats it: ")[2]
    assert line == work.call({"belt.width": 0.02})


def test_the_line_that_repeats_a_point_is_python(drive: Drive) -> None:
    analysis = bd.analyses.ANALYSES["modes"]
    work = PointWork(drive, analysis, {"count": 3}, ("frequency",), None)
    found = eval(work.call({"belt.width": 0.012}), {"bd": bd, "drive": drive})
    assert isinstance(found, Result)
    assert list(found.dataset.data_vars)[:3] == ["frequency[1]", "frequency[2]", "frequency[3]"]
    assert found.dataset["belt.width"].values.tolist() == [0.012]


@pytest.mark.parametrize("profiles", [("SPZ", "SPA"), ("SPA", "SPZ")])
def test_what_only_some_points_have_is_told_at_the_others(profiles: Sequence[str], drive: Drive) -> None:
    """Whatever the order of the points: cords of SPA have no S-N line."""
    study = bd.ParameterStudy(
        analysis="steady_state",
        results=["cord_life", "largest_tension"],
        number=[{"path": "belt.profile", "values": profiles}],
    )
    given = drive.with_({"belt.profile": "SPZ", "belt.ribs": 1, "belt.installed_tension": "200 N"})
    found = bd.study(study, given, jobs=1).dataset
    has_it = found["belt.profile"].values == "SPZ"
    assert np.isfinite(found["cord_life"].values).tolist() == has_it.tolist()
    warned = ["'cord_life' needs data" in text for text in found["point_warnings"].values.tolist()]
    assert warned == (~has_it).tolist()
    assert np.isfinite(found["largest_tension"].values).all()


def test_points_of_runs_have_what_the_belt_has_data_for(fatigue_drive: Drive) -> None:
    """Of a belt with fatigue data too, which are of steady running alone."""
    study = bd.ParameterStudy(number=[{"path": "simulation.duration", "values": [1e-3]}])
    found = bd.study(study, fatigue_drive, jobs=1).dataset
    assert found["failure"].values.tolist() == [""]
    assert float(found["span_tension[small-large]"][0]) > 0.0
    assert not [name for name in found.data_vars if str(name).startswith(("cord_", "rib_"))]
