"""Belts with each law of stretch, and curves that make none."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Belt, Drive, dumps, loads
from beltdyn.model.advice import advise
from beltdyn.model.prepared import install
from beltdyn.model.rating import StretchCurve
from beltdyn.stretch import Green, Linear

STRAINS, TENSIONS = (0.0, 0.01, 0.02, 0.05), (0.0, 70.0, 120.0, 200.0)
make: Any = Belt
CURVE = {"strains": STRAINS, "tensions": TENSIONS}
SECTION: dict[str, Any] = {
    "length": 1.0,
    "width": 0.02,
    "thickness": 0.002,
    "bending_stiffness": 1e-3,
    "mass_per_length": 0.05,
}


def test_default_laws(drive: Drive) -> None:
    """As published for a material, as sold for stiffnesses and profiles, measured for a curve."""
    assert drive.belt.stretch_parameters == Green(drive.belt.axial_stiffness)
    assert make(**SECTION, axial_stiffness=5e3).stretch_parameters == Linear(5e3)
    assert make(length=1.0, profile="PK", ribs=2).stretch_law == "linear"
    assert make(length=1.0, profile="PK", ribs=2, stretch_law="green").stretch_law == "green"
    assert drive.belt.replace(stretch_law="linear").stretch_parameters == Linear(drive.belt.axial_stiffness)


@pytest.mark.parametrize("form", [SECTION, {"length": 1.0, "profile": "PK", "ribs": 2}])
def test_a_curve_has_the_axial_stiffness(form: dict[str, Any]) -> None:
    belt = make(**form, stretch_curve=CURVE)
    assert belt.stretch_law == "measured"
    assert belt.axial_stiffness == belt.stretch_parameters.stiffness == pytest.approx(8e3, rel=0.05)
    assert belt.bending_stiffness == pytest.approx(make(**form, **missing(form)).bending_stiffness)
    np.testing.assert_allclose(belt.stretch_parameters.tension(1.0 + np.array(STRAINS)), TENSIONS, atol=1e-9)
    assert make(**belt.arguments) == belt


def missing(form: dict[str, Any]) -> dict[str, float]:
    return {} if "profile" in form else {"axial_stiffness": 1e4}


def test_a_curve_of_a_material(drive: Drive) -> None:
    """Bending, shear and thickness keep the modulus."""
    belt = make(**{**drive.belt.arguments, "stretch_law": "measured", "stretch_curve": CURVE})
    assert belt.bending_stiffness == drive.belt.bending_stiffness
    assert float(belt.stretch_parameters.tension(1.02)) == pytest.approx(120.0)


def test_a_curve_from_a_file(tmp_path: Path) -> None:
    """The point without strain may be left out."""
    (tmp_path / "curve.csv").write_text("strain,tension\n" + "\n".join(f"{s},{t}" for s, t in CURVE_ROWS[1:]))
    curve = StretchCurve.model_validate({"file": "curve.csv"}, context={"base": tmp_path})
    assert curve.parameters.stretch(TENSIONS) == pytest.approx(1.0 + np.array(STRAINS))


CURVE_ROWS = list(zip(STRAINS, TENSIONS, strict=True))


def test_a_drive_with_a_curve_is_written_and_read(drive: Drive) -> None:
    curved = drive.replace(belt=drive.belt.replace(stretch_law="measured", stretch_curve=CURVE))
    assert loads(dumps(curved)) == curved


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"stretch_law": "measured", "axial_stiffness": 1e4}, "needs a curve. Give"),
        ({"stretch_curve": CURVE, "stretch_law": "green"}, 'is incompatible with stretch_law = "green"'),
        ({"stretch_curve": CURVE, "axial_stiffness": 1e4}, "exclude each other"),
        ({"stretch_curve": {"strains": [0.0, 0.1], "tensions": [0.0, 0.0]}}, "tensions must increase"),
        ({"stretch_curve": {"strains": [0.2, 0.1], "tensions": [1.0, 2.0]}}, "strains must increase"),
        ({"stretch_curve": {"strains": [0.0, 0.1], "tensions": [5.0, 9.0]}}, "must start at the origin"),
        ({"stretch_curve": {"strains": [0.0], "tensions": [0.0]}}, "no point above zero strain"),
        ({"stretch_curve": {"strains": [0.1], "tensions": [5.0], "unit": 1}}, "belt.stretch_curve.unit"),
    ],
)
def test_wrong_curves(keys: dict[str, Any], message: str) -> None:
    with pytest.raises(ModelError, match=message):
        make(**SECTION, **keys)


@pytest.mark.parametrize(("stretch", "said"), [(1.04, 0), (1.06, 1)])
def test_a_belt_beyond_its_curve(drive: Drive, stretch: float, said: int) -> None:
    belt = drive.belt.replace(length=drive.path.length / stretch, stretch_law="measured", stretch_curve=CURVE)
    stretched = drive.replace(belt=belt)
    found = [one for one in advise(stretched, install(stretched)) if "stretch_curve ends at 5.00%" in one]
    assert len(found) == said


def test_a_new_law_takes_the_place_of_the_old_one(drive: Drive) -> None:
    """Whatever else is changed: a curve of a linear law, a law of a curve, a profile of both."""
    linear = make(**SECTION, axial_stiffness=1e4)
    curved = linear.replace(stretch_curve=CURVE)
    assert curved.stretch_law == "measured"
    assert curved.replace(bending_stiffness=2e-3).stretch_curve == curved.stretch_curve
    assert curved.replace(stretch_law="green").stretch_parameters == Green(linear.axial_stiffness)
    assert curved.replace(axial_stiffness=5e3).stretch_parameters == Linear(5e3)
    assert drive.belt.replace(profile="PK", ribs=2).stretch_law == "linear"
    assert drive.belt.replace(axial_stiffness=5e3).stretch_law == "green"


@pytest.mark.parametrize(("first", "second"), [(0.2e5, 80e5), (5e5, -80e5)])
def test_a_curve_begins_and_ends_with_its_own_slope(first: float, second: float) -> None:
    """T = a e + b e^2 has the slopes a and a + 2 b e, of which one is a fifth of the line to the next point."""
    strain = np.array([0.01, 0.02, 0.03])
    curve = StretchCurve(strains=tuple(strain), tensions=tuple(first * strain + second * strain**2))
    assert curve.parameters.stiffness == pytest.approx(first, rel=1e-12)
    slope = curve.parameters.tangent_stiffness(np.array([1.03]))
    assert float(slope[0]) == pytest.approx(first + 2.0 * second * 0.03, rel=1e-9)


def test_a_curve_that_begins_flat_has_some_stiffness() -> None:
    """The slope of e^3 at zero is none: a twentieth of the line to the next point is left."""
    strain = np.array([0.01, 0.02, 0.03])
    curve = StretchCurve(strains=tuple(strain), tensions=tuple(1e9 * strain**3))
    assert curve.parameters.stiffness == pytest.approx(0.05 * 1e9 * 1e-4)
