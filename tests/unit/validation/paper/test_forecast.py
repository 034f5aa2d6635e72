from pathlib import Path

import pytest

from beltdyn.solvers.run_progress import BatchProgress
from validation.paper.forecast import Forecast, expected_time
from validation.paper.statements.model_runs import CASES, PAPER, TRUSSES, make
from validation.published import two_pulley

DRIVES = {f"{elements}": two_pulley(elements) for elements in (20, 25, 240)}


def test_fine_meshes_and_contact_at_nodes_are_expected_to_take_longer() -> None:
    coarse, fine, nodal = make(CASES[0], PAPER, 20), make(CASES[0], PAPER, 240), make(CASES[0], TRUSSES, 90)
    assert expected_time(coarse) < min(expected_time(fine), expected_time(nodal))


def test_a_share_grows_by_the_time_of_what_has_ended() -> None:
    """The long run is most of the work, however many short ones there are; timed runs follow."""
    told = list[BatchProgress]()
    forecast = Forecast(DRIVES, told.append)
    long = Path("runs/240.nc")
    forecast.runs(BatchProgress(0, 3, {}))
    forecast.runs(BatchProgress(0, 3, {long: 0.0, Path("runs/25.nc"): 0.5}))
    forecast.runs(BatchProgress(1, 3, {long: 0.5}))  # the third was not seen
    forecast.runs(BatchProgress(2, 3, {long: 0.9}))
    forecast.runs(BatchProgress(3, 3, {}))
    shares = [one.share or 0.0 for one in told]
    assert shares == sorted(shares)
    assert shares[0] == 0.0
    whole = sum(map(expected_time, DRIVES.values()))
    assert shares[2] / shares[-1] == pytest.approx(
        (0.5 * expected_time(DRIVES["240"]) + expected_time(DRIVES["25"])) / whole, rel=0.05
    )
    assert shares[-1] == pytest.approx(0.75)


def test_timed_runs_take_what_they_took_before(monkeypatch: pytest.MonkeyPatch) -> None:
    """In two turns, the long run first."""
    monkeypatch.setattr("validation.paper.forecast.usable_cores", lambda: 2)
    told = list[BatchProgress]()
    timed = Forecast({}, told.append).timed({"long": 3.0, "short": 1.0}, repeats=2)
    for turn in (0, 2):
        timed(BatchProgress(turn, 4, {Path("long.nc"): 0.0}, kind="timed runs"))
        timed(BatchProgress(turn + 1, 4, {Path("short.nc"): 0.0}, kind="timed runs"))
    timed(BatchProgress(4, 4, {}, kind="timed runs"))
    assert [one.share for one in told] == pytest.approx([0.0, 3 / 8, 4 / 8, 7 / 8, 1.0], abs=0.01)


def test_nothing_to_tell_and_nothing_to_time() -> None:
    forecast = Forecast({}, None)
    forecast.runs(BatchProgress(0, 0, {}))
    forecast.timed({}, 2)(BatchProgress(0, 0, {}))
