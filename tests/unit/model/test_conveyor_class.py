"""Conveyor belts by class, against data sheets and tables of makers."""

import pytest

import beltdyn as bd
from beltdyn.model.catalogue import find_entry, read_catalogue
from beltdyn.model.conveyor_class import CLASSES, class_values

STEEL = {
    500: (3.7, 13.9),
    800: (3.7, 13.9),
    1000: (3.9, 14.1),
    1250: (4.7, 14.9),
    1600: (5.4, 17.6),
    2000: (5.4, 17.6),
    2500: (6.8, 20.6),
    3150: (8.1, 22.1),
    4000: (8.9, 24.9),
    5000: (10.9, 30.9),
}
"""Class -> diameter of cords and thickness of the belt, mm (NRC Steelco)."""


@pytest.mark.parametrize("name", CLASSES)
def test_listed_classes_are_entries_with_sources(name: str) -> None:
    entry = read_catalogue()[name]
    assert entry.generic
    for value in ("stiffness", "bending", "mass", "friction: ", "contact: ", "losses: ", "smallest pulley", "strength"):
        assert value in entry.source.lower()
    assert entry.strength == 1e3 * float(name.split()[1].split("/")[0])
    density = entry.mass_per_length / (entry.width * entry.thickness)
    assert 1150.0 < density < 1800.0  # rubber with polyester or steel
    assert entry.bending_stiffness < 0.3 * entry.axial_stiffness * entry.thickness**2 / 12.0
    assert entry.pitch_offset + entry.back_offset == pytest.approx(entry.thickness)
    assert entry.smallest_diameter is not None
    assert entry.smallest_diameter > 20.0 * entry.thickness
    assert entry.least_safety is not None
    assert entry.least_motion_safety is not None
    assert entry.least_motion_safety < entry.least_safety
    ranges = {"EP": (0.005, 0.015), "NN": (0.010, 0.025), "ST": (0.001, 0.0025)}
    least, largest = ranges[name[:2]]
    assert least < (entry.permanent_elongation or 0.0) < largest
    assert (entry.thermal_expansion is None) == (name[:2] != "ST")


def test_a_textile_belt_has_the_thickness_and_mass_of_a_data_sheet() -> None:
    """EP 630/4 with covers of 5 and 2 mm: 11.4 mm and 14.73 kg/m at a width of 1 m (Phoebus Belting)."""
    entry = find_entry(read_catalogue(), "EP 630/4 5+2")
    assert entry.thickness == pytest.approx(0.0114, abs=2e-4)
    assert entry.mass_per_length == pytest.approx(14.73, rel=0.02)


@pytest.mark.parametrize("strength", STEEL)
def test_steel_cord_belts_have_the_sections_of_a_maker(strength: int) -> None:
    cord, thick = STEEL[strength]
    entry = find_entry(read_catalogue(), f"ST {strength}")
    assert f"cords of {cord:g} mm" in entry.title
    assert entry.thickness == pytest.approx(1e-3 * thick, abs=3e-4)
    assert entry.axial_stiffness == 72e3 * strength


@pytest.mark.parametrize("name", ["EP400/3", "ep 400/3", "EP-400/3", "EP 400/3 4+2", "EP 400/3 4/2"])
def test_spellings_of_a_class(name: str) -> None:
    assert find_entry(read_catalogue(), name) == read_catalogue()["EP 400/3"]


def test_names_that_are_no_class() -> None:
    for name, said in (
        ("EP 400", "has no number of plies"),
        ("ST 900", "Choose one of ST 630, ST 800, ST 1000"),
        ("ST 1000/2", "which have no plies"),
        ("EP 2000/1", "2000 N/mm a ply"),
    ):
        with pytest.raises(LookupError, match=said):
            find_entry(read_catalogue(), name)
    assert class_values("PK") is None


def test_a_belt_of_a_class_follows_its_width_and_keeps_what_is_stated() -> None:
    belt = bd.Belt.model_validate({"profile": "ST 1250 8+6", "width": "1.4 m", "permanent_elongation": "0.1 %"})
    entry = belt.entry
    assert entry is not None
    assert belt.breaking_force == pytest.approx(1.4 * 1250e3)
    assert belt.mass_per_length == pytest.approx(1.4 * entry.mass_per_length)
    assert (belt.permanent_elongation, belt.thermal_expansion) == (0.001, entry.thermal_expansion)
    assert belt.is_of_profile("thermal_expansion")
    assert not belt.is_of_profile("permanent_elongation")
    wider = belt.replace(width="2 m")
    assert wider.breaking_force == pytest.approx(2500e3)
    assert wider.permanent_elongation == 0.001
    assert bd.Belt(**belt.arguments) == belt


def test_a_belt_without_a_class_has_the_strength_that_is_stated() -> None:
    section = {"thickness": 0.01, "axial_stiffness": 5e6, "bending_stiffness": 2.0, "mass_per_length": 12.0}
    belt = bd.Belt(width=0.8, strength="500 N/mm", **section)
    assert belt.breaking_force == pytest.approx(400e3)
    assert bd.Belt(width=0.8, **section).breaking_force is None
    with pytest.raises(ValueError, match="lowest and the highest temperature"):
        bd.Belt(width=0.8, temperature_range=["40 °C", "-10 °C"], **section)


def test_a_changed_drive_keeps_the_class() -> None:
    """As in parameter studies, and in result files, which hold values beside the class."""
    drive = bd.example("conveyor_1km").replace(belt={"profile": "ST 1000", "width": 1.0})
    wider = drive.with_({"belt.width": "1.2 m"})
    assert wider.belt.breaking_force == pytest.approx(1200e3)
    again = bd.Belt.model_validate(wider.belt.model_dump())
    assert again.entry == drive.belt.entry
    assert again.breaking_force == wider.belt.breaking_force
