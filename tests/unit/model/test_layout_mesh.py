"""Drives whose belt cannot mesh."""

from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import advise, install
from beltdyn.model.layout import mesh_misfit
from tests.unit.model.test_toothing import BELT, drive


def test_a_belt_too_short_to_mesh() -> None:
    """Stretched by a quarter, its teeth at the ends of arcs are off by more than 0.4 pitches."""
    with pytest.raises(
        ModelError, match=r"belt.teeth = 80 is too short to mesh: .* has 100.16 pitches of 8 mm, .*. Give 100"
    ):
        drive({"teeth": 80})


def test_a_belt_that_stretches_by_some_teeth_meshes_and_is_told() -> None:
    made = drive({"teeth": 97})
    (told,) = [text for text in advise(made, install(made)) if "the path has 100.16 pitches" in text]
    assert "but the belt 97 teeth: it is stretched by 3.26%" in told
    assert "Give 100 teeth" in told


@pytest.mark.parametrize("tension", [20.0, 40.0, 80.0])
def test_elastic_stretch_is_no_lack_of_teeth(tension: float) -> None:
    """A long belt stretches by more than a tooth at ordinary tensions: 330 teeth of 2 mm by 0.6 teeth at 20 N."""
    axis = bd.example("printer_axis")
    made = axis.replace(belt=axis.belt.replace(installed_tension=tension))
    assert install(made).tension == pytest.approx(tension, rel=1e-3)


def test_the_misfit_of_teeth_on_long_and_short_arcs() -> None:
    """Rigid teeth hold the belt within lambda of the ends, soft ones let it stretch over half of the arc."""
    made = drive({"teeth": 99})
    toothed, strain = np.array([True, True]), made.path.length / 0.792 - 1.0
    toothing = made.belt.toothing
    assert toothing is not None

    def misfit(stiffness: float) -> float:
        belt = made.belt.replace(toothing=toothing.replace(tooth_stiffness=stiffness))
        return mesh_misfit(belt, made.path, toothed)

    decay = (8e-3 * made.belt.axial_stiffness / 1e9) ** 0.5
    assert misfit(1e9) == pytest.approx(strain * decay, rel=1e-6)
    arc = float((np.abs(made.path.radii) * made.path.wrap_angles).max())
    assert misfit(1.0) == pytest.approx(0.5 * strain * arc, rel=1e-3)


def test_a_belt_whose_teeth_nothing_holds() -> None:
    smooth = [{"name": n, "center": [x, 0.0], "radius": 0.04, "speed": 1.0} for n, x in (("a", 0.0), ("b", 0.28))]
    with pytest.raises(ModelError, match="the belt has 100 teeth, but no pulley has any"):
        bd.Drive(belt=BELT, pulley=smooth, contact={"friction": 0.3}, simulation={"duration": 1.0})


RAMP = {"kind": "cosine_ramp", "start": 0.0, "end": 0.5, "value": 100.0}


def both(speed: Any, driven: Any, **more: Any) -> bd.Drive:
    """Pulleys of 24 and 36 teeth, both turned by speeds."""
    given = [
        {"name": "driver", "center": [0.0, 0.0], "teeth": 24, "speed": speed},
        {"name": "driven", "center": [0.28, 0.0], "teeth": 36, "speed": driven} | more,
    ]
    return bd.Drive(belt=BELT, pulley=given, simulation={"duration": 1.0})


@pytest.mark.parametrize("driven", [200.0 / 3.0, 66.665, RAMP | {"value": 200.0 / 3.0, "end": 0.5001}])
def test_speeds_that_teeth_allow(driven: Any) -> None:
    """In the ratio of the teeth, rounded, or later by less than half a pitch."""
    assert both(RAMP if isinstance(driven, dict) else 100.0, driven).pulleys[1].prescribed


@pytest.mark.parametrize("driven", [-200.0 / 3.0, 66.6, 0.0, RAMP | {"value": 200.0 / 3.0, "end": 0.51}])
def test_speeds_that_tear_teeth_out(driven: Any) -> None:
    with pytest.raises(ModelError, match=r'pulley\[driven\] turns at .* 36 teeth at .* as "driver" has 24'):
        both(RAMP if isinstance(driven, dict) else 100.0, driven)


def test_a_coupling_lets_speeds_differ() -> None:
    coupled = {"inertia": 1e-3, "hub": [{"kind": "isolator", "stiffness": 10.0, "damping": 0.1}]}
    assert both(100.0, 60.0, **coupled).pulleys[1].hub


def test_the_back_turns_the_other_way() -> None:
    """A smooth pulley at the back is not held by teeth, whatever its speed."""
    made = bd.example("timing_drive")
    turned = [one.merged({"speed": -50.0}) if one.name == "tensioner" else one for one in made.pulleys]
    assert made.replace(pulley=turned).pulleys[1].prescribed
