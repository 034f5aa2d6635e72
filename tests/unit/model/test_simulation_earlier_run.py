"""A run that begins in the state of an earlier one, as a drive file says it."""

from pathlib import Path

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, Simulation, loads
from beltdyn.model.simulation import EarlierRun


def settings(**more: object) -> Simulation:
    return Simulation(duration=1.0, output_interval=0.01, **more)


def test_a_relative_path_starts_at_the_drive_file_and_stays(drive: Drive, tmp_path: Path) -> None:
    """The text of a drive means the same wherever it goes, as into a result file."""
    text = drive.replace(simulation=settings(start={"file": "X", "time": 0.5})).text
    given = loads(text.replace(str(Path.cwd() / "X"), "runs/one.nc"), base=tmp_path)
    assert given.simulation.start == EarlierRun(file=tmp_path / "runs" / "one.nc", time=0.5)
    assert loads(given.text, base=tmp_path / "elsewhere") == given


def test_the_clock_goes_on_unless_it_is_set() -> None:
    start = {"file": "run.nc", "time": "500 ms"}
    assert (settings(start=start).begin, settings(start=start).end) == (0.5, 1.5)
    assert settings(start=start).instants.begin == 0.5
    assert settings(start=start, start_at=0.0).begin == 0.0
    assert settings(start={"file": "run.nc"}).begin == 0.0
    assert str(settings(start=start).start).endswith("run.nc at 0.5 s")


@pytest.mark.parametrize(
    ("start", "message"),
    [
        ("rest", 'start = "rest" is not a valid choice'),
        (3, "start = 3 is not a valid choice"),
        ({"fil": "run.nc"}, 'start.fil is not a known key. Did you mean "file"?'),
        ({"time": 0.5}, "start.file is missing. Give the result file of the earlier run"),
        ({"file": 3}, "start.file = 3 must be the path of a result file, as text"),
        ({"file": "run.nc", "time": "1 m"}, 'start.time = "1 m" must be in units of s'),
        ({"file": "run.nc", "time": -1.0}, "must be at least 0"),
    ],
)
def test_what_is_wrong_is_told_once(start: object, message: str) -> None:
    with pytest.raises(ModelError) as error:
        settings(start=start)
    assert message in str(error.value)
    assert len(str(error.value).splitlines()) == 1
