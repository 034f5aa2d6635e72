from pathlib import Path

import pytest

from beltdyn.model import Entry, read_catalogue

MINE = """
[PK]
width = "3.56 mm"
thickness = "4.5 mm"
axial_stiffness = 30e3
bending_stiffness = 1e-3
mass_per_length = 0.02
title = "PK of ours"
source = "our rig"

[wide]
sold_by = "width"
width = "50 mm"
thickness = "2 mm"
axial_stiffness = "300 kN"
bending_stiffness = 1e-3
mass_per_length = 0.02
title = "Flat belt of ours"
source = "our rig"
"""


def test_what_is_shipped_is_generic_and_says_its_source() -> None:
    shipped = read_catalogue()
    assert {"PK", "PJ", "PJ-elastic", "A", "SPZ", "SPA", "flat-polyamide", "flat-aramid", "round-6"} == set(shipped)
    for entry in shipped.values():
        assert entry.generic
        assert len(entry.source) > 40


@pytest.mark.parametrize("name", sorted(read_catalogue()))
def test_shipped_values_belong_to_rubber_and_cord(name: str) -> None:
    """Density of polymers; the tension line lies in the belt; a cord bends less than a homogeneous belt of its EA."""
    entry = read_catalogue()[name]
    density = entry.mass_per_length / (entry.width * entry.thickness)
    assert 800 < density < 1600
    assert entry.pitch_offset + entry.back_offset <= 1.2 * entry.thickness
    homogeneous = entry.axial_stiffness * entry.thickness**2 / 12
    assert 1e-3 * homogeneous < entry.bending_stiffness <= 1.01 * homogeneous


def test_ones_own_extends_and_replaces(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").write_text(MINE, encoding="utf-8")
    entries = read_catalogue("mine.toml", tmp_path)
    assert entries["PK"].axial_stiffness == 30e3
    assert not entries["PK"].generic
    assert entries["wide"].sold_by == "width"
    assert entries["PJ"] == read_catalogue()["PJ"]
    assert read_catalogue()["PK"].axial_stiffness != 30e3


def test_an_entry_is_checked() -> None:
    entry = read_catalogue()["A"]
    with pytest.raises(ValueError, match=r"entry\.sold_by = \"metres\" is not a choice here"):
        Entry(**entry.arguments | {"sold_by": "metres"})


def test_every_error_says_where_it_is(tmp_path: Path) -> None:
    bad = MINE.replace('axial_stiffness = "300 kN"', "axial_stiffness = -1").replace('title = "PK of ours"\n', "")
    (tmp_path / "mine.toml").write_text(bad.replace("0.02", "0.0"), encoding="utf-8")
    with pytest.raises(ValueError, match="entry") as caught:
        read_catalogue("mine.toml", tmp_path)
    lines = str(caught.value).splitlines()
    assert len(lines) == 2
    for line, key in zip(lines, ("title is missing", "mass_per_length = 0.0 must be greater"), strict=True):
        assert line.startswith(f'catalogue = "mine.toml", profile PK: entry.{key}')
