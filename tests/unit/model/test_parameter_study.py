"""Study files, and what is said of wrong ones."""

from pathlib import Path

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import OptimizationStudy
from beltdyn.model.toml import read_study

STUDY = """
[[number]]
path = "belt.width"
least = "8 mm"
largest = 0.02

[goal]
result = "hub_load"

[points]
speed = "700..6000 rpm"

[[order]]
order = 2
least_speed = "700 rpm"
largest_speed = "900 rpm"

[[obstacle]]
name = "bolt"
center = ["10 mm", 0.0]
radius = "4 mm"
clearance = "3 mm"
"""


def read(tmp_path: Path, text: str) -> OptimizationStudy:
    file = tmp_path / "opt.toml"
    file.write_text(text, encoding="utf-8")
    return read_study(file, OptimizationStudy)


def test_a_study_file(tmp_path: Path) -> None:
    study = read(tmp_path, STUDY)
    assert study.numbers[0].least == "8 mm"
    assert study.goal.over == "worst"
    assert study.orders[0].distance == 0.15
    assert study.obstacles[0].center == (0.01, 0.0)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("[goal]", "[gaol]", 'opt.toml: gaol is not a known key. Did you mean "goal"?'),
        ('result = "hub_load"', 'sense = "minimize"', "opt.toml: goal.result is missing"),
        ('result = "hub_load"', 'result = "hub_load"\nsense = "least"', 'goal.sense = "least" is not a valid choice'),
        ("[points]", "[points]\ntable = 'a.csv'", "points: table excludes speed and load"),
        ('speed = "700..6000 rpm"', 'pulley = "a"', "points: pulley is given without speed"),
        ('speed = "700..6000 rpm"', "count = 1", "points.count = 1 must be at least 2"),
        ('"900 rpm"', '"600 rpm"', "least_speed = 73.304 rad/s is above largest_speed"),
        ('clearance = "3 mm"', 'clearance = "3 kg"', 'obstacle[bolt].clearance = "3 kg" must be in units of m'),
        ("[[order]]", "[[requirement]]\nresult = 'hub_load'\n[[order]]", "has no limit. Give at_least, at_most"),
        (
            "[goal]",
            "[[number]]\npath = 'belt.width'\nleast = 1\nlargest = 2\n[goal]",
            'number "belt.width" is given twice',
        ),
        ("[goal]", "[goal", "the study file is not valid TOML"),
    ],
)
def test_wrong_study_files(tmp_path: Path, old: str, new: str, said: str) -> None:
    with pytest.raises(ModelError) as error:
        read(tmp_path, STUDY.replace(old, new, 1))
    assert said in str(error.value)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=r"none\.toml cannot be read"):
        read_study(tmp_path / "none.toml", OptimizationStudy)
