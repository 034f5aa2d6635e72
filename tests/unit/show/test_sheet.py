"""Tables and facts of results that are no runs; those of runs are seen on the screen."""

import math

import numpy as np
import xarray as xr

from beltdyn.model import Drive
from beltdyn.results import Result
from beltdyn.show.sheet import Facts, Table, sheet


def test_numbers_are_facts_and_names_make_tables(drive: Drive) -> None:
    dataset = xr.Dataset(
        {
            "tension": ((), 45.0, {"units": "N", "long_name": "Mean tension"}),
            "wrap": ("pulley", [math.pi, 0.5 * math.pi], {"units": "rad", "long_name": "Wrap angle, at rest"}),
            "unnamed": ("other", np.zeros(3), {"units": "N", "long_name": "Of nothing with a name"}),
        },
        {"pulley": ("pulley", ["a", "b"], {"long_name": "Pulley"})},
        {"kind": "equilibrium", "title": "Belt drive at rest"},
    )
    found = sheet(Result(dataset, drive))
    assert found.title == "Belt drive at rest"
    assert found.parts == (
        Facts((("Mean tension", "45.000 N"),)),
        Table("", ("Pulley", "Wrap angle\n°"), (("a", "180.00"), ("b", "90.00"))),
    )
