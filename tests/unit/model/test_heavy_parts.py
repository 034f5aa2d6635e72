"""Strands that are heavier than their tension, and tensioners that are heavier than their springs hold."""

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ConvergenceError
from beltdyn.model import advise, install, prepare
from beltdyn.model.heavy_parts import heavy_tensioner, least_strand_tensions, naming_heavy_parts, slack_strands

G = 9.81


def conveyor(tension: float, height: float = 0.0, **more: object) -> bd.Drive:
    return bd.Drive(
        gravity=[0.0, -G],
        belt={
            "installed_tension": tension,
            "width": 0.4,
            "thickness": 0.005,
            "axial_stiffness": 1e6,
            "bending_stiffness": 0.1,
            "mass_per_length": 5.0,
            "friction": 0.3,
        },
        pulley=[
            {"name": "head", "center": [0.0, height], "radius": 0.2, "speed": 5.0},
            {"name": "tail", "center": [0.0 if height else 10.0, 0.0], "radius": 0.2, "inertia": 1.0},
        ],
        simulation={"duration": 1.0},
        **more,
    )


def test_a_level_strand_needs_its_weight() -> None:
    drive = conveyor(2000.0)
    needed = least_strand_tensions(prepare(drive), drive.path)
    np.testing.assert_allclose(needed, 5.0 * G * 10.0, rtol=1e-12)


def test_a_vertical_strand_needs_half_of_it() -> None:
    """Its middle carries half of the strand below."""
    drive = conveyor(2000.0, height=30.0)
    np.testing.assert_allclose(least_strand_tensions(prepare(drive), drive.path), 0.5 * 5.0 * G * 30.0, rtol=1e-12)


def test_idlers_and_goods_count() -> None:
    carried = {"kind": "idlers", "span": ["tail", "head"], "spacing": 1.2}
    drive = conveyor(2000.0, support=[carried], goods=[{"span": ["tail", "head"], "mass_per_length": 20.0}])
    needed = dict(zip(drive.spans, least_strand_tensions(prepare(drive), drive.path), strict=True))
    assert needed["tail", "head"] == pytest.approx(25.0 * G * 1.2)
    assert needed["head", "tail"] == pytest.approx(5.0 * G * 10.0)


def test_goods_count_where_they_lie() -> None:
    """On the idlers they do not load the belt that hangs before and behind these."""
    on_idlers = {"span": ["tail", "head"], "start": 2.0, "end": 9.0}
    carried = {"kind": "idlers", "spacing": 0.5} | on_idlers
    drive = conveyor(2000.0, support=[carried], goods=[on_idlers | {"mass_per_length": 20.0}])
    needed = dict(zip(drive.spans, least_strand_tensions(prepare(drive), drive.path), strict=True))
    assert needed["tail", "head"] == pytest.approx(25.0 * G * 0.5)
    longer = conveyor(2000.0, support=[carried], goods=[{"span": ["tail", "head"], "mass_per_length": 20.0}])
    assert least_strand_tensions(prepare(longer), drive.path).max() == pytest.approx(25.0 * G * 2.0)


def test_slack_strands_are_named_with_what_they_need() -> None:
    drive = conveyor(400.0)
    told = [text for text in advise(drive, install(drive)) if "heavier than their tension" in text]
    assert len(told) == 1
    assert "head to tail with 400 N, which needs 490.5 N" in told[0]
    assert "Increase their tension to 491 N or more" in told[0]
    taut = conveyor(600.0)
    assert slack_strands(prepare(taut), taut.path, np.array([600.0, 600.0])) is None
    assert slack_strands(prepare(taut), taut.path, np.array([600.0, np.nan])) is None


@pytest.mark.parametrize("tension", [400.0, 600.0])
def test_failures_name_them(tension: float) -> None:
    with (
        pytest.raises(ConvergenceError, match=r"^no equilibrium\.") as failure,
        naming_heavy_parts(prepare(conveyor(tension))),
    ):
        raise ConvergenceError("no equilibrium.")
    assert ("which needs 490.5 N" in str(failure.value)) == (tension < 490.0)


@pytest.mark.parametrize(("mass", "falls"), [(2.0, False), (4.0, True)])
def test_a_tensioner_that_its_weight_pulls_from_the_belt_is_named_with_its_preload(mass: float, falls: bool) -> None:
    """An idler on the lower strand pushes up with 27 N and the weight of a slide and a pulley of 0.5 kg hangs on it."""
    pulleys = [
        {"name": "driver", "center": [0.0, 0.0], "radius": 0.05, "speed": 10.0},
        {"name": "driven", "center": [0.5, 0.0], "radius": 0.05, "inertia": 1e-3},
        {"name": "idler", "center": [0.25, -0.06], "radius": 0.03, "side": "outside", "inertia": 1e-4, "mass": 0.5},
    ]
    slide = {"kind": "sliding", "pulley": "idler", "direction": [0.0, 1.0], "preload": 27.0, "rate": 0.0, "mass": mass}
    belt = {
        "installed_tension": 100.0,
        "width": 0.02,
        "thickness": 0.002,
        "axial_stiffness": 1e5,
        "bending_stiffness": 0.01,
        "mass_per_length": 0.05,
        "friction": 0.5,
    }
    drive = bd.Drive(gravity=[0.0, -G], belt=belt, pulley=pulleys, tensioner=[slide], simulation={"duration": 1.0})
    found = heavy_tensioner(prepare(drive))
    assert (found is not None) == falls
    if found is not None:
        assert f"with {4.5 * G:.2f} N" in found.fault
        assert "its spring pushes with 27 N" in found.fault
        assert "preload = 71.2 N" in found.remedy
