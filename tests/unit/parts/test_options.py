"""Options of analyses: the same types and ranges in Python, on the command line and in studies."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.analyses import ANALYSES
from beltdyn.cli import main
from beltdyn.designs.study import study
from beltdyn.errors import BeltdynError, ModelError
from beltdyn.model import Drive, ParameterStudy
from beltdyn.parts.options import options_of, read_options, takes_options

EVERY = [(name, option) for name, one in ANALYSES.items() for option in options_of(one.function)]
NUMBERS = ("points", "load_points", "count", "most", "elements", "sobol", "force_tolerance", "repeats", "light_load")
"""Options that are numbers with a range."""
FLAGS = ("compare_steady", "resume", "full")


def taken(name: str, options: dict[str, Any]) -> dict[str, Any]:
    return read_options(ANALYSES[name].function, options)


@pytest.mark.parametrize(("name", "option"), EVERY)
def test_values_of_no_sensible_type_are_refused(name: str, option: str) -> None:
    """Whatever the option: a group of keys, bytes, and a flag for what is none, or a word for a flag."""
    for value in ({"a": 1}, b"1", "x" if option in FLAGS else True, 1 if option in FLAGS else object()):
        with pytest.raises(ModelError, match=f"^{option}"):
            taken(name, {option: value})


@pytest.mark.parametrize(("name", "option"), [pair for pair in EVERY if pair[1] in NUMBERS])
def test_numbers_out_of_range_are_refused(name: str, option: str) -> None:
    for value in (-1, "3 mm", float("nan")):
        with pytest.raises(ModelError, match=f"^{option} = .* must be "):
            taken(name, {option: value})


@pytest.mark.parametrize(("name", "option"), [pair for pair in EVERY if pair[1] == "force_tolerance"])
def test_numbers_are_read_as_in_drive_files(name: str, option: str) -> None:
    assert taken(name, {option: "1 %"}) == {option: 0.01}
    assert taken(name, {option: np.float64(0.02)}) == {option: 0.02}


@pytest.mark.parametrize("name", [name for name, option in EVERY if option == "points"])
def test_whole_numbers_of_numpy_are_whole_numbers(name: str) -> None:
    assert taken(name, {"points": np.int64(4)}) == {"points": 4}


@pytest.mark.parametrize("name", ANALYSES)
def test_defaults_are_what_the_schema_takes(name: str) -> None:
    known = options_of(ANALYSES[name].function)
    given = {option: one.default for option, one in known.items() if one.default is not one.empty}
    assert taken(name, given) == given


def in_python(drive: Drive, file: Path, option: str, value: object) -> str:
    with pytest.raises(BeltdynError) as told:
        ANALYSES["operating_map"].function(drive, speed="60, 120 rpm", **{option: value})
    return str(told.value)


def in_a_study(drive: Drive, file: Path, option: str, value: object) -> str:
    options = {"speed": "60, 120 rpm", option: value}
    number = [{"path": "belt.width", "values": [0.01]}]
    with pytest.raises(ModelError) as told:
        study(ParameterStudy(analysis="operating_map", options=options, number=number), drive, jobs=1)
    return str(told.value).removeprefix("options: ")


@pytest.mark.parametrize(
    ("option", "value", "word", "said"),
    [
        ("points", 1, "1", "points = 1 must be at least 2."),
        ("force_tolerance", "2 mm", "2 mm", "force_tolerance = "),
        ("force_tolerance", "150 %", "150 %", 'force_tolerance = "150 %" must be less than 1.'),
        ("pulley", "nobody", "nobody", "is not in this drive"),
    ],
)
def test_all_ways_to_an_analysis_say_the_same(
    option: str, value: object, word: str, said: str, drive: Drive, drive_file: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ways: list[Callable[[Drive, Path, str, object], str]] = [in_python]
    if option != "pulley":  # which is found at the points
        ways.append(in_a_study)
    for way in ways:
        assert said in way(drive, drive_file, option, value)
    with pytest.raises(SystemExit) as ended:
        main(["operating-map", str(drive_file), "--speed", "60, 120 rpm", f"--{option.replace('_', '-')}", word])
    assert ended.value.code == 2
    assert said in capsys.readouterr().err


def test_a_percentage_is_a_number_on_the_command_line(drive_file: Path, tmp_path: Path) -> None:
    words = ["equilibrium", str(drive_file), "--force-tolerance", "50 %", "-o", str(tmp_path / "rest.nc")]
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code in (None, 0)


@takes_options
def _small_number(drive: Drive, *, factor: float = 1.0) -> float:
    return float(np.exp(np.array([-1e3 * factor]))[0])


def test_below_the_least_number_an_analysis_goes_on_with_zero(drive: Drive) -> None:
    with np.errstate(all="raise"):
        assert _small_number(drive, factor=1.0) == 0.0
        with pytest.raises(FloatingPointError, match="overflow"):
            _small_number(drive, factor=-1.0)
