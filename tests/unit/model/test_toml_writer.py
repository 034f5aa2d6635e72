"""A drive that is written is the same when it is read again."""

import tomllib
from importlib.resources import files

import pytest

from beltdyn.model import Drive, dumps, loads

EXAMPLES = sorted(path.name for path in files("beltdyn").joinpath("examples").iterdir() if path.name.endswith(".toml"))


@pytest.mark.parametrize("name", EXAMPLES)
def test_every_example_comes_back(name: str) -> None:
    text = files("beltdyn").joinpath("examples", name).read_text(encoding="utf-8")
    drive = loads(text)
    written = dumps(drive)
    assert loads(written) == drive
    assert dumps(loads(written)) == written


def test_numbers_are_in_si_units_and_defaults_are_spelled_out(drive: Drive) -> None:
    data = tomllib.loads(dumps(drive))
    assert data["belt"]["width"] == drive.belt.width
    assert data["simulation"]["integrator"] == "generalized_alpha"
    assert [pulley["radius"] for pulley in data["pulley"]] == [pulley.radius for pulley in drive.pulleys]
