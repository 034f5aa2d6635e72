"""Modes on a page against the result that they come from."""

import base64

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.show.report.replay import swinging


@pytest.fixture(scope="module")
def found(drive: bd.Drive) -> bd.Result:
    return bd.modes(drive, about="rest", count=3)


def test_ways_are_those_of_the_modes(found: bd.Result) -> None:
    """To a step of 16 bits over twice the largest way; rims move by angle and radius."""
    shown, data = swinging(found), found.dataset
    size, normal = shown["size"], data["point_normal"].values
    for number, one in enumerate(shown["modes"]):
        across = data["belt_shape"].values[number]
        packed = np.frombuffer(base64.b64decode(one["belt"]), np.uint16).reshape(len(normal), 2, 2)
        ways = size * (2.0 * packed / 65535 - 1.0)
        expected = size * normal[:, :, None] * across.T[:, None, :]
        np.testing.assert_allclose(ways, expected, atol=1.01 * size / 65535)
        rims = np.array(one["angle"]) * np.abs(found.drive.path.radii)[:, None]
        np.testing.assert_allclose(rims, size * data["rim_shape"].values[number].T, atol=1e-6)


def test_they_are_named_by_frequency_and_by_what_moves(found: bd.Result) -> None:
    names = [one["name"] for one in swinging(found)["modes"]]
    frequencies = found.dataset["frequency"].values
    assert [name.split()[1] for name in names] == [f"{one:.4g}" for one in frequencies]
    assert names[1].endswith(str(found.dataset["moving_parts"].values[1]))


def test_arms_hold_their_pulleys() -> None:
    """The center of a tensioned pulley moves across its arm."""
    from importlib.resources import files

    drive = bd.loads(files("beltdyn").joinpath("examples", "alternator_drive.toml").read_text(encoding="utf-8"))
    shown = swinging(bd.modes(drive, about="rest", count=6))
    ((x, y, pulley),) = shown["arms"]
    assert (x, y) == (0.1, 0.1)
    arm = np.array(shown["center"][pulley]) - [x, y]
    for one in shown["modes"]:
        ways = np.array(one["center"])
        np.testing.assert_allclose(arm @ ways[pulley], 0.0, atol=1e-6 * float(np.linalg.norm(arm)))
        assert np.abs(np.delete(ways, pulley, axis=0)).max() == 0.0
