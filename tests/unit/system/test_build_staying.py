"""Arrays of a drive on a mesh that stays, and on another one."""

from importlib.resources import files

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.model import Drive, prepare
from beltdyn.system.build_staying import on_other_mesh, staying_system


def flat(value: object) -> list[np.ndarray]:
    """All numbers of a tree of tuples."""
    return [one for each in value for one in flat(each)] if isinstance(value, tuple) else [np.asarray(value)]


@pytest.mark.parametrize("name", ["accessory_drive", "conveyor", "washing_machine"])
def test_other_mesh_is_as_one_made_anew(name: str) -> None:
    """With tensioners, hub chains, hysteresis and weight; machines are taken over."""
    drive: Drive = bd.load(str(files("beltdyn") / "examples" / f"{name}.toml"))
    coarse, fine = (np.full(count, drive.belt_length / count) for count in (9, 14))
    fine[:7], fine[7:] = 0.8 * fine[:7], 1.2 * fine[7:]
    system = staying_system(prepare(drive), coarse)
    other, anew = on_other_mesh(prepare(drive), system, fine), staying_system(prepare(drive), fine)
    assert type(other.frame) is type(anew.frame)
    assert other.tensioners is system.tensioners
    for one, expected in zip(flat(other), flat(anew), strict=True):
        np.testing.assert_array_equal(one, expected)
