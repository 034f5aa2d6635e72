from math import pi, sin
from pathlib import Path
from typing import Any

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Belt, Drive, dumps, install, json_schema, load, loads, read_catalogue

FORM = {"length": 1.0, "width": 0.02, "thickness": "5 mm"}
STIFF = {"axial_stiffness": "120 kN", "bending_stiffness": 0.05, "mass_per_length": 0.1}


def make(**keys: Any) -> Belt:
    return Belt.model_validate(keys)


def test_stiffnesses_are_met() -> None:
    belt = make(**FORM, **STIFF)
    assert belt.axial_stiffness == pytest.approx(120e3, rel=1e-14)
    assert belt.bending_stiffness == pytest.approx(0.05, rel=1e-14)
    assert belt.mass_per_length == pytest.approx(0.1, rel=1e-14)
    assert belt.poissons_ratio == 0.3
    assert belt.axial_factor == 1.0
    assert make(**FORM, **STIFF, poissons_ratio=0.45).poissons_ratio == 0.45


def test_the_belt_of_ribs() -> None:
    """Six ribs have six times everything but the thickness, the offsets and the angle."""
    one, belt = read_catalogue()["PK"], make(length=1.0, profile="PK", ribs=6)
    for key in ("width", "axial_stiffness", "bending_stiffness", "mass_per_length"):
        assert getattr(belt, key) == pytest.approx(6 * getattr(one, key), rel=1e-14)
    for key in ("thickness", "pitch_offset", "back_offset", "wedge_angle"):
        assert getattr(belt, key) == getattr(one, key)


def test_friction_and_contact_stiffness_of_a_profile(tmp_path: Path) -> None:
    """Contact is as stiff as all ribs together; the coefficient of friction is that of one."""
    own = tmp_path / "own.toml"
    keys = "width = 4e-3\nthickness = 5e-3\naxial_stiffness = 2e4\nbending_stiffness = 1e-3\nmass_per_length = 0.02"
    own.write_text(f'[our]\ntitle = "ours"\n{keys}\nsource = "rig"\nfriction = 0.32\ncontact_stiffness = "15 MN/m^2"\n')
    belt = make(length=1.0, profile="our", ribs=6, catalogue=str(own))
    assert belt.friction == 0.32
    assert belt.contact_stiffness == pytest.approx(6 * 15e6, rel=1e-14)
    assert make(length=1.0, profile="our", ribs=6, catalogue=str(own), friction=0.5).friction == 0.5


def test_the_flat_belt_is_sold_by_width() -> None:
    one, belt = read_catalogue()["flat-aramid"], make(length=1.0, profile="flat-aramid", width="25 mm")
    assert belt.width == 0.025
    assert belt.axial_stiffness == pytest.approx(0.025 / one.width * one.axial_stiffness, rel=1e-14)
    assert belt.wedge_angle is None


def test_the_round_belt_is_sold_by_diameter() -> None:
    """Twice as thick: four times the section, sixteen times its second moment, and the same stiffness of contact."""
    one, belt = read_catalogue()["round-85A"], make(length=1.0, profile="round-85A", diameter="12 mm")
    assert belt.width == belt.thickness == pytest.approx(2 * one.width)
    assert belt.pitch_offset == belt.back_offset == pytest.approx(belt.thickness / 2)
    assert belt.axial_stiffness == pytest.approx(4 * one.axial_stiffness)
    assert belt.mass_per_length == pytest.approx(4 * one.mass_per_length)
    assert belt.bending_stiffness == pytest.approx(16 * one.bending_stiffness)
    assert belt.contact_stiffness == one.contact_stiffness
    assert belt.bending_stiffness == pytest.approx(belt.axial_stiffness * belt.thickness**2 / 16, rel=5e-3)


@pytest.mark.parametrize("size", [{"profile": "PJ", "ribs": 5}, {"profile": "SPB", "ribs": 2}, {**STIFF, **FORM}])
def test_nominal_length(size: dict[str, Any]) -> None:
    """It is measured around the pulleys' own diameters, and the tension line lies outside by its offset all around."""
    sizes = {key: value for key, value in size.items() if key != "length"} | {"measuring_force": 0.0}
    belt = make(nominal_length="1194 mm", **sizes)
    assert belt.length == pytest.approx(1.194 + 2 * pi * belt.pitch_offset, rel=1e-14)
    assert belt.replace(nominal_length=1.2).length == pytest.approx(1.2 + 2 * pi * belt.pitch_offset, rel=1e-14)
    assert make(nominal_length=1.0, pitch_offset="2 mm", **sizes).length == pytest.approx(1.0 + 0.004 * pi, rel=1e-14)


CURVE = {"strains": [0.01, 0.02, 0.04], "tensions": [900.0, 1500.0, 2400.0]}


@pytest.mark.parametrize(
    ("given", "force"),
    [
        ({"profile": "PJ-elastic", "ribs": 5}, 250.0),
        ({"profile": "PK", "ribs": 6}, 600.0),
        ({"profile": "PK", "ribs": 6, "measuring_force": "500 N"}, 500.0),
        ({"profile": "SPB", "ribs": 2}, 1800.0),
        ({"profile": "PK", "ribs": 6, "stretch_law": "green"}, 600.0),
        ({"profile": "PK", "ribs": 6, "stretch_curve": CURVE}, 600.0),
        ({**STIFF, "width": 0.02, "thickness": 0.005, "measuring_force": 400.0}, 400.0),
    ],
)
def test_a_belt_on_two_pulleys_its_nominal_length_around_has_half_its_measuring_force(
    given: dict[str, Any], force: float
) -> None:
    """As it is measured: pulleys of diameter D at the distance C take 2 C + pi D, and each strand carries half."""
    pulley = {"diameter": "150 mm", "inertia": 1.0}
    drive = Drive(
        belt={**given, "nominal_length": 0.8 + 0.15 * pi},
        pulley=[{"name": "a", "center": (0, 0), **pulley}, {"name": "b", "center": (0.4, 0), **pulley}],
        contact={"stiffness": 1e9, "friction": 0.3},
        simulation={"duration": 1.0, "output_interval": 0.01},
    )
    assert drive.belt.measuring_force == force
    assert install(drive).laid_tension == pytest.approx(force / 2, rel=1e-9)
    assert loads(dumps(drive)) == drive
    assert drive.belt.value_of("nominal_length") == pytest.approx(0.8 + 0.15 * pi, rel=1e-14)


def test_a_nominal_length_stays_what_it_is_where_the_belt_changes() -> None:
    """L = (Ln + 2 pi offset) / (1 + F / 2 EA): twice as stiff, the belt is longer without force."""
    belt = make(profile="PK", ribs=6, nominal_length=1.2)
    around = 1.2 + 2 * pi * belt.pitch_offset
    assert belt.length == pytest.approx(around / (1 + 300.0 / 120e3), rel=1e-14)
    assert belt.replace(axial_stiffness="240 kN").length == pytest.approx(around / (1 + 300.0 / 240e3), rel=1e-14)
    assert belt.replace(measuring_force=0.0).length == pytest.approx(around, rel=1e-14)
    assert belt.replace(elements=40).length == belt.length
    assert belt.replace(length=1.1).nominal_length is None
    assert belt.replace(length=1.1).replace(axial_stiffness="240 kN").length == 1.1
    assert belt.replace(installed_tension=300.0).length is None


def test_a_belt_of_nominal_length_fits_its_pulleys() -> None:
    """Two equal pulleys of effective diameter D at the distance C take the effective length 2 C + pi D."""
    pulley = {"diameter": "60 mm", "inertia": 1.0}
    drive = Drive(
        belt={"profile": "PJ", "ribs": 4, "measuring_force": 0, "nominal_length": 0.6 + 0.06 * pi - 0.0015},
        pulley=[{"name": "a", "center": (0, 0), **pulley}, {"name": "b", "center": (0.3, 0), **pulley}],
        contact={"stiffness": 1e8},
        simulation={"duration": 1.0, "output_interval": 0.01},
    )
    assert drive.path.length - drive.belt_length == pytest.approx(0.0015, rel=1e-9)


def test_what_the_user_gives_goes_before_the_catalogue() -> None:
    belt = make(length=1.0, profile="PK", ribs=6, axial_stiffness=1e5, pitch_offset=0.0, wedge_angle="36 deg")
    assert belt.axial_stiffness == pytest.approx(1e5)
    assert belt.bending_stiffness == pytest.approx(6 * read_catalogue()["PK"].bending_stiffness)
    assert belt.pitch_offset == 0.0
    assert belt.wedge_angle == pytest.approx(pi / 5)


def test_a_loss_of_the_user_takes_the_place_of_the_catalogues(tmp_path: Path) -> None:
    """Of the same strain, whether that is a damping time or a loss factor; the other strain keeps the catalogue's."""
    entry = read_catalogue()["PK"].replace(stretch_loss_factor=0.05, bending_loss_factor=0.15)
    keys = "\n".join(f"{key} = {value!r}" for key, value in entry.arguments.items() if type(value) in (float, str))
    (tmp_path / "mine.toml").write_text(f"[mine]\n{keys}")
    sold = {"length": 1.0, "profile": "mine", "ribs": 6, "catalogue": str(tmp_path / "mine.toml")}
    assert make(**sold).stretch_loss_factor == 0.05
    belt = make(**sold, bending_damping_time=1e-4)
    assert (belt.stretch_loss_factor, belt.bending_loss_factor, belt.bending_damping_time) == (0.05, 0.0, 1e-4)
    assert make(**sold, bending_loss_factor=0.1).bending_loss_factor == 0.1


def test_a_belt_has_one_form_once_made() -> None:
    """It can be replaced, compared and written like any other."""
    belt = make(length=1.0, profile="PK", ribs=6)
    assert belt == Belt(**belt.arguments)
    assert belt.replace(length=2.0).replace(length=1.0) == belt


@pytest.fixture
def sold(drive_text: str) -> str:
    """The paper's drive with a belt as sold."""
    start, end = drive_text.index("width"), drive_text.index("[[pulley]]")
    return f'{drive_text[:start]}profile = "PK"\nribs = 6\n\n{drive_text[end:]}'


def test_a_belt_by_values_remembers_what_was_sold() -> None:
    """With what the user gave in place of the profile, for changes of its size."""
    belt = make(length=1.0, profile="PK", ribs=6, friction=0.4)
    written = belt.model_dump(mode="json", exclude_none=True)
    assert written["sold"] == {"profile": "PK", "ribs": 6, "given": ["friction"]}
    again = Belt(**written)
    assert again == belt
    assert again.entry == read_catalogue()["PK"]
    assert (again.replace(ribs=3).axial_stiffness, again.replace(ribs=3).friction) == (0.5 * belt.axial_stiffness, 0.4)
    both: dict[str, Any] = {"length": 1.0, "profile": "PK", "ribs": 6, "sold": {"profile": "PK"}}
    with pytest.raises(ModelError, match="profile and sold exclude each other"):
        Belt(**both)
    with pytest.raises(ModelError, match=r'"length", which is no key of a section'):
        Belt(**(written | {"sold": {"profile": "PK", "ribs": 6, "given": ["length"]}}))


def test_the_text_of_a_drive_stays(sold: str) -> None:
    drive = loads(sold)
    assert drive.text == sold
    assert loads(drive.text) == drive


def test_the_text_does_without_ones_own_catalogue(sold: str, tmp_path: Path) -> None:
    """A relative path starts at the drive file; the drive is complete without the catalogue from then on."""
    entry = read_catalogue()["PK"]
    lines = [f'{key} = "{value}"' for key, value in (("title", "ours"), ("source", "our rig"))]
    lines += [
        f"{key} = {getattr(entry, key)}" for key in ("width", "thickness", "bending_stiffness", "mass_per_length")
    ]
    (tmp_path / "mine.toml").write_text("\n".join(["[PK]", "axial_stiffness = 21e3", *lines]))
    (tmp_path / "drive.toml").write_text(sold.replace("ribs = 6", 'ribs = 6\ncatalogue = "mine.toml"'))
    drive = load(tmp_path / "drive.toml")
    assert drive.belt.axial_stiffness == pytest.approx(6 * 21e3)
    (tmp_path / "mine.toml").unlink()
    assert loads(drive.text) == drive


def test_schema_knows_the_forms() -> None:
    belt = json_schema()["$defs"]["Belt"]
    known = {"profile", "ribs", "diameter", "catalogue", "nominal_length", "axial_stiffness", "youngs_modulus"}
    assert known <= set(belt["properties"])
    assert "youngs_modulus" not in belt["required"]
    material, stiffnesses, profile = (form["required"] for form in belt["anyOf"])
    assert set(material) == {"width", "thickness", "density", "youngs_modulus", "poissons_ratio"}
    assert set(stiffnesses) == {"width", "thickness", *STIFF}
    assert profile == ["profile"]


@pytest.mark.parametrize(("angle", "factor"), [(None, 1.0), (pi, 1.0), ("40 deg", 1 / sin(pi / 9))])
def test_wedge(drive: Drive, angle: Any, factor: float) -> None:
    """Grooves multiply friction on the inside, the pulley's own or the contact's, not on the back."""
    driver, driven = drive.pulleys
    wedged = drive.replace(
        belt=drive.belt.replace(wedge_angle=angle),
        pulley=[driver.replace(friction=0.3), driven],
    )
    assert wedged.belt.wedge_factor == pytest.approx(factor)
    assert wedged.frictions == pytest.approx([0.3 * factor, drive.frictions[1] * factor])
